#include "services/tracker/core/output/detectability.hpp"

#include <algorithm>

#include "interfaces/messages/track_list.hpp"

namespace boresight::tracking {

Obstacle obstacle(const Sight& sight, double shared, const DetectabilityParameters& p) {
  if (sight.in_view < p.likely) return Obstacle::kOutOfView;
  if (sight.hidden_share >= p.likely) return Obstacle::kOccluded;
  if (sight.seems_moving < p.likely) return Obstacle::kZeroDoppler;
  return shared >= p.merged_share ? Obstacle::kMerged : Obstacle::kNone;
}

void RecentScans::add(int radar, double elapsed_s) {
  for (double& age_s : age_s_) age_s += elapsed_s;
  if (radar >= 0) age_s_[static_cast<std::size_t>(radar)] = 0.0;
}

void Detectability::set(int radar, Obstacle obstacle) {
  if (radar >= 0) by_radar_[static_cast<std::size_t>(radar)] = obstacle;
}

std::uint32_t Detectability::flags(const RecentScans& scans, const DetectabilityParameters& p) const {
  Obstacle nearest = Obstacle::kOutOfView;
  for (std::size_t radar = 0; radar < by_radar_.size(); ++radar) {
    if (scans.age_s(radar) <= p.recent_scan_s) nearest = std::max(nearest, by_radar_[radar]);
  }
  switch (nearest) {
    case Obstacle::kOutOfView:
      return track_flag::kOutOfView;
    case Obstacle::kOccluded:
      return track_flag::kOccluded;
    case Obstacle::kZeroDoppler:
      return track_flag::kZeroDoppler;
    case Obstacle::kMerged:
      return track_flag::kMerged;
    case Obstacle::kNone:
      break;
  }
  return 0;
}

}  // namespace boresight::tracking
