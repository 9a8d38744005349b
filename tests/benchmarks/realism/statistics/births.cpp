#include "tests/benchmarks/realism/statistics/births.hpp"

#include <cmath>

namespace boresight::bench::realism {

namespace {

constexpr double kFromLargestRange_m = 6.0, kFromEdge_rad = 6.0 * M_PI / 180.0;  // Schumann et al.
constexpr std::size_t kLeastOfTrack = 30;                                        // detections, likewise
constexpr double kEndOfDrive_s = 1.0;  // choice: over 90 % of gaps are shorter

}  // namespace

void Births::add(const ObservedScan& scan) {
  begin_s_ = std::fmin(begin_s_, scan.t_s);
  end_s_ = std::fmax(end_s_, scan.t_s);
  for (const ObservedObject& object : scan.objects) {
    if (!is_moving_vehicle(object.user)) continue;
    for (const ObservedDetection& d : scan.detections) {
      if (!d.is_direct_of(object.id)) continue;
      const Place place{scan.t_s, d.range_m, d.range_m >= scan.range_max_m - kFromLargestRange_m,
                        std::abs(d.azimuth_rad) >= 0.5 * scan.view_rad - kFromEdge_rad};
      Life& life = lives_.try_emplace(object.id, Life{object.user, place, place, 0}).first->second;
      life.last = place;
      ++life.detections;
    }
  }
}

void Births::end_drive() {
  for (const auto& [id, life] : lives_) {
    if (life.detections < kLeastOfTrack) continue;
    if (life.first.t_s > begin_s_ + kEndOfDrive_s) {
      first_range_m_[static_cast<std::size_t>(life.user)].add(life.first.range_m);
      first_far_.add(life.first.is_far);
      elsewhere_.add(!life.first.is_far && !life.first.is_at_edge);
    }
    if (life.last.t_s < end_s_ - kEndOfDrive_s) {
      last_far_.add(life.last.is_far);
      last_edge_.add(life.last.is_at_edge);
      elsewhere_.add(!life.last.is_far && !life.last.is_at_edge);
    }
  }
  lives_.clear();
  begin_s_ = end_s_ = kNoFigure;
}

void Births::merge(const Births& other) {
  for (std::size_t u = 0; u < kRoadUsers; ++u) first_range_m_[u].merge(other.first_range_m_[u]);
  first_far_.merge(other.first_far_);
  last_far_.merge(other.last_far_);
  last_edge_.merge(other.last_edge_);
  elsewhere_.merge(other.elsewhere_);
}

}  // namespace boresight::bench::realism
