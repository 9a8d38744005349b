// The second half of the association: a hard association becomes a candidate with softly shared measurements.
#include <algorithm>
#include <cmath>
#include <limits>

#include "services/tracker/core/pmbm/association.hpp"

namespace boresight::tracking::pmbm {

namespace {
constexpr double kNever = -std::numeric_limits<double>::infinity();
}  // namespace

void Association::keep(const State& s, std::size_t row, double log_weight) {
  std::uint64_t key = mixed(0xabcdefU + row);
  for (std::size_t b = 0; b < s.cells.size(); ++b) {
    if (s.cells[b].n == 0.0) continue;
    key += mixed(s.cells[b].key ^ (b < s.objects ? mixed(1000003U * (b + 1)) : 0x5555U));
  }
  if (known_.find(key) >= 0) return;
  // When the table is full, what is still kept is known by its own key.
  if (!known_.insert(key, 1) &&
      std::any_of(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(number_of_candidates_),
                  [key](const Candidate& c) { return c.key == key; })) {
    return;
  }
  // When full, the least likely makes room.
  std::size_t place = number_of_candidates_;
  if (place == candidates_.size()) {
    place = static_cast<std::size_t>(
        std::min_element(candidates_.begin(), candidates_.end(),
                         [](const Candidate& a, const Candidate& b) { return a.log_weight < b.log_weight; }) -
        candidates_.begin());
    if (candidates_[place].log_weight >= log_weight + s.score) return;
  } else {
    ++number_of_candidates_;
  }
  Candidate& c = candidates_[place];
  c.key = key;
  c.row = row;
  c.objects = s.objects;
  c.labels.assign(s.labels.begin(), s.labels.end());
  c.cells.assign(s.cells.begin(), s.cells.end());
  c.log_weight = log_weight + s.score;
  if (!is_spent()) c.log_weight += soften(s, c.cells);
}

/// Each measurement is of each cell by its leave-one-out predictive weight. Returns the log of how much all
/// associations that differ in single measurements add to the weight of this one.
double Association::soften(const State& s, std::vector<Cell<double>>& out) {
  const std::size_t cells = s.cells.size(), n = z_.size(), stride = cells + 1;
  if (cells == 0 || n == 0) return 0.0;
  constexpr int kPasses = 3;
  constexpr double kNegligible = 7.0;  // log
  constexpr double kShared = 1.001;    // sum of weights relative to the largest
  constexpr double kAlone = 0.999;     // a cell of less without the measurement is its own only
  constexpr double kFraction = 1e-9;   // marks a cell as soft, so that its value is not remembered
  constexpr double kOwn = std::numeric_limits<double>::infinity();
  share_.assign(n * stride, 0.0);
  gain_.assign(stride, 0.0);
  is_shared_.assign(n, 0);
  soft_.assign(s.cells.begin(), s.cells.end());
  for (std::size_t i = 0; i < n; ++i) {
    share_[i * stride + (s.labels[i] < 0 ? cells : static_cast<std::size_t>(s.labels[i]))] = 1.0;
  }
  double log_added = 0.0;
  for (int pass = 0; pass < kPasses && !is_spent(); ++pass) {
    bool any_shared = false;
    next_share_.assign(share_.begin(), share_.end());
    for (std::size_t i = 0; i < n; ++i) {
      if (pass > 0 && is_shared_[i] == 0) continue;
      const double* has = &share_[i * stride];
      double best = log_alone_[i];
      bool is_own = false;
      gain_[cells] = log_alone_[i];
      for (std::size_t b = 0; b < cells; ++b) {
        gain_[b] = kNever;
        const bool is_label = s.labels[i] == static_cast<std::int16_t>(b);
        if (!is_label && !is_allowed(s, i, b)) continue;
        Cell<double> without = soft_[b];
        if (has[b] > 0.0) {
          if (pass == 0) {
            without.remove(z_[i], keys_[i]);
          } else {
            without.add(z_[i], -has[b]);
          }
        }
        if (without.n < kAlone) {
          if (is_label) {
            gain_[b] = kOwn;
            is_own = true;
          }
          continue;
        }
        Cell<double> with = without;
        if (pass == 0) {
          with.add(z_[i], keys_[i]);
        } else {
          with.add(z_[i], 1.0);
          with.n += kFraction;
          without.n += kFraction;
        }
        gain_[b] = cell_value(s, b, with) - cell_value(s, b, without);
        best = std::max(best, gain_[b]);
      }
      if (is_own) {
        for (double& g : gain_) g = g == kOwn ? 0.0 : kNever;
        best = 0.0;
      }
      double sum = 0.0;
      for (double& g : gain_) {
        g = g < best - kNegligible ? 0.0 : std::exp(g - best);
        sum += g;
      }
      if (pass == 0) {
        const double of_label = gain_[s.labels[i] < 0 ? cells : static_cast<std::size_t>(s.labels[i])];
        if (of_label > 0.0) log_added += std::log(sum / of_label);
        is_shared_[i] = sum > kShared ? 1 : 0;
      }
      any_shared = any_shared || is_shared_[i] != 0;
      for (std::size_t b = 0; b < stride; ++b) next_share_[i * stride + b] = gain_[b] / sum;
    }
    if (!any_shared) break;
    share_.swap(next_share_);
    for (std::size_t b = 0; b < cells; ++b) {
      const std::uint64_t key = soft_[b].key;
      soft_[b] = Cell<double>{};
      soft_[b].key = key;
      for (std::size_t i = 0; i < n; ++i) {
        const double w = share_[i * stride + b];
        if (w > 0.0) soft_[b].add(z_[i], w);
      }
    }
  }
  constexpr double kLeast = 0.5;  // less than half a measurement is no detection
  for (std::size_t b = 0; b < cells; ++b) out[b] = s.cells[b].n > 0.0 && soft_[b].n >= kLeast ? soft_[b] : s.cells[b];
  return log_added;
}

}  // namespace boresight::tracking::pmbm
