#include "services/detection_corrector/core/corrector.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "services/common/estimation/scan_trust.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/detection_corrector/core/ego_velocity.hpp"
#include "services/detection_corrector/core/stationary_test.hpp"
#include "services/detection_corrector/core/trust.hpp"

namespace boresight::corrector {

namespace {

/// Without compensation the motion of the vehicle is written as zero.
void write_geometry(const RadarConfig& radar, const Mounting& mounting, const EgoSample& ego,
                    const EgoVelocity& velocity, CorrectedScan& scan) {
  ScanGeometry& out = scan.geometry;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.sensor_position_vehicle_m[k] = static_cast<float>(radar.mounting_pose.position_m[k]);
    out.sensor_velocity_vehicle_mps[k] = static_cast<float>(velocity.sensor_mps(i));
  }
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(out.sensor_to_vehicle.data()) =
      mounting.sensor_to_vehicle.cast<float>();
  out.speed_scale = static_cast<float>(mounting.speed_scale);
  out.ego_speed_mps = static_cast<float>(velocity.speed_mps);
  out.ego_speed_std_mps = static_cast<float>(ego.speed_std_mps);
  out.ego_yaw_rate_radps = static_cast<float>(velocity.yaw_rate_radps);
  out.ego_yaw_rate_std_radps = static_cast<float>(ego.yaw_rate_std_radps);
  std::size_t next = 0;
  for (Eigen::Index row = 1; row < 4; ++row) {
    for (Eigen::Index column = row; column < 4; ++column) {
      scan.mounting_covariance[next++] = static_cast<float>(mounting.covariance(row, column));
    }
  }
  scan.speed_scale_std = static_cast<float>(std::sqrt(mounting.covariance(0, 0)) / mounting.range_rate_scale);
}

bool is_inside(const Eigen::Vector3d& position, const Config& config) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (position(i) < config.region_min_m[k] || position(i) > config.region_max_m[k]) return false;
  }
  return true;
}

float known_or(bool stated, float value, double fallback) {
  return stated && std::isfinite(value) && value > 0.0F ? value : static_cast<float>(fallback);
}

}  // namespace

Corrector::Corrector(const VehicleConfig& vehicle, const Config& config)
    : vehicle_(vehicle), config_(config), ego_(static_cast<std::int64_t>(config.ego_max_age_s * 1e9)) {
  for (const RadarConfig& radar : vehicle_.radars) {
    unknown_elevations_.emplace_back(radar, config_.unknown_rotation_std_rad);
    noises_.emplace_back(config_.stated_noise);
  }
}

bool Corrector::add_alignment(const AlignmentEstimate& estimate) {
  const std::uint32_t id = estimate.header.source_id;
  if (!knows(id)) return false;
  alignment_[id].present = true;
  alignment_[id].estimate = estimate;
  const bool is_sound = estimate.finding == AlignmentFinding::kNone;
  noises_[index_of(id)].set_prior(is_sound ? static_cast<double>(estimate.nuisance.range_rate_noise_scale) : 1.0);
  return true;
}

std::size_t Corrector::index_of(std::uint32_t radar_id) const {
  return static_cast<std::size_t>(vehicle_.radar(radar_id) - vehicle_.radars.data());
}

double Corrector::range_rate_noise_scale(std::uint32_t radar_id) const {
  return knows(radar_id) ? std::sqrt(noises_[index_of(radar_id)].variance_factor()) : 1.0;
}

void Corrector::correct(const RadarScan& scan, CorrectedScan& out) {
  const std::uint32_t id = scan.header.source_id;
  const RadarConfig* const radar = vehicle_.radar(id);
  const std::size_t count =
      radar == nullptr ? 0 : std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  out.number_of_valid_detections = static_cast<std::uint32_t>(count);
  out.fields = scan.fields;
  out.flags = 0;
  out.cycle_counter = scan.cycle_counter;
  out.reserved = {};
  out.alignment_sequence = 0;
  out.geometry = {};
  out.mounting_covariance = {};
  out.speed_scale_std = 0.0F;
  if (radar == nullptr) return;

  const std::int64_t time_ns = scan.header.measurement_time_ns;
  const Latest& latest = alignment_[id];
  const Mounting mounting = mounting_of(*radar, latest.present ? &latest.estimate : nullptr, config_);
  out.alignment_sequence = mounting.alignment_sequence;
  if (mounting.alignment_sequence == 0) out.flags |= pipeline_flag::kNoAlignment;
  const double alignment_age_s = static_cast<double>(time_ns - latest.estimate.header.measurement_time_ns) * 1e-9;
  if (latest.present && std::abs(alignment_age_s) > config_.alignment_max_age_s) {
    out.flags |= pipeline_flag::kAlignmentStale;
  }

  const EgoSample ego = ego_.at(time_ns + static_cast<std::int64_t>(mounting.time_offset_s * 1e9));
  const bool compensates = ego.valid && !ego.stale;
  if (!ego.valid) out.flags |= pipeline_flag::kNoEgoMotion;
  if (ego.valid && ego.stale) out.flags |= pipeline_flag::kEgoMotionStale;
  if (!scan.has(scan_field::kElevation)) out.flags |= pipeline_flag::kNoElevation;
  const bool is_wrong = is_scan_wrong(scan) || (latest.present && places_detections_wrongly(latest.estimate.finding));
  if (is_wrong) out.flags |= pipeline_flag::kDistrusted;
  const EgoVelocity motion =
      compensates ? ego_velocity(ego, vehicle_.ego, radar->mounting_pose, mounting)
                  : EgoVelocity{0.0, 0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  write_geometry(*radar, mounting, compensates ? ego : EgoSample{}, motion, out);

  const bool has_elevation = scan.has(scan_field::kElevation);
  const bool has_stds = scan.has(scan_field::kStds);
  const bool has_rcs = scan.has(scan_field::kRcs);
  const Eigen::Matrix3d& rotation = mounting.sensor_to_vehicle;
  const Eigen::Vector3d origin(radar->mounting_pose.position_m.data());
  const std::size_t index = index_of(id);
  const UnknownElevation& unknown = unknown_elevations_[index];
  RangeRateNoise& noise = noises_[index];
  const double learnt_factor = noise.variance_factor();
  const auto learnt_scale = static_cast<float>(std::sqrt(learnt_factor));
  const StationaryTest stationary(motion, mounting, has_elevation ? nullptr : &unknown, config_);
  std::size_t with_noise = 0;

  for (std::size_t i = 0; i < count; ++i) {
    const float elevation = has_elevation ? scan.elevation_rad[i] : 0.0F;
    const bool finite = std::isfinite(scan.range_m[i]) && std::isfinite(scan.azimuth_rad[i]) &&
                        std::isfinite(elevation) && std::isfinite(scan.range_rate_mps[i]) && scan.range_m[i] >= 0.0F;
    std::uint16_t flags = 0;
    const bool usable = finite && !is_wrong && (scan.detection_flags[i] & detection_flag::kUnusable) == 0;
    if (!usable) flags |= corrected_flag::kInvalid;
    if ((scan.detection_flags[i] & detection_flag::kInvalid) != 0) flags |= corrected_flag::kDoubted;
    if ((scan.detection_flags[i] & detection_flag::kAmbiguous) != 0) flags |= corrected_flag::kAmbiguous;
    const double range = finite ? scan.range_m[i] : 0.0;
    const double measured_azimuth = finite ? scan.azimuth_rad[i] : 0.0;
    const AzimuthCurve::Error azimuth_error = mounting.azimuth_curve.at(measured_azimuth);
    const double azimuth = measured_azimuth - azimuth_error.value_rad;
    const double range_rate = (finite ? scan.range_rate_mps[i] : 0.0) / mounting.range_rate_scale;

    const double ca = std::cos(azimuth), sa = std::sin(azimuth);
    const double ce = std::cos(finite ? elevation : 0.0F), se = std::sin(finite ? elevation : 0.0F);
    const Eigen::Vector3d direction = rotation * Eigen::Vector3d(ce * ca, ce * sa, se);
    const Eigen::Vector3d position = origin + range * direction;
    const double over_ground = range_rate - geometry::stationary_range_rate(direction, motion.sensor_mps);

    out.x_vehicle_m[i] = static_cast<float>(position.x());
    out.y_vehicle_m[i] = static_cast<float>(position.y());
    out.z_vehicle_m[i] = static_cast<float>(position.z());
    out.range_m[i] = static_cast<float>(range);
    out.azimuth_vehicle_rad[i] = static_cast<float>(std::atan2(direction.y(), direction.x()));
    out.elevation_vehicle_rad[i] = static_cast<float>(std::asin(std::clamp(direction.z(), -1.0, 1.0)));
    out.range_rate_mps[i] = static_cast<float>(range_rate);
    out.range_rate_over_ground_mps[i] = static_cast<float>(over_ground);
    out.rcs_dbsm[i] = scan.rcs_dbsm[i];
    out.snr_db[i] = scan.snr_db[i];
    const float azimuth_std = known_or(has_stds, scan.azimuth_std_rad[i], radar->noise.azimuth_std_rad);
    const float elevation_std =
        known_or(has_stds && has_elevation, scan.elevation_std_rad[i], radar->noise.elevation_std_rad);
    const float range_rate_std = known_or(has_stds, scan.range_rate_std_mps[i], radar->noise.range_rate_std_mps);
    out.range_std_m[i] = known_or(has_stds, scan.range_std_m[i], radar->noise.range_std_m);
    out.azimuth_std_rad[i] = azimuth_std;
    out.elevation_std_rad[i] = elevation_std;
    // The noise of the vehicle file is not the radar's statement.
    const bool states_rate = has_stds && range_rate_std == scan.range_rate_std_mps[i];
    out.range_rate_std_mps[i] = states_rate ? learnt_scale * range_rate_std : range_rate_std;
    out.existence_probability[i] = scan.has(scan_field::kExistence) ? scan.existence_probability[i] : 1.0F;

    if (!is_inside(position, config_)) flags |= corrected_flag::kOutsideRegion;
    if (has_rcs && range > 0.0) {
      const double limit = config_.rcs_near_dbsm + config_.rcs_slope_db_per_decade * std::log10(range / 10.0);
      if (scan.rcs_dbsm[i] < limit) flags |= corrected_flag::kWeak;
    }
    if (compensates && usable) {
      // A std that the sensor does not state comes from the vehicle file and holds at the boresight.
      const bool states_azimuth = has_stds && azimuth_std == scan.azimuth_std_rad[i];
      const double widening = states_azimuth ? 1.0 : 1.0 / std::max(ca, config_.azimuth_std_edge);
      const Sight sight{direction,
                        ca,
                        sa,
                        ce,
                        se,
                        range,
                        mounting.range_rate_scale * over_ground,
                        widening * static_cast<double>(azimuth_std),
                        static_cast<double>(elevation_std),
                        static_cast<double>(range_rate_std),
                        azimuth_error.std_rad};
      const Innovation innovation = stationary.innovation(sight);
      const bool passes = stationary.passes(innovation, states_rate ? learnt_factor : 1.0);
      const bool is_trusted = (flags & (corrected_flag::kDoubted | corrected_flag::kAmbiguous)) == 0;
      if (states_rate && is_trusted) innovations_[with_noise++] = innovation;
      flags |= passes ? corrected_flag::kStationary : corrected_flag::kMoving;
    }
    out.detection_flags[i] = flags;
  }
  if (std::abs(motion.speed_mps) < config_.stated_noise.least_speed_mps) return;
  noise.learn({innovations_.data(), with_noise}, stationary.common(), time_ns);
}

}  // namespace boresight::corrector
