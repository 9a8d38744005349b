#include "services/health/core/sensor_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/common/geometry/so3.hpp"

namespace boresight::health {

namespace {

double std_of(const std::array<float, 16>& covariance, AlignmentParameter parameter) {
  const auto i = static_cast<std::size_t>(parameter);
  return std::sqrt(static_cast<double>(covariance[i * kNumberOfAlignmentParameters + i]));
}

/// The smallest rotation about a vehicle axis (0 x, 1 y, 2 z) that brings one of the sensor's angles to its tolerance.
double vehicle_tolerance(const RadarConfig& radar, Eigen::Index axis) {
  const MountingPose& pose = radar.mounting_pose;
  // Yaw and roll are the same rotation for a radar that looks straight up or down: only its own axes are tested.
  if (std::abs(std::cos(pose.pitch_rad)) < 0.1) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d angles = geometry::euler_gradient(pose.yaw_rad, pose.pitch_rad).col(axis).cwiseAbs();
  const AlignmentTolerance& t = radar.tolerance;
  return (Eigen::Vector3d(t.yaw_rad, t.pitch_rad, t.roll_rad).array() / angles.array().max(1e-3)).minCoeff();
}

}  // namespace

SensorMonitor::SensorMonitor(const RadarConfig& radar, const Config& config, std::int64_t start_ns)
    : radar_id_(radar.id),
      expected_rate_hz_(1.0 / radar.cycle_time_s),
      deadline_ns_(static_cast<std::int64_t>(radar.deadline_s * 1e9)),
      config_(config),
      start_ns_(start_ns),
      rate_(std::max(config.window_s, 10.0 * radar.cycle_time_s)),
      messages_(config.window_s),
      rejected_(config.window_s),
      suspect_(config.window_s),
      yaw_{{config, radar.tolerance.yaw_rad}, {config, vehicle_tolerance(radar, 2)}},
      pitch_{{config, radar.tolerance.pitch_rad}, {config, vehicle_tolerance(radar, 1)}},
      roll_{{config, radar.tolerance.roll_rad}, {config, vehicle_tolerance(radar, 0)}} {}

AxisHealth SensorMonitor::Angle::health() const {
  const bool by_vehicle = sensor.is_beyond() ? false : vehicle.is_beyond() || !sensor.is_observable();
  if (!by_vehicle || !vehicle.is_observable()) return sensor.health();
  AxisHealth health = vehicle.health();
  health.about_vehicle_axis = 1;
  return health;
}

void SensorMonitor::observe(const RadarScan& scan, std::int64_t now_ns) {
  // The rate restarts after a silence. Otherwise it would stay low for a window after the radar has returned.
  if (!delivers(now_ns)) rate_.clear();
  const std::uint64_t sequence = scan.header.source_sequence;
  // A restarted gateway counts from 1 again: no scan was lost.
  if (last_sequence_ != 0 && sequence > last_sequence_ + 1) lost_scans_ += sequence - last_sequence_ - 1;
  last_sequence_ = sequence;
  ++scans_;
  last_ns_ = now_ns;
  rate_.add(now_ns);
  constexpr double kSmoothing = 0.1;
  const double count = scan.number_of_valid_detections;
  detections_per_scan_ = scans_ == 1 ? count : detections_per_scan_ + kSmoothing * (count - detections_per_scan_);
}

void SensorMonitor::judge_axes(const AlignmentEstimate& estimate) {
  const bool estimating = estimate.state == AlignmentState::kConverging || estimate.state == AlignmentState::kConverged;
  const std::int64_t time_ns = estimate.header.measurement_time_ns;
  const auto judge = [&](Angle& angle, AlignmentParameter parameter, float sensor_rad, std::uint32_t sensor_bit,
                         float vehicle_rad, std::uint32_t vehicle_bit) {
    angle.sensor.update(sensor_rad, std_of(estimate.covariance, parameter),
                        estimating && estimate.is_observable(sensor_bit), time_ns);
    angle.vehicle.update(vehicle_rad, std_of(estimate.vehicle_covariance, parameter),
                         estimating && estimate.is_observable(vehicle_bit), time_ns);
  };
  judge(yaw_, AlignmentParameter::kYaw, estimate.alignment_yaw_rad, alignment_axis::kYaw, estimate.vehicle_yaw_rad,
        alignment_axis::kVehicleYaw);
  judge(pitch_, AlignmentParameter::kPitch, estimate.alignment_pitch_rad, alignment_axis::kPitch,
        estimate.vehicle_pitch_rad, alignment_axis::kVehiclePitch);
  judge(roll_, AlignmentParameter::kRoll, estimate.alignment_roll_rad, alignment_axis::kRoll, estimate.vehicle_roll_rad,
        alignment_axis::kVehicleRoll);
}

void SensorMonitor::observe(const AlignmentEstimate& estimate) {
  reason_ = estimate.reason;
  finding_ = estimate.finding;
  finding_value_ = estimate.finding_value;
  finding_radar_ = estimate.finding_radar;
  range_rate_scale_ = estimate.nuisance.range_rate_scale;
  drift_ = estimate.drift;
  if (finding_ == AlignmentFinding::kNone) {
    judge_axes(estimate);
  } else {
    // The angles were computed from a wrong input. No mounting error follows from them.
    for (Angle* angle : {&yaw_, &pitch_, &roll_}) angle->clear();
    drift_ = {};
  }
  step_changes_ = estimate.step_change.count;
  const double scale_std = std_of(estimate.covariance, AlignmentParameter::kSpeedScale);
  if (!std::isfinite(estimate.speed_scale) || !std::isfinite(scale_std)) return;
  speed_scale_ = estimate.speed_scale;
  speed_scale_std_ = scale_std;
}

void SensorMonitor::observe(const SourceStatistics& statistics, std::int64_t now_ns) {
  // A smaller counter is that of a new process, which counts from zero.
  const auto grown = [](std::uint64_t now, std::uint64_t before) { return now >= before ? now - before : now; };
  messages_.add(now_ns, grown(statistics.messages, last_statistics_.messages));
  rejected_.add(now_ns, grown(statistics.rejected, last_statistics_.rejected));
  suspect_.add(now_ns, grown(statistics.suspect, last_statistics_.suspect));
  last_statistics_ = statistics;
}

SensorHealth SensorMonitor::judge(std::int64_t now_ns) {
  SensorHealth health{};
  health.radar_id = radar_id_;
  health.rate_hz = static_cast<float>(delivers(now_ns) ? rate_.rate_hz(now_ns) : 0.0);
  health.expected_rate_hz = static_cast<float>(expected_rate_hz_);
  health.last_seen_s = scans_ == 0 ? -1.0F : static_cast<float>(static_cast<double>(now_ns - last_ns_) * 1e-9);
  health.detections_per_scan = static_cast<float>(detections_per_scan_);
  health.yaw = yaw_.health();
  health.pitch = pitch_.health();
  health.roll = roll_.health();
  health.speed_scale = static_cast<float>(speed_scale_);
  health.speed_scale_std = static_cast<float>(speed_scale_std_);
  health.reason = reason_;
  health.finding = finding_;
  health.finding_value = finding_value_;
  health.finding_radar = finding_radar_;
  health.range_rate_scale = range_rate_scale_;
  health.drift = drift_;
  health.lateral_displacement_m = static_cast<float>(config_.reference_range_m * std::sin(health.yaw.error_rad));
  health.reference_range_m = static_cast<float>(config_.reference_range_m);
  health.scans = scans_;
  health.lost_scans = lost_scans_;
  health.conditions = last_statistics_.conditions;
  health.step_changes = step_changes_;
  health.missed_scans = last_statistics_.lost;
  health.suspect_scans = last_statistics_.suspect;
  health.e2e_lost = last_statistics_.e2e_lost;
  health.e2e_repeated = last_statistics_.e2e_repeated;
  health.e2e_wrong = last_statistics_.e2e_wrong;

  const bool misaligned = yaw_.is_beyond() || pitch_.is_beyond() || roll_.is_beyond();
  const bool inhibited = yaw_.is_inhibited() || pitch_.is_inhibited() || roll_.is_inhibited();
  const double rejected = static_cast<double>(rejected_.sum(now_ns));
  const double published = static_cast<double>(messages_.sum(now_ns));
  const double suspect = static_cast<double>(suspect_.sum(now_ns));
  const bool is_rejected = rejected > config_.max_rejected_ratio * (published + rejected);
  const bool is_suspect = suspect > config_.max_suspect_ratio * published;
  const auto reports = [&health](std::uint32_t condition) { return (health.conditions & condition) != 0; };
  const auto verdict = [&health](DataQualifier effect, ExtendedQualifier reason) {
    health.data_qualifier = effect;
    health.extended_qualifier = reason;
    return health;
  };
  // The worst effect first; for equal effects the reason that a workshop must repair. The sensor's last status also
  // explains its silence, so it is tested before the delivery.
  if (reports(source_condition::kDefective))
    return verdict(DataQualifier::kNotAvailable, ExtendedQualifier::kInvalidData);
  if (reports(source_condition::kBlocked)) return verdict(DataQualifier::kNotAvailable, ExtendedQualifier::kBlocked);
  if (!delivers(now_ns)) {
    if (is_rejected) return verdict(DataQualifier::kNotAvailable, ExtendedQualifier::kInvalidData);
    const bool young = scans_ == 0 && now_ns - start_ns_ <= deadline_ns_;
    return verdict(DataQualifier::kNotAvailable, young ? ExtendedQualifier::kInitialising : ExtendedQualifier::kNoData);
  }
  if (finding_ != AlignmentFinding::kNone) {
    return verdict(DataQualifier::kAvailableReduced, ExtendedQualifier::kWrongInput);
  }
  if (inhibited) return verdict(DataQualifier::kNotAvailable, ExtendedQualifier::kMisaligned);
  if (misaligned) return verdict(DataQualifier::kAvailableReduced, ExtendedQualifier::kMisaligned);
  if (reports(source_condition::kPartlyBlocked)) {
    return verdict(DataQualifier::kAvailableReduced, ExtendedQualifier::kBeginningBlockage);
  }
  if (is_rejected || is_suspect) return verdict(DataQualifier::kAvailableReduced, ExtendedQualifier::kInvalidData);
  if (rate_.is_full(now_ns) && health.rate_hz < config_.min_rate_ratio * expected_rate_hz_) {
    return verdict(DataQualifier::kAvailableReduced, ExtendedQualifier::kRateReduced);
  }
  return verdict(DataQualifier::kAvailable, ExtendedQualifier::kNormal);
}

}  // namespace boresight::health
