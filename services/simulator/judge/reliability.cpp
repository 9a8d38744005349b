#include "services/simulator/judge/reliability.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::judge {

void Reliability::add(double probability, bool is_so) {
  const double p = probability >= 0.0 && probability <= 1.0 ? probability : (is_so ? 0.0 : 1.0);
  const auto above = std::upper_bound(kEdges.begin() + 1, kEdges.end() - 1, p);
  Bin& bin = bins_[static_cast<std::size_t>(above - kEdges.begin()) - 1];
  ++bin.count;
  bin.so += is_so ? 1 : 0;
  bin.probability_sum += p;
  squares_ += (p - (is_so ? 1.0 : 0.0)) * (p - (is_so ? 1.0 : 0.0));
}

void Reliability::add(const Reliability& other) {
  for (std::size_t i = 0; i < kBins; ++i) {
    bins_[i].count += other.bins_[i].count;
    bins_[i].so += other.bins_[i].so;
    bins_[i].probability_sum += other.bins_[i].probability_sum;
  }
  squares_ += other.squares_;
}

std::uint64_t Reliability::count() const {
  std::uint64_t sum = 0;
  for (const Bin& bin : bins_) sum += bin.count;
  return sum;
}

double Reliability::calibration_error() const {
  double sum = 0.0;
  for (const Bin& bin : bins_) {
    if (bin.count > 0) sum += static_cast<double>(bin.count) * std::abs(bin.mean_probability() - bin.share());
  }
  return sum / static_cast<double>(count());
}

}  // namespace boresight::judge
