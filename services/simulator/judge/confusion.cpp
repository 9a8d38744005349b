#include "services/simulator/judge/confusion.hpp"

#include <limits>
#include <numeric>

namespace boresight::judge {

std::size_t Confusion::index(Provenance provenance) {
  const auto value = static_cast<std::size_t>(provenance);
  return value < kSize ? value : 0;
}

void Confusion::add(Provenance truth, Provenance label, bool rejected) {
  if (rejected) {
    ++rejected_[index(truth)];
  } else {
    ++counts_[index(truth)][index(label)];
  }
}

std::uint64_t Confusion::count(Provenance truth) const {
  const auto& row = counts_[index(truth)];
  return std::accumulate(row.begin(), row.end(), std::uint64_t{0});
}

double Confusion::percent(Provenance truth, Provenance label) const {
  const std::uint64_t all = count(truth);
  if (all == 0) return std::numeric_limits<double>::quiet_NaN();
  return 100.0 * static_cast<double>(counts_[index(truth)][index(label)]) / static_cast<double>(all);
}

}  // namespace boresight::judge
