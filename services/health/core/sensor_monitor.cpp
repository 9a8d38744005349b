#include "services/health/core/sensor_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "services/common/geometry/so3.hpp"

namespace boresight::health {

namespace {

double std_of(const std::array<float, 16>& covariance, AlignmentParameter parameter) {
  const auto i = static_cast<std::size_t>(parameter);
  return std::sqrt(static_cast<double>(covariance[i * kNumberOfAlignmentParameters + i]));
}

/// The smallest rotation about a vehicle axis (0 x, 1 y, 2 z) that brings one of the sensor's angles to its tolerance,
/// or its limit, `t`.
double about_vehicle(const RadarConfig& radar, Eigen::Index axis, const AlignmentTolerance& t) {
  const MountingPose& pose = radar.mounting_pose;
  // Yaw and roll are the same rotation for a radar that looks straight up or down: only its own axes are tested.
  if (std::abs(std::cos(pose.pitch_rad)) < 0.1) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d angles = geometry::euler_gradient(pose.yaw_rad, pose.pitch_rad).col(axis).cwiseAbs();
  return (Eigen::Vector3d(t.yaw_rad, t.pitch_rad, t.roll_rad).array() / angles.array().max(1e-3)).minCoeff();
}

/// Time from measurement to the arrival at the gateway; negative if the measurement has no stamp of the sensor.
std::int64_t age_at_arrival_ns(const MessageHeader& header) {
  const bool is_stamped =
      header.time_source == TimeSource::kSensorSynchronised || header.time_source == TimeSource::kSensorFreeRunning;
  const std::int64_t arrival_ns = header.stage(Stage::kIngest).begin_ns;
  return is_stamped && arrival_ns > 0 ? std::max<std::int64_t>(0, arrival_ns - header.measurement_time_ns) : -1;
}

/// Detections that the sensor does not forbid to use, and the range that the share `range_quantile` of them does not
/// exceed.
SeenScan seen_in(const RadarScan& scan, double range_quantile) {
  std::array<float, kMaxDetections> ranges;
  std::size_t count = 0;
  const std::size_t detections = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < detections; ++i) {
    if ((scan.detection_flags[i] & detection_flag::kUnusable) == 0) ranges[count++] = scan.range_m[i];
  }
  if (count == 0) return {};
  const auto end = ranges.begin() + static_cast<std::ptrdiff_t>(count);
  const auto nth = ranges.begin() + static_cast<std::ptrdiff_t>(range_quantile * static_cast<double>(count - 1));
  std::nth_element(ranges.begin(), nth, end);
  return {.detections = static_cast<double>(count), .range_m = static_cast<double>(*nth)};
}

/// False for data of doubtful integrity. A gap before a scan says nothing against the scan.
bool is_sound(const RadarScan& scan) {
  return (scan.integrity & ~scan_integrity::kCounterGap) == 0;
}

/// An axis against tolerance and limit, about the sensor and about a vehicle axis (0 x, 1 y, 2 z).
AngleJudge angle_judge(const RadarConfig& radar, const Config& config, double AlignmentTolerance::*angle,
                       Eigen::Index axis) {
  return {{config, radar.tolerance.*angle, radar.limit.*angle},
          {config, about_vehicle(radar, axis, radar.tolerance), about_vehicle(radar, axis, radar.limit)}};
}

/// The verdict on an axis as the fault memory has it. If this process has no estimate of the axis, its values are those
/// at the latest occurrence.
void show_last_known(AxisHealth& axis, const FaultRecord* record, const FaultRecord* limit,
                     AlignmentParameter parameter) {
  if (record == nullptr || limit == nullptr) return;
  axis.beyond_tolerance = record->status.last == TestResult::kFailed ? 1 : 0;
  axis.effect = effect_of(record->status.last, limit->status.last);
  if (axis.beyond_tolerance == 0 || axis.std_rad != 0.0F) return;
  const auto i = static_cast<std::size_t>(parameter);
  const std::size_t variance = i * kNumberOfAlignmentParameters - i * (i + 1) / 2 + i;  // in the upper triangle
  const float error_rad = record->latest.estimate[i];
  if (!std::isfinite(error_rad)) return;
  axis.error_rad = error_rad;
  axis.std_rad = std::sqrt(record->latest.covariance[variance]);
  set_probabilities(axis);
}

}  // namespace

SensorMonitor::SensorMonitor(const RadarConfig& radar, const Config& config, std::int64_t start_ns)
    : radar_id_(radar.id),
      config_(config),
      delivery_(config.delivery, 1.0 / radar.cycle_time_s, radar.deadline_s, radar.latency_s, config.window_s,
                start_ns),
      sight_monitor_(config.sight),
      unexplained_(radar, config.disturbance.explanation),
      disturbance_(config.disturbance),
      messages_(config.window_s),
      rejected_(config.window_s),
      suspect_(config.window_s),
      received_(config.window_s),
      frozen_(config.window_s),
      contradicting_(config.window_s),
      yaw_(angle_judge(radar, config, &AlignmentTolerance::yaw_rad, 2)),
      pitch_(angle_judge(radar, config, &AlignmentTolerance::pitch_rad, 1)),
      roll_(angle_judge(radar, config, &AlignmentTolerance::roll_rad, 0)),
      sight_{radar.mounting_pose, radar.field_of_view, radar.antenna, radar.region_of_interest} {}

Event SensorMonitor::event(RadarEvent radar_event) const {
  return {kind_of(radar_event), static_cast<std::uint8_t>(radar_id_)};
}

void SensorMonitor::observe(const RadarScan& scan, std::int64_t now_ns) {
  const std::uint64_t sequence = scan.header.source_sequence;
  // A restarted gateway counts from 1 again: no scan was lost.
  if (last_sequence_ != 0 && sequence > last_sequence_ + 1) lost_scans_ += sequence - last_sequence_ - 1;
  last_sequence_ = sequence;
  delivery_.observe(age_at_arrival_ns(scan.header), now_ns);
  using namespace scan_integrity;
  received_.add(now_ns);
  if ((scan.integrity & (kFrozen | kRepeated)) != 0) frozen_.add(now_ns);
  if ((scan.integrity & kContradictsEgo) != 0) contradicting_.add(now_ns);
  observe_content(scan, now_ns);
}

void SensorMonitor::observe_content(const RadarScan& scan, std::int64_t now_ns) {
  SeenScan seen = seen_in(scan, config_.sight.range_quantile);
  seen.is_sound = is_sound(scan);
  sight_monitor_.observe(seen, motion_.speed_mps, now_ns);
  // Data that are proven wrong are no disturbance.
  const std::optional<ExplainedScan> explained = seen.is_sound ? unexplained_.explain(scan, motion_) : std::nullopt;
  if (explained) {
    disturbance_.observe(*explained, motion_.speed_mps, now_ns);
  } else {
    disturbance_.skip();
  }
  constexpr double kSmoothing = 0.1;
  detections_per_scan_ = delivery_.scans() == 1
                             ? seen.detections
                             : detections_per_scan_ + kSmoothing * (seen.detections - detections_per_scan_);
}

void SensorMonitor::observe(const EgoMotion& motion) {
  motion_.speed_mps = motion.has(ego_field::kSpeed) ? motion.speed_mps : std::numeric_limits<double>::quiet_NaN();
  motion_.is_signed = motion.has(ego_field::kReverse);
  motion_.yaw_rate_radps = motion.has(ego_field::kYawRate) ? motion.yaw_rate_radps : 0.0;
}

RadarLevels SensorMonitor::levels() const {
  return {.radar_id = radar_id_, .sight = sight_monitor_.levels(), .log_unexplained = disturbance_.level()};
}

void SensorMonitor::restore(const RadarLevels& levels) {
  sight_monitor_.restore(levels.sight);
  disturbance_.restore(levels.log_unexplained);
}

void SensorMonitor::judge_axes(const AlignmentEstimate& estimate) {
  const bool estimating = estimate.state == AlignmentState::kConverging || estimate.state == AlignmentState::kConverged;
  const std::int64_t time_ns = estimate.header.measurement_time_ns;
  const auto judge = [&](AngleJudge& angle, AlignmentParameter parameter, float sensor_rad, std::uint32_t sensor_bit,
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
  using namespace alignment_axis;
  constexpr std::uint32_t kAngles = kYaw | kPitch | kRoll | kVehicleYaw | kVehiclePitch | kVehicleRoll;
  // As the errors of axes that are not observable any more, the losses stay those last known.
  if (!estimating || (estimate.observable & kAngles) == 0) return;
  const Eigen::Matrix3d mounting = actual_mounting(sight_.mounting_pose, estimate);
  // A solution is published many times, and the losses need a thousand directions.
  if (mounting == mounting_) return;
  mounting_ = mounting;
  sight_loss_ = sight_loss(sight_, mounting);
}

void SensorMonitor::observe(const AlignmentEstimate& estimate) {
  has_estimate_ = true;
  estimate_ = {estimate.speed_scale, estimate.alignment_yaw_rad, estimate.alignment_pitch_rad,
               estimate.alignment_roll_rad};
  std::size_t entry = 0;
  for (std::size_t row = 0; row < kNumberOfAlignmentParameters; ++row) {
    for (std::size_t column = row; column < kNumberOfAlignmentParameters; ++column) {
      covariance_[entry++] = estimate.covariance[row * kNumberOfAlignmentParameters + column];
    }
  }
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
    for (AngleJudge* angle : {&yaw_, &pitch_, &roll_}) angle->clear();
    mounting_.setZero();
    sight_loss_ = {};
    drift_ = {};
  }
  step_changes_ = estimate.step_change.count;
  const double scale_std = std_of(estimate.covariance, AlignmentParameter::kSpeedScale);
  if (!std::isfinite(estimate.speed_scale) || !std::isfinite(scale_std)) return;
  speed_scale_ = estimate.speed_scale;
  speed_scale_std_ = scale_std;
}

void SensorMonitor::observe(const SourceStatistics& statistics, std::int64_t now_ns) {
  has_statistics_ = true;
  // A smaller counter is that of a new process, which counts from zero.
  const auto grown = [](std::uint64_t now, std::uint64_t before) { return now >= before ? now - before : now; };
  messages_.add(now_ns, grown(statistics.messages, last_statistics_.messages));
  rejected_.add(now_ns, grown(statistics.rejected, last_statistics_.rejected));
  suspect_.add(now_ns, grown(statistics.suspect, last_statistics_.suspect));
  last_statistics_ = statistics;
}

SensorHealth SensorMonitor::quantities(std::int64_t now_ns) {
  SensorHealth health{};
  health.radar_id = radar_id_;
  health.rate_hz = static_cast<float>(delivery_.rate_hz(now_ns));
  health.expected_rate_hz = static_cast<float>(delivery_.expected_rate_hz());
  health.last_seen_s = static_cast<float>(delivery_.last_seen_s(now_ns));
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
  health.reference_range_m = static_cast<float>(config_.reference_range_m);
  health.scans = delivery_.scans();
  health.lost_scans = lost_scans_;
  health.conditions = last_statistics_.conditions & ~source_condition::kReported;
  health.step_changes = step_changes_;
  health.missed_scans = last_statistics_.lost;
  health.suspect_scans = last_statistics_.suspect;
  health.e2e_lost = last_statistics_.e2e_lost;
  health.e2e_repeated = last_statistics_.e2e_repeated;
  health.e2e_wrong = last_statistics_.e2e_wrong;
  return health;
}

void SensorMonitor::set_consequences(SensorHealth& health, float speed_mps) const {
  const double yaw_rad = health.yaw.error_rad;
  health.lateral_displacement_m = static_cast<float>(lateral_displacement_m(config_.reference_range_m, yaw_rad));
  health.lost_coverage_ratio = static_cast<float>(sight_loss_.coverage_ratio);
  health.range_loss_ratio = static_cast<float>(sight_loss_.range_ratio);
  health.velocity_error_mps = static_cast<float>(velocity_error_mps(speed_mps, yaw_rad));
}

FreezeFrame SensorMonitor::frame_of(const SensorHealth& health, const FreezeFrame& vehicle) const {
  FreezeFrame frame = vehicle;
  frame.rate_hz = health.rate_hz;
  frame.detections_per_scan = health.detections_per_scan;
  frame.lateral_displacement_m = health.lateral_displacement_m;
  frame.reference_range_m = health.reference_range_m;
  frame.lost_coverage_ratio = health.lost_coverage_ratio;
  frame.range_loss_ratio = health.range_loss_ratio;
  frame.velocity_error_mps = health.velocity_error_mps;
  frame.estimate = estimate_;
  frame.covariance = covariance_;
  return frame;
}

void SensorMonitor::test_axis(FaultMemory& faults, RadarEvent misaligned, RadarEvent beyond_limit,
                              const AngleJudge& angle, std::int64_t now_ns, const FreezeFrame& frame) const {
  if (finding_ != AlignmentFinding::kNone) {
    // The angles were computed from a wrong input: neither an old nor a new verdict on them counts.
    faults.withdraw(event(misaligned));
    faults.withdraw(event(beyond_limit));
    return;
  }
  faults.report(event(misaligned), angle.tolerance(), now_ns, frame);
  faults.report(event(beyond_limit), angle.limit(), now_ns, frame);
}

void SensorMonitor::test(FaultMemory& faults, std::int64_t now_ns, const SensorHealth& health,
                         const FreezeFrame& vehicle) {
  const FreezeFrame frame = frame_of(health, vehicle);
  const auto report = [&](RadarEvent radar_event, bool is_tested, bool is_failed) {
    const TestResult result = !is_tested ? TestResult::kNone : is_failed ? TestResult::kFailed : TestResult::kPassed;
    faults.report(event(radar_event), result, now_ns, frame);
  };
  using namespace source_condition;
  // The last status of a sensor stays valid while the sensor is silent.
  const bool has_reported = (last_statistics_.conditions & kReported) != 0;
  for (const auto& [radar_event, condition] :
       {std::pair{RadarEvent::kDefective, kDefective}, std::pair{RadarEvent::kBlocked, kBlocked},
        std::pair{RadarEvent::kPartlyBlocked, kPartlyBlocked}, std::pair{RadarEvent::kSupply, kSupply},
        std::pair{RadarEvent::kTemperature, kTemperature}, std::pair{RadarEvent::kUnsynchronised, kUnsynchronised},
        std::pair{RadarEvent::kWithoutEgoMotion, kWithoutEgoMotion}}) {
    report(radar_event, has_reported, (health.conditions & condition) != 0);
  }
  faults.report(event(RadarEvent::kNoData), delivery_.silent(now_ns), now_ns, frame);
  faults.report(event(RadarEvent::kRateReduced), delivery_.rate_reduced(now_ns), now_ns, frame);
  faults.report(event(RadarEvent::kRateTooHigh), delivery_.rate_too_high(now_ns), now_ns, frame);
  faults.report(event(RadarEvent::kDelayed), delivery_.delayed(now_ns), now_ns, frame);
  const double rejected = static_cast<double>(rejected_.sum(now_ns));
  const double published = static_cast<double>(messages_.sum(now_ns));
  const double suspect = static_cast<double>(suspect_.sum(now_ns));
  report(RadarEvent::kRejectedData, has_statistics_, rejected > config_.max_rejected_ratio * (published + rejected));
  report(RadarEvent::kSuspectData, has_statistics_, suspect > config_.max_suspect_ratio * published);
  const auto received = static_cast<double>(received_.sum(now_ns));
  const auto exceeds = [&](RateWindow& scans) {
    return static_cast<double>(scans.sum(now_ns)) > config_.max_suspect_ratio * received;
  };
  report(RadarEvent::kFrozen, received > 0.0, exceeds(frozen_));
  report(RadarEvent::kEgoContradiction, received > 0.0, exceeds(contradicting_));
  faults.report(event(RadarEvent::kBlind), sight_monitor_.blind(), now_ns, frame);
  faults.report(event(RadarEvent::kReducedSight), sight_monitor_.reduced(), now_ns, frame);
  faults.report(event(RadarEvent::kDisturbed), disturbance_.disturbed(), now_ns, frame);
  report(RadarEvent::kWrongInput, has_estimate_, finding_ != AlignmentFinding::kNone);
  test_axis(faults, RadarEvent::kYawMisaligned, RadarEvent::kYawBeyondLimit, yaw_, now_ns, frame);
  test_axis(faults, RadarEvent::kPitchMisaligned, RadarEvent::kPitchBeyondLimit, pitch_, now_ns, frame);
  test_axis(faults, RadarEvent::kRollMisaligned, RadarEvent::kRollBeyondLimit, roll_, now_ns, frame);
}

void SensorMonitor::set_verdict(SensorHealth& health, const FaultMemory& faults) const {
  health.data_qualifier = DataQualifier::kAvailable;
  health.extended_qualifier = ExtendedQualifier::kNormal;
  for (std::size_t i = 0; i < kNumberOfRadarEvents; ++i) {
    const auto radar_event = static_cast<RadarEvent>(i);
    const FaultRecord* const record = faults.find(event(radar_event));
    if (record == nullptr) continue;
    // Data that an earlier process saw say nothing about data now.
    const bool counts = radar_event != RadarEvent::kNoData || record->tested_since_start;
    if (record->status.last == TestResult::kNone || !counts) health.untested_events |= bit_of(radar_event);
    if (record->status.last != TestResult::kFailed) continue;
    health.failed_events |= bit_of(radar_event);
    const EventType& type = type_of(kind_of(radar_event));
    if (type.effect <= health.data_qualifier) continue;  // the first of the worst effect is the reason
    health.data_qualifier = type.effect;
    health.extended_qualifier = type.reason;
  }
  const auto is_failed = [&health](RadarEvent e) { return (health.failed_events & bit_of(e)) != 0; };
  const auto is_untested = [&health](RadarEvent e) { return (health.untested_events & bit_of(e)) != 0; };
  // Frames arrive, but none is usable: the reason for the silence.
  if (health.extended_qualifier == ExtendedQualifier::kNoData && is_failed(RadarEvent::kRejectedData)) {
    health.extended_qualifier = ExtendedQualifier::kInvalidData;
  }
  if (health.data_qualifier == DataQualifier::kAvailable &&
      (is_untested(RadarEvent::kNoData) || is_untested(RadarEvent::kYawMisaligned))) {
    // Never available before it was tested: without data, or with a mounting that was never verified.
    health.data_qualifier =
        is_untested(RadarEvent::kNoData) ? DataQualifier::kNotAvailable : DataQualifier::kAvailableReduced;
    health.extended_qualifier = ExtendedQualifier::kInitialising;
  }
  show_last_known(health.yaw, faults.find(event(RadarEvent::kYawMisaligned)),
                  faults.find(event(RadarEvent::kYawBeyondLimit)), AlignmentParameter::kYaw);
  show_last_known(health.pitch, faults.find(event(RadarEvent::kPitchMisaligned)),
                  faults.find(event(RadarEvent::kPitchBeyondLimit)), AlignmentParameter::kPitch);
  show_last_known(health.roll, faults.find(event(RadarEvent::kRollMisaligned)),
                  faults.find(event(RadarEvent::kRollBeyondLimit)), AlignmentParameter::kRoll);
}

SensorHealth SensorMonitor::judge(FaultMemory& faults, std::int64_t now_ns, const FreezeFrame& vehicle) {
  SensorHealth health = quantities(now_ns);
  set_consequences(health, vehicle.speed_mps);
  test(faults, now_ns, health, vehicle);
  set_verdict(health, faults);
  set_consequences(health, vehicle.speed_mps);
  return health;
}

void SensorMonitor::restore(const FaultMemory& faults) {
  const auto restore_angle = [&](AngleJudge& angle, RadarEvent misaligned, RadarEvent beyond_limit) {
    const bool is_beyond = faults.is_failed(event(misaligned));
    angle.restore(is_beyond, faults.is_failed(event(beyond_limit)));
    const FaultRecord* const record = faults.find(event(misaligned));
    if (is_beyond && std::isfinite(record->latest.lost_coverage_ratio)) {
      sight_loss_ = {record->latest.lost_coverage_ratio, record->latest.range_loss_ratio};
    }
  };
  restore_angle(yaw_, RadarEvent::kYawMisaligned, RadarEvent::kYawBeyondLimit);
  restore_angle(pitch_, RadarEvent::kPitchMisaligned, RadarEvent::kPitchBeyondLimit);
  restore_angle(roll_, RadarEvent::kRollMisaligned, RadarEvent::kRollBeyondLimit);
}

}  // namespace boresight::health
