#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/reflector_map/reflector.hpp"

namespace boresight::ghosts {

namespace {
constexpr float kUnseen = -1.0F;
constexpr float kHit = 1.2F;
/// A rail reflects at its posts, of which a scan shows a part only: a miss says far less than a hit.
constexpr float kMiss = -0.12F;
constexpr float kSurestCell = 4.0F, kLeastSure = -3.0F;

float to_probability(float log_odds) {
  return 1.0F / (1.0F + std::exp(-log_odds));
}
}  // namespace

void Occupancy::set(std::int32_t bin, float log_odds) {
  log_odds_[index(bin)] = log_odds;
  probability_[index(bin)] = to_probability(log_odds);
}

void Occupancy::reset(double begin_m, double end_m, double bin_m) {
  bin_m_ = bin_m;
  first_ = bin_of(begin_m);
  last_ = std::min(bin_of(end_m), first_ + kBins - 1);
  log_odds_.fill(kUnseen);
  probability_.fill(to_probability(kUnseen));
  hit_.fill(false);
}

std::int32_t Occupancy::bin_of(double arc_m) const {
  return static_cast<std::int32_t>(std::floor(std::clamp(arc_m, -1e6, 1e6) / bin_m_));
}

bool Occupancy::extend(double arc_m) {
  const std::int32_t bin = bin_of(arc_m);
  if (std::max(last_, bin) - std::min(first_, bin) >= kBins) return false;
  const auto begin = [this](std::int32_t new_bin) {
    hit_[index(new_bin)] = false;
    set(new_bin, kUnseen);
  };
  for (; last_ < bin; ++last_) begin(last_ + 1);
  for (; first_ > bin; --first_) begin(first_ - 1);
  return true;
}

void Occupancy::hit(double arc_m) {
  const std::int32_t bin = bin_of(arc_m);
  if (bin >= first_ && bin <= last_) hit_[index(bin)] = true;
}

void Occupancy::settle() {
  std::int32_t from = last_ + 1, to = first_ - 1;
  for (std::int32_t bin = first_; bin <= last_; ++bin) {
    if (!hit_[index(bin)]) continue;
    from = std::min(from, bin);
    to = bin;
  }
  for (std::int32_t bin = from; bin <= to; ++bin) {
    set(bin, std::clamp(log_odds_[index(bin)] + (hit_[index(bin)] ? kHit : kMiss), kLeastSure, kSurestCell));
    hit_[index(bin)] = false;
  }
}

void Occupancy::join(double arc_m, const Occupancy& other, double other_arc_m) {
  const std::int32_t theirs = other.bin_of(other_arc_m);
  if (theirs < other.first_ || theirs > other.last_ || !extend(arc_m)) return;
  const std::int32_t bin = bin_of(arc_m);
  set(bin, std::max(log_odds_[index(bin)], other.log_odds_[index(theirs)]));
}

void Occupancy::keep(double begin_m, double end_m) {
  first_ = std::max(first_, bin_of(begin_m));
  last_ = std::min(last_, bin_of(end_m));
}

double Occupancy::probability(double arc_m, double std_m) const {
  const std::int32_t middle = bin_of(arc_m);
  const auto reach = static_cast<std::int32_t>(std::lround(std::min(std_m / bin_m_, double{kMostBlur})));
  double sum = 0.0;
  for (std::int32_t bin = middle - reach; bin <= middle + reach; ++bin) {
    if (bin < first_ || bin > last_) continue;
    sum += static_cast<double>(probability_[index(bin)]);
  }
  return sum / (2 * reach + 1);
}

}  // namespace boresight::ghosts
