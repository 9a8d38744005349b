#include "services/alignment_estimator/core/published/published_method.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::published {

namespace {

constexpr double kMadToStd = 1.4826;
/// A radar without scans for this time does not count among those that share k_v.
constexpr std::int64_t kSilent_ns = 1'000'000'000;
/// A gap in the data does not count as driving: at most this many radar cycles count between two scans.
constexpr double kMaxCyclesBetween = 4.0;

/// Median of the first `count` of `values`, which it reorders; 0 for none.
double median(std::span<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool usable(const EgoSample& ego, double min_speed_mps) {
  return ego.valid && !ego.stale && std::isfinite(ego.speed_mps) && std::isfinite(ego.yaw_rate_radps) &&
         ego.speed_mps >= min_speed_mps;
}

}  // namespace

PublishedMethod::PublishedMethod(const VehicleConfig& vehicle, const PublishedConfig& config, int parameters,
                                 std::size_t detections_per_scan)
    : config_(config), parameters_(parameters), detections_per_scan_(detections_per_scan), draw_(config.seed) {
  radars_.resize(vehicle.radars.size());
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    radars_[i].id = vehicle.radars[i].id;
    radars_[i].nominal = vehicle.radars[i].mounting_pose;
    radars_[i].cycle_time_s = vehicle.radars[i].cycle_time_s;
  }
}

Eigen::Vector4d PublishedMethod::parameters(std::size_t radar) const {
  Eigen::Vector4d b;
  b << speed_scale_, radars_[radar].angles;
  return b;
}

ScanView PublishedMethod::view(const Radar& radar, const ScanDetections& scan, const EgoSample& ego) const {
  Eigen::Vector4d b;
  b << speed_scale_, radar.angles;
  const bool straight =
      config_.road_model == RoadModel::kStraight || (config_.road_model == RoadModel::kStraightWhereSlow &&
                                                     std::abs(ego.yaw_rate_radps) < config_.straight_yaw_rate_radps);
  return {radar.nominal,
          scan,
          ego.speed_mps,
          straight ? 0.0 : ego.yaw_rate_radps,
          scan.has_elevation ? parameters_ : std::min(parameters_, 2),
          b,
          {},
          {}};
}

std::size_t PublishedMethod::select(const ScanView& scan) {
  const ScanDetections& detections = scan.detections;
  const PlanarModel model = scan.model(scan.b);
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(detections.count, kMaxDetections); ++i) {
    const double residual = scan.residual(model.value(detections.azimuth_rad[i], detections.elevation_rad[i]), i);
    if (!std::isfinite(residual)) continue;
    selected_[count] = static_cast<std::uint16_t>(i);
    residual_mps_[count++] = residual;
  }
  if (!config_.gate || count < config_.min_detections) return count;
  std::copy_n(residual_mps_.begin(), count, scratch_.begin());
  const double centre = median({scratch_.data(), count});
  for (std::size_t i = 0; i < count; ++i) scratch_[i] = std::abs(residual_mps_[i] - centre);
  const double limit =
      std::max(config_.gate_sigma * kMadToStd * median({scratch_.data(), count}), config_.gate_floor_mps);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(residual_mps_[i] - centre) < limit) selected_[inside++] = selected_[i];
  }
  return inside;
}

std::size_t PublishedMethod::number_of_delivering(std::int64_t now_ns) const {
  std::size_t count = 0;
  for (const Radar& radar : radars_) {
    if (radar.used && std::abs(now_ns - radar.last_used_ns) < kSilent_ns) ++count;
  }
  return std::max<std::size_t>(count, 1);
}

void PublishedMethod::process(std::size_t index, const ScanDetections& detections, const EgoSample& ego) {
  if (index >= radars_.size()) return;
  Radar& radar = radars_[index];
  if (radar.state == AlignmentState::kNoData) radar.state = AlignmentState::kWaiting;
  if (!usable(ego, config_.min_speed_mps)) return;
  ScanView scan = view(radar, detections, ego);
  const std::size_t believed = select(scan);
  if (believed < config_.min_detections) return;
  std::size_t used = believed;
  if (detections_per_scan_ > 0 && detections_per_scan_ < believed) {
    used = detections_per_scan_;
    draw_.to_front(selected_, believed, used);
  }
  scan.selected = {selected_.data(), used};
  const PlanarModel model = scan.model(scan.b);
  for (const std::uint16_t i : scan.selected) {
    RangeRate predicted = model(detections.azimuth_rad[i], detections.elevation_rad[i]);
    if (scan.parameters == 2) predicted.gradient.tail<2>().setZero();
    scan.equations.add(predicted.gradient, scan.residual(predicted.value_mps, i));
  }
  const std::int64_t elapsed_ns = radar.used ? detections.time_ns - radar.last_used_ns : 0;
  const double elapsed_s =
      std::clamp(static_cast<double>(elapsed_ns) * 1e-9, 0.0, kMaxCyclesBetween * radar.cycle_time_s);
  radar.used = true;
  radar.last_used_ns = detections.time_ns;
  radar.has_elevation = scan.parameters == 4;
  radar.seconds_of_drive += elapsed_s;
  ++radar.scans_used;
  radar.detections_used += used;
  const double keep = std::exp(-elapsed_s / config_.window_s);
  radar.jtj = keep * radar.jtj + scan.equations.jtj;
  radar.jtr = keep * radar.jtr + scan.equations.jtr;
  radar.rtr = keep * radar.rtr + scan.equations.rtr;
  radar.count = keep * radar.count + static_cast<double>(used);
  radar.offered = keep * radar.offered + static_cast<double>(std::min(detections.count, kMaxDetections));
  radar.believed = keep * radar.believed + static_cast<double>(believed);
  // Without elevation, pitch and roll keep the calibrated values.
  if (scan.parameters == 4) radar.seeded *= keep;
  move(radar, scan, step(scan));
}

void PublishedMethod::move(Radar& radar, const ScanView& scan, const Eigen::Vector4d& step) {
  const Eigen::Vector4d moved = scan.b + step;
  if (!moved.head(scan.parameters).allFinite()) return;
  const double share = 1.0 / static_cast<double>(number_of_delivering(radar.last_used_ns));
  speed_scale_ = std::clamp(speed_scale_ + share * step(0), 1.0 - config_.max_speed_scale_error,
                            1.0 + config_.max_speed_scale_error);
  for (int i = 1; i < scan.parameters; ++i)
    radar.angles(i - 1) = std::clamp(moved(i), -config_.max_angle_rad, config_.max_angle_rad);
}

void PublishedMethod::predict(std::size_t index, const ScanDetections& detections, const EgoSample& ego,
                              std::span<double> out) const {
  if (index >= radars_.size()) return;
  const ScanView scan = view(radars_[index], detections, ego);
  const PlanarModel model = scan.model(scan.b);
  for (std::size_t i = 0; i < std::min({detections.count, kMaxDetections, out.size()}); ++i)
    out[i] = model.value(detections.azimuth_rad[i], detections.elevation_rad[i]);
}

RadarEstimate PublishedMethod::estimate(std::size_t index) const {
  RadarEstimate out;
  if (index >= radars_.size()) return out;
  const Radar& radar = radars_[index];
  out.state = radar.state;
  out.speed_scale = speed_scale_;
  out.sensor_to_vehicle = geometry::sensor_to_vehicle(radar.nominal, radar.angles(0), radar.angles(1), radar.angles(2));
  out.inlier_ratio = radar.offered > 0.0 ? radar.believed / radar.offered : 0.0;
  out.scans_used = radar.scans_used;
  out.detections_used = radar.detections_used;
  out.seconds_of_drive = radar.seconds_of_drive;

  Eigen::Vector4d prior_std = Eigen::Vector4d::Constant(config_.prior_angle_std_rad);
  prior_std(0) = config_.prior_speed_scale_std;
  Eigen::Matrix4d information = prior_std.cwiseAbs2().cwiseInverse().asDiagonal();
  const double variance = radar.count > 0.0 ? radar.rtr / radar.count : 0.0;
  // Noise-free data would give a zero covariance and a singular matrix.
  const double floored = std::max(variance, 1e-8);
  information += radar.jtj / floored;
  information.bottomRightCorner<3, 3>() += radar.seeded;
  const Eigen::LLT<Eigen::Matrix4d> factor(information);
  Eigen::Matrix4d covariance = factor.solve(Eigen::Matrix4d::Identity());
  covariance = 0.5 * (covariance + covariance.transpose()).eval();
  // The remaining Gauss–Newton step: the distance to the optimum of the window's data.
  const Eigen::Vector4d distance = factor.solve(radar.jtr / floored);
  Eigen::Matrix4d to_vehicle = Eigen::Matrix4d::Identity();
  to_vehicle.bottomRightCorner<3, 3>() = geometry::euler_gradient_inverse(radar.nominal.yaw_rad + radar.angles(0),
                                                                          radar.nominal.pitch_rad + radar.angles(1));
  out.covariance = to_vehicle * covariance * to_vehicle.transpose();

  const bool is_seeded = !radar.seeded.isZero();
  const auto known = [&](int i) {
    return (radar.used || is_seeded) && out.covariance(i, i) < 0.25 * prior_std(i) * prior_std(i);
  };
  if (known(0)) out.observable |= alignment_axis::kSpeedScale;
  if (known(3)) out.observable |= alignment_axis::kVehicleYaw;
  // A method or a sensor without elevation does not determine pitch and roll, but a static calibration may have.
  const bool has_pitch_and_roll = radar.has_elevation || is_seeded;
  if (has_pitch_and_roll && known(2)) out.observable |= alignment_axis::kVehiclePitch;
  if (has_pitch_and_roll && known(1)) out.observable |= alignment_axis::kVehicleRoll;

  if (radar.used) {
    constexpr std::uint32_t kNeeded = alignment_axis::kSpeedScale | alignment_axis::kVehicleYaw;
    const bool arrived =
        (out.observable & kNeeded) == kNeeded && std::sqrt(out.covariance(3, 3)) < config_.converged_angle_rad &&
        std::abs(distance(1)) < config_.converged_angle_rad && std::abs(distance(0)) < config_.converged_speed_scale;
    out.state = arrived ? AlignmentState::kConverged : AlignmentState::kConverging;
  }
  return out;
}

void PublishedMethod::save(Memory& memory) const {
  memory = {};
  memory.number_of_radars = std::min(radars_.size(), memory.radars.size());
  memory.speed_scale = speed_scale_;
  for (std::size_t r = 0; r < memory.number_of_radars; ++r) {
    const RadarEstimate e = estimate(r);
    const Eigen::Vector3d d = geometry::so3_log(
        e.sensor_to_vehicle * geometry::sensor_to_vehicle(radars_[r].nominal, 0.0, 0.0, 0.0).transpose());
    Memory::Radar& known = memory.radars[r];
    known.id = radars_[r].id;
    known.rotation_vehicle_rad = {d.x(), d.y(), d.z()};
    known.seconds_of_drive = e.seconds_of_drive;
    double& variance = memory.variance(Memory::kSpeedScale, Memory::kSpeedScale);
    if (r == 0 || e.covariance(0, 0) < variance) variance = e.covariance(0, 0);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i) + 1;
      known.rotation_variance(i, i) = e.covariance(row, row);
    }
  }
}

void PublishedMethod::restore(const Memory& memory, double /*away_s*/) {
  if (memory.number_of_radars != radars_.size()) return;
  if (std::abs(memory.speed_scale - 1.0) <= config_.max_speed_scale_error) speed_scale_ = memory.speed_scale;
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Memory::Radar& known = memory.radars[r];
    if (known.id != radars_[r].id || !turn(radars_[r], Eigen::Vector3d(known.rotation_vehicle_rad.data()))) continue;
    radars_[r].seconds_of_drive = known.seconds_of_drive;
  }
}

bool PublishedMethod::seed(std::size_t index, const Eigen::Vector3d& rotation_vehicle_rad,
                           const Eigen::Matrix3d& covariance) {
  if (index >= radars_.size() || parameters_ != 4 || !covariance.allFinite()) return false;
  const Eigen::LLT<Eigen::Matrix3d> factor(covariance);
  Radar& radar = radars_[index];
  if (factor.info() != Eigen::Success || !turn(radar, rotation_vehicle_rad)) return false;
  const Eigen::Matrix3d to_vehicle = geometry::euler_gradient_inverse(radar.nominal.yaw_rad + radar.angles(0),
                                                                      radar.nominal.pitch_rad + radar.angles(1));
  radar.seeded = to_vehicle.transpose() * factor.solve(to_vehicle);
  radar.seeded = 0.5 * (radar.seeded + radar.seeded.transpose()).eval();
  // The earlier sums belong to another mounting.
  radar.jtj.setZero();
  radar.jtr.setZero();
  radar.rtr = radar.count = radar.offered = radar.believed = 0.0;
  radar.seconds_of_drive = 0.0;
  return true;
}

bool PublishedMethod::turn(Radar& radar, const Eigen::Vector3d& rotation_vehicle_rad) const {
  if (!rotation_vehicle_rad.allFinite()) return false;
  const Eigen::Matrix3d actual =
      geometry::so3_exp(rotation_vehicle_rad) * geometry::sensor_to_vehicle(radar.nominal, 0.0, 0.0, 0.0);
  const Eigen::Vector3d total = geometry::euler_angles(actual);
  Eigen::Vector3d angles(geometry::wrap_angle(total(0) - radar.nominal.yaw_rad), total(1) - radar.nominal.pitch_rad,
                         geometry::wrap_angle(total(2) - radar.nominal.roll_rad));
  if (angles.cwiseAbs().maxCoeff() > config_.max_angle_rad) return false;
  if (parameters_ == 2) angles.tail<2>().setZero();
  radar.angles = angles;
  return true;
}

}  // namespace boresight::alignment::published
