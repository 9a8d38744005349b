#include "services/boresight/report/run_snapshots.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "services/boresight/monitor/accumulator.hpp"
#include "services/boresight/report/recorded_scans.hpp"
#include "services/boresight/score/run_folder.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::report {

namespace {

constexpr std::int64_t kSnapshotPeriod_ns = 500'000'000;  // that of the monitor's record
constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

/// Covariance over (speed scale, three angles) as a message has it. `gradient`: change of the angles by a small
/// rotation about the vehicle's axes.
std::array<float, 16> covariance_of_angles(const Eigen::Matrix4d& covariance, const Eigen::Matrix3d& gradient) {
  Eigen::Matrix4d jacobian = Eigen::Matrix4d::Identity();
  jacobian.bottomRightCorner<3, 3>() = gradient;
  const Eigen::Matrix4d result = jacobian * covariance * jacobian.transpose();
  std::array<float, 16> cells{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i] = static_cast<float>(result(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)));
  }
  return cells;
}

/// The message that a row of alignment.csv was written from. The table has neither key figures nor the errors of the
/// vehicle's signals.
AlignmentEstimate message_of(const score::RunAlignment& row, const judge::AlignmentSample& sample,
                             const MountingPose& nominal) {
  AlignmentEstimate message{};
  message.header.source_id = sample.radar;
  message.state = row.state();
  message.observable = row.observable() & ~(alignment_axis::kYawRateBias | alignment_axis::kSlip);
  message.speed_scale = static_cast<float>(sample.speed_scale);
  const Eigen::Matrix4d covariance = row.covariance();
  const Eigen::Vector3d vehicle = geometry::fixed_axes_angles(sample.rotation);
  message.vehicle_yaw_rad = static_cast<float>(vehicle(0));
  message.vehicle_pitch_rad = static_cast<float>(vehicle(1));
  message.vehicle_roll_rad = static_cast<float>(vehicle(2));
  message.vehicle_covariance = covariance_of_angles(covariance, geometry::fixed_axes_gradient(vehicle(1), vehicle(2)));
  const Eigen::Vector3d own =
      geometry::euler_angles(sample.rotation * geometry::sensor_to_vehicle(nominal, 0.0, 0.0, 0.0));
  message.alignment_yaw_rad = static_cast<float>(geometry::wrap_angle(own(0) - nominal.yaw_rad));
  message.alignment_pitch_rad = static_cast<float>(own(1) - nominal.pitch_rad);
  message.alignment_roll_rad = static_cast<float>(geometry::wrap_angle(own(2) - nominal.roll_rad));
  message.covariance = covariance_of_angles(covariance, geometry::euler_gradient(own(0), own(1)));
  message.step_change.count = sample.step_changes;
  constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();
  message.kpis.residual_rmse_mps = message.kpis.nees = kNotKnown;
  message.kpis.seconds_to_95_percent.fill(kNotKnown);
  message.kpis.drift_per_minute.fill(kNotKnown);
  return message;
}

HealthReport message_of(const score::RunVerdicts& verdicts) {
  HealthReport message{};
  for (const score::RunVerdicts::Radar& radar : verdicts.radars) {
    if (message.number_of_sensors >= kMaxRadars) break;
    SensorHealth& sensor = message.sensors[message.number_of_sensors++];
    sensor.radar_id = radar.radar;
    sensor.data_qualifier = radar.data_qualifier;
    sensor.extended_qualifier = radar.extended_qualifier;
    sensor.missed_scans = radar.missed_scans;
  }
  return message;
}

/// The rows of a file up to the present time. `Read` passes the next row on and returns its time, or kNever_ns.
class Until {
 public:
  explicit Until(std::function<std::int64_t()> read) : read_(std::move(read)) {}
  /// `take` is called for each row whose time has come; the row is the one that `read` read last.
  void advance(std::int64_t time_ns, const std::function<void()>& take) {
    if (!next_ns_) next_ns_ = read_();
    while (*next_ns_ <= time_ns && *next_ns_ != kNever_ns) {
      take();
      next_ns_ = read_();
    }
  }

 private:
  std::function<std::int64_t()> read_;
  std::optional<std::int64_t> next_ns_;
};

/// The three sources in the order of time.
class Playback {
 public:
  Playback(const std::filesystem::path& folder, const VehicleConfig& vehicle)
      : vehicle_(vehicle), accumulator_(vehicle), scans_(folder) {
    if (std::filesystem::exists(folder / "alignment.csv")) estimates_.emplace(folder);
    if (std::filesystem::exists(folder / "health.jsonl")) health_.emplace(folder);
  }

  void play(const std::function<void()>& look, RunSnapshots& out) {
    std::int64_t due_ns = kNever_ns, latest_ns = std::numeric_limits<std::int64_t>::min();
    while (scans_.next(*scan_, *tracks_)) {
      const std::int64_t time_ns = scan_->header.measurement_time_ns;
      if (due_ns == kNever_ns) due_ns = time_ns + kSnapshotPeriod_ns;
      for (; due_ns <= time_ns; due_ns += kSnapshotPeriod_ns) {
        take(due_ns, out);
        if (look) look();
        // A pause of the recording has no snapshots.
        due_ns = std::max(due_ns, time_ns - kSnapshotPeriod_ns);
      }
      latest_ns = std::max(latest_ns, time_ns);
      observe_scan();
    }
    if (due_ns == kNever_ns) return;
    take(latest_ns, out);
  }

 private:
  void observe_scan() {
    RadarScan received{};
    received.header = scan_->header;
    received.number_of_valid_detections = scan_->number_of_valid_detections;
    accumulator_.observe(received, received.header.measurement_time_ns);
    EgoMotion ego{};
    ego.fields = ego_field::kSpeed | ego_field::kYawRate;
    ego.speed_mps = scan_->geometry.ego_speed_mps;
    ego.yaw_rate_radps = scan_->geometry.ego_yaw_rate_radps;
    accumulator_.observe(ego);
    accumulator_.observe(*scan_);
    accumulator_.observe(*tracks_);
  }

  void take(std::int64_t time_ns, RunSnapshots& out) {
    if (estimates_) {
      next_estimate_.advance(time_ns, [this] {
        const RadarConfig* const radar = vehicle_.radar(sample_.radar);
        accumulator_.observe(
            message_of(*estimates_, sample_, radar == nullptr ? MountingPose{} : radar->mounting_pose));
      });
    }
    if (health_) {
      next_verdicts_.advance(time_ns, [this] {
        accumulator_.observe(message_of(verdicts_));
        for (const score::RunVerdicts::Radar& radar : verdicts_.radars) {
          accumulator_.explain(radar.radar, radar.explanation, radar.beyond_tolerance);
        }
      });
    }
    out.snapshots.push_back(accumulator_.snapshot(time_ns));
    out.snapshots.back().services.clear();
  }

  const VehicleConfig& vehicle_;
  monitor::Accumulator accumulator_;
  RecordedScans scans_;
  std::optional<score::RunAlignment> estimates_;
  std::optional<score::RunHealth> health_;
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  judge::AlignmentSample sample_;
  score::RunVerdicts verdicts_;
  Until next_estimate_{[this] {
    std::int64_t time_ns = 0;
    return estimates_->next(sample_, time_ns) ? time_ns : kNever_ns;
  }};
  Until next_verdicts_{[this] { return health_->next(verdicts_) ? verdicts_.time_ns : kNever_ns; }};
};

}  // namespace

RunSnapshots snapshots_of_run(const std::filesystem::path& folder, const VehicleConfig& vehicle,
                              const std::function<void()>& look) {
  RunSnapshots result;
  try {
    Playback(folder, vehicle).play(look, result);
  } catch (const score::InputError& error) {
    result.problem = error.what();
  }
  return result;
}

Check run_check(const RunSnapshots& run) {
  const bool is_whole = run.problem.empty();
  return {is_whole ? "the alignment and the verdicts of health could be read to their end"
                   : "the alignment and the verdicts of health could not be read to their end: " + run.problem,
          is_whole, false};
}

}  // namespace boresight::report
