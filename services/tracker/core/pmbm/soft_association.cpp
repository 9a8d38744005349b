// The second half of the association: hard associations become candidates, and candidates share their measurements.
//
// A candidate stands for all associations that differ from it in shared measurements. By the chain rule, their weight
// together is p(A) / Π_i P(A_i | A_1 … A_{i−1}), with A_i the cell of measurement i in the hard association A. The
// search takes the leave-one-out probability for each factor, which is known from hard cells but too large: it is given
// all others. For the candidates that are left, the factors are the shares, which are given no other for certain.
#include <algorithm>
#include <bit>
#include <cmath>

#include "services/tracker/core/numeric.hpp"
#include "services/tracker/core/pmbm/association.hpp"

namespace boresight::tracking::pmbm {

namespace {

/// Candidates that differ elsewhere share these measurements alike, to the last bit.
std::uint64_t content_key(const Cell<double>& c) {
  std::uint64_t key = 0;
  for (const double x : {c.n, c.sum.x, c.sum.y, c.sum_squares.xx, c.sum_squares.xy, c.sum_squares.yy,
                         c.sight_squares.xx, c.sight_squares.xy, c.sight_squares.yy, c.sight_rate.x, c.sight_rate.y,
                         c.rate_squares, c.log_clutter, c.side_lobe_share, c.partner, c.wide_share}) {
    key = (key ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15U;
    key ^= key >> 32U;
  }
  return key;
}

}  // namespace

void Association::keep(const State& s) {
  const double log_hard = log_row_ + s.score;
  log_top_ = std::max(log_top_, log_hard);
  std::uint64_t key = mixed(0xabcdefU + row_);
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
  const double log_weight = log_hard + share_hard(s);
  // When full, the least likely makes room.
  std::size_t place = number_of_candidates_;
  if (place == candidates_.size()) {
    place = static_cast<std::size_t>(
        std::min_element(candidates_.begin(), candidates_.end(),
                         [](const Candidate& a, const Candidate& b) { return a.log_weight < b.log_weight; }) -
        candidates_.begin());
    if (candidates_[place].log_weight >= log_weight) return;
  } else {
    ++number_of_candidates_;
  }
  Candidate& c = candidates_[place];
  static_cast<Cells&>(c) = s;
  c.log_hard = log_hard;
  c.log_weight = log_weight;
  c.key = key;
  c.row = row_;
  c.shared.assign(c.cells.size(), 0.0);
}

/// The likeliest first; returns how many of them count.
std::size_t Association::prune(std::size_t number) {
  const auto begin = candidates_.begin();
  std::sort(begin, begin + static_cast<std::ptrdiff_t>(number),
            [](const Candidate& a, const Candidate& b) { return a.log_weight > b.log_weight; });
  const double limit = candidates_[0].log_weight + std::log(parameters_.prune_weight);
  number = std::min(number, capacity_.candidates);
  while (number > 1 && candidates_[number - 1].log_weight < limit) --number;
  return number;
}

/// Shares of one measurement from its gains; returns the log of the sum of exp(gain).
double Association::normalise_shares(std::size_t z) {
  double* shares = &next_share_[first_link_[z]];
  const double best = *std::max_element(gain_.begin(), gain_.end());
  double sum = 0.0;
  for (std::size_t k = 0; k < gain_.size(); ++k) {
    shares[k] = gain_[k] == best ? 1.0 : gain_[k] - best < log_min_share_ ? 0.0 : std::exp(gain_[k] - best);
    sum += shares[k];
  }
  if (sum == 1.0) return best;  // most measurements are of one cell
  for (std::size_t k = 0; k < gain_.size(); ++k) shares[k] /= sum;
  return best + std::log(sum);
}

/// Shares each measurement by leave-one-out predictive weights, the others as in the hard association. Returns the log
/// of the product of 1 / the shares of the hard association.
double Association::share_hard(const Cells& hard) {
  const std::size_t cells = hard.cells.size(), n = z_.size();
  first_link_.clear();
  own_link_.clear();
  linked_.clear();
  is_shared_.assign(n, 0);
  double log_added = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t own = hard.labels[i] < 0 ? cells : static_cast<std::size_t>(hard.labels[i]);
    first_link_.push_back(linked_.size());
    if (own < cells && hard.cells[own].n < 2.0) {  // what a cell has alone is not shared: it would be an object less
      own_link_.push_back(linked_.size());
      next_share_[linked_.size()] = 1.0;
      linked_.push_back(own);
      continue;
    }
    gain_.clear();
    const auto link = [&](std::size_t b, double gain) {
      if (b == own) own_link_.push_back(linked_.size());
      linked_.push_back(b);
      gain_.push_back(gain);
    };
    const auto link_own = [&] {
      Cell<double> without = hard.cells[own];
      without.remove(z_[i], keys_[i]);
      const double value = cell_value(hard, own, hard.cells[own]);
      link(own, value - cell_value(hard, own, without));
    };
    for_allowed(hard, i, [&](std::size_t b) {
      if (own < b && own_link_.size() == i) link_own();  // it may be outside the gate
      if (b == own) return link_own();
      if (hard.cells[b].n < 1.0) return;
      Cell<double> with = hard.cells[b];
      with.add(z_[i], keys_[i]);
      const double value = cell_value(hard, b, with);
      link(b, value - cell_value(hard, b, hard.cells[b]));
    });
    if (own < cells && own_link_.size() == i) link_own();
    link(cells, log_alone_[i]);
    log_added += normalise_shares(i) - gain_[own_link_[i] - first_link_[i]];
    is_shared_[i] = next_share_[own_link_[i]] < 1.0 ? 1 : 0;
  }
  first_link_.push_back(linked_.size());
  return log_added;
}

/// The same, the others shared.
void Association::share_again(const Cells& hard) {
  const std::size_t cells = hard.cells.size();
  const auto soft_value = [&](std::size_t b, const Cell<double>& content) {
    const std::uint64_t source = b < hard.objects ? source_keys_[locals_[b]] : CellMemory::source_key(0);
    ++*work_;  // also of what is remembered: the budget does not depend on it
    return soft_memory_.value(content_key(content), source, [&] {
      return b < hard.objects ? log_existence_[locals_[b]] + predictions_[locals_[b]].log_likelihood(content)
                              : std::max(kLeastLog, poisson_->log_likelihood(*model_, content));
    });
  };
  soft_values_.assign(cells, kInfinity);  // of soft_, where it was asked for
  for (std::size_t i = 0; i < z_.size(); ++i) {
    if (is_shared_[i] == 0) continue;
    const std::size_t own = linked_[own_link_[i]];
    if (own < cells && soft_[own].n - share_[own_link_[i]] < 1.0) {
      for (std::size_t k = first_link_[i]; k < first_link_[i + 1]; ++k) next_share_[k] = k == own_link_[i] ? 1.0 : 0.0;
      continue;
    }
    gain_.clear();
    for (std::size_t k = first_link_[i]; k + 1 < first_link_[i + 1]; ++k) {
      const std::size_t b = linked_[k];
      const double has = share_[k];
      Cell<double> without = soft_[b];
      without.add(z_[i], -has);
      if (without.n < 1.0) {
        gain_.push_back(-kInfinity);
        continue;
      }
      Cell<double> with = without;
      with.add(z_[i], 1.0);
      if (has == 0.0 && soft_values_[b] == kInfinity) soft_values_[b] = soft_value(b, without);
      gain_.push_back(soft_value(b, with) - (has == 0.0 ? soft_values_[b] : soft_value(b, without)));
    }
    gain_.push_back(log_alone_[i]);
    static_cast<void>(normalise_shares(i));
  }
}

void Association::gather_shares() {
  share_.swap(next_share_);
  for (Cell<double>& cell : soft_) {
    if (cell.n != 0.0) cell = Cell<double>{};
  }
  for (std::size_t i = 0; i < z_.size(); ++i) {
    for (std::size_t k = first_link_[i]; k < first_link_[i + 1]; ++k) {
      if (linked_[k] < soft_.size() && share_[k] > 0.0) soft_[linked_[k]].add(z_[i], share_[k]);
    }
  }
  std::copy_n(share_.begin(), linked_.size(), next_share_.begin());
}

void Association::soften(Candidate& c) {
  take_row(c.row);
  static_cast<void>(share_hard(c));
  if (std::none_of(is_shared_.begin(), is_shared_.end(), [](char is_shared) { return is_shared != 0; })) return;
  const std::size_t cells = c.cells.size();
  soft_.assign(cells, Cell<double>{});
  gather_shares();
  for (int pass = 1; pass < parameters_.sharing_passes; ++pass) {
    share_again(c);
    gather_shares();
  }
  c.log_weight = c.log_hard;
  for (std::size_t i = 0; i < z_.size(); ++i) {
    c.log_weight -= std::log(std::max(parameters_.min_share, share_[own_link_[i]]));
  }
  const auto is_softened = [&](std::size_t b) {
    return c.cells[b].n != 0.0 && soft_[b].n >= 0.5;  // less than half a measurement is no detection
  };
  for (std::size_t i = 0; i < z_.size(); ++i) {
    const std::size_t last = first_link_[i + 1] - 1;
    const double of_clutter = linked_[last] == cells ? share_[last] : 0.0;
    for (std::size_t k = first_link_[i]; k <= last; ++k) {
      const std::size_t b = linked_[k];
      if (b < cells && is_softened(b)) c.shared[b] += share_[k] * (1.0 - share_[k] - of_clutter) / soft_[b].n;
    }
  }
  for (std::size_t b = 0; b < cells; ++b) {
    if (!is_softened(b)) continue;
    soft_[b].key = c.cells[b].key;
    c.cells[b] = soft_[b];
  }
}

}  // namespace boresight::tracking::pmbm
