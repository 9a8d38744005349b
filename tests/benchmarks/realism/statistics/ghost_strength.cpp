#include "tests/benchmarks/realism/statistics/ghost_strength.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

namespace {

constexpr double kPairRange_m = 3.0, kPairRate_mps = 0.6, kBeside_rad = 8.0 * M_PI / 180.0;
constexpr std::size_t kChanceScans = 20;  // 1.5 s: the object has moved on

bool is_pair(const ObservedDetection& object, const ObservedDetection& other) {
  return std::abs(other.range_m - object.range_m) <= kPairRange_m &&
         std::abs(other.range_rate_mps - object.range_rate_mps) <= kPairRate_mps &&
         std::abs(other.azimuth_rad - object.azimuth_rad) > kBeside_rad;
}

}  // namespace

void GhostStrength::add(const ObservedScan& scan) {
  std::vector<ObservedDetection> false_movers;
  for (const ObservedDetection& d : scan.detections) {
    if (d.is_false_mover()) false_movers.push_back(d);
  }
  auto& earlier = earlier_[scan.radar];
  const bool has_chance = earlier.size() == kChanceScans;
  const auto count = [](const ObservedDetection& object, const ObservedDetection& other, Histogram& histogram) {
    if (!is_pair(object, other)) return;
    const double difference_db =
        std::clamp<double>(std::round(other.rcs_dbsm - object.rcs_dbsm), -kReach_db, kReach_db);
    histogram[static_cast<std::size_t>(difference_db + kReach_db)] += 1.0;
  };
  for (const ObservedObject& object : scan.objects) {
    const ObservedDetection* strongest = nullptr;
    for (const ObservedDetection& d : scan.detections) {
      if (!d.is_of_mover() || d.object != object.id) continue;
      if (strongest == nullptr || d.rcs_dbsm > strongest->rcs_dbsm) strongest = &d;
    }
    if (strongest == nullptr) continue;
    for (const ObservedDetection& d : scan.detections) {
      const bool is_image = d.provenance == Provenance::kGhostType1 || d.provenance == Provenance::kGhostType2;
      if (is_image && d.object == object.id) mirror_images_db_.add(d.rcs_dbsm - strongest->rcs_dbsm);
    }
    // Without an earlier scan the chance is unknown: this scan does not count.
    if (!has_chance) continue;
    for (const ObservedDetection& d : false_movers) count(*strongest, d, pairs_);
    for (const ObservedDetection& d : earlier.front()) count(*strongest, d, by_chance_);
  }
  if (has_chance) earlier.pop_front();
  earlier.push_back(std::move(false_movers));
}

void GhostStrength::merge(const GhostStrength& other) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    pairs_[i] += other.pairs_[i];
    by_chance_[i] += other.by_chance_[i];
  }
  mirror_images_db_.merge(other.mirror_images_db_);
}

GhostStrength::Histogram GhostStrength::without_chance() const {
  Histogram rest = pairs_;
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= by_chance_[i];
  return rest;
}

double GhostStrength::quantile_db(double share) const {
  const Histogram rest = without_chance();
  double total = 0.0;
  for (const double n : rest) total += n;
  if (!(total > 0.0)) return kNoFigure;
  double below = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    below += rest[i];
    if (below >= share * total) return static_cast<double>(i) - kReach_db;
  }
  return kNoFigure;
}

double GhostStrength::percent_stronger() const {
  const Histogram rest = without_chance();
  double total = 0.0, stronger = 0.0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    total += rest[i];
    if (i > static_cast<std::size_t>(kReach_db)) stronger += rest[i];
  }
  return total > 0.0 ? kPercent * stronger / total : kNoFigure;
}

std::size_t GhostStrength::pairs() const {
  double sum = 0.0;
  for (const double n : pairs_) sum += n;
  return static_cast<std::size_t>(sum);
}

}  // namespace boresight::bench::realism
