#include "services/ghost_filter/core/pass_on.hpp"

#include <algorithm>
#include <cstring>

namespace boresight::ghosts {

std::size_t pass_on(const CorrectedScan& scan, ClassifiedScan& out) {
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  out.number_of_valid_detections = static_cast<std::uint32_t>(count);
  out.fields = scan.fields;
  out.flags = scan.flags;
  out.geometry = scan.geometry;
  out.reserved = {};
  const auto copy = [count](const DetectionColumn<float>& from, DetectionColumn<float>& to) {
    std::memcpy(to.data(), from.data(), count * sizeof(float));
  };
  copy(scan.x_vehicle_m, out.x_vehicle_m);
  copy(scan.y_vehicle_m, out.y_vehicle_m);
  copy(scan.z_vehicle_m, out.z_vehicle_m);
  copy(scan.range_m, out.range_m);
  copy(scan.azimuth_vehicle_rad, out.azimuth_vehicle_rad);
  copy(scan.range_rate_over_ground_mps, out.range_rate_over_ground_mps);
  copy(scan.rcs_dbsm, out.rcs_dbsm);
  copy(scan.snr_db, out.snr_db);
  copy(scan.range_std_m, out.range_std_m);
  copy(scan.azimuth_std_rad, out.azimuth_std_rad);
  copy(scan.range_rate_std_mps, out.range_rate_std_mps);
  std::memcpy(out.detection_flags.data(), scan.detection_flags.data(), count * sizeof(std::uint16_t));
  return count;
}

}  // namespace boresight::ghosts
