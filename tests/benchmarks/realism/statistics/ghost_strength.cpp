#include "tests/benchmarks/realism/statistics/ghost_strength.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

namespace {

constexpr double kPairRange_m = 3.0, kPairRate_mps = 0.6, kBeside_rad = 8.0 * M_PI / 180.0;
constexpr double kBesideRate_mps = 3.0;  // beside the object's range rate: pairs by chance

/// `offset_mps`: of the range rate that is asked for.
bool is_pair(const ObservedDetection& object, const ObservedDetection& other, double offset_mps) {
  return std::abs(other.range_m - object.range_m) <= kPairRange_m &&
         std::abs(other.range_rate_mps - object.range_rate_mps - offset_mps) <= kPairRate_mps &&
         std::abs(other.azimuth_rad - object.azimuth_rad) > kBeside_rad;
}

}  // namespace

void GhostStrength::add(const ObservedScan& scan) {
  for (const ObservedObject& object : scan.objects) {
    const ObservedDetection* strongest = nullptr;
    for (const ObservedDetection& d : scan.detections) {
      if (!d.is_of_mover() || d.object != object.id) continue;
      if (strongest == nullptr || d.rcs_dbsm > strongest->rcs_dbsm) strongest = &d;
    }
    if (strongest == nullptr) continue;
    for (const ObservedDetection& d : scan.detections) {
      const double difference_db = d.rcs_dbsm - strongest->rcs_dbsm;
      const bool is_image = d.provenance == Provenance::kGhostType1 || d.provenance == Provenance::kGhostType2;
      if (is_image && d.object == object.id) mirror_images_db_.add(difference_db);
      if (!d.is_false_mover()) continue;
      const auto bin =
          static_cast<std::size_t>(std::clamp<double>(std::round(difference_db), -kReach_db, kReach_db) + kReach_db);
      if (is_pair(*strongest, d, 0.0)) pairs_[bin] += 1.0;
      for (const double offset_mps : {-kBesideRate_mps, kBesideRate_mps}) {
        if (is_pair(*strongest, d, offset_mps)) by_chance_[bin] += 0.5;
      }
    }
  }
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
