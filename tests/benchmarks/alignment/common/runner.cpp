#include "tests/benchmarks/alignment/common/runner.hpp"

#include <cmath>
#include <limits>

#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/common/vehicle/drive_truth.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/car/radar_of_car.hpp"

namespace boresight::bench {

namespace {

constexpr double kFineUntil_s = 12.0;
constexpr double kMinSpeed_mps = 5.0;
constexpr double kStart_s = 1.0;  // of measurement times

RadarError error_of(const alignment::RadarEstimate& estimate, const Eigen::Matrix3d& truth, double speed_scale) {
  RadarError e;
  e.error(kSpeedScale) = estimate.speed_scale - speed_scale;
  e.error.tail<3>() = geometry::so3_log(estimate.sensor_to_vehicle * truth.transpose());
  e.std = estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  e.sensor_error_rad =
      (geometry::euler_angles(estimate.sensor_to_vehicle) - geometry::euler_angles(truth)).unaryExpr([](double a) {
        return geometry::wrap_angle(a);
      });
  e.observable = estimate.observable;
  e.state = estimate.state;
  return e;
}

/// Range rate of a stationary reflector under the signalled motion and the nominal mounting.
double nominal_range_rate(const alignment::ScanDetections& scan, std::size_t i, const RadarConfig& radar,
                          const EgoSample& ego) {
  const Eigen::Vector3d u = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0) *
                            geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]);
  return geometry::stationary_range_rate(
      u, geometry::sensor_velocity(1.0, ego.speed_mps, ego.yaw_rate_radps, radar.mounting_pose.position_m));
}

void mark_what_moves(RadarScan& scan, const std::vector<simulator::AlignmentDetectionTruth>& truth) {
  for (std::size_t i = 0; i < truth.size() && i < scan.number_of_valid_detections; ++i) {
    if (!truth[i].stationary) scan.detection_flags[i] |= detection_flag::kInvalid;
  }
}

template <typename ErrorOf>
TimeTo95 first_and_last(const Run& run, double least, ErrorOf&& error_of_snapshot) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double distance = std::abs(error_of_snapshot(run.snapshots.front()));
  if (distance < least) return {kNone, kNone, kNone};
  TimeTo95 time{kNever, kNever, kNever};
  for (const Snapshot& snapshot : run.snapshots) {
    if (std::abs(error_of_snapshot(snapshot)) > 0.05 * distance) {
      time.stays_s = kNever;
      continue;
    }
    if (std::isinf(time.first_s)) {
      time.first_s = snapshot.driven_s;
      time.first_iterations = static_cast<double>(snapshot.iterations);
    }
    if (std::isinf(time.stays_s)) time.stays_s = snapshot.driven_s;
  }
  return time;
}

}  // namespace

Run run_drive(const simulator::AlignmentSpec& spec, const MakeMethod& make, const RunOptions& options) {
  simulator::AlignmentDrive drive(spec);
  const VehicleConfig vehicle = drive.vehicle();
  const std::unique_ptr<alignment::Method> method = make(vehicle);
  const std::size_t radars = vehicle.radars.size();

  std::vector<double> speed_scales;  // true k_v as seen through each radar
  for (const RadarConfig& radar : vehicle.radars) {
    const auto of_car = simulator::car::radar_of_car(spec.real_car, spec.seed, radar.id, radar.field_of_view);
    speed_scales.push_back(speed_scale_seen(spec.speed_scale, of_car.range_rate_scale));
  }

  Run run;
  const auto take_snapshot = [&](double time_s, double driven_s, std::uint64_t iterations) {
    Snapshot snapshot{time_s, driven_s, iterations, {}};
    for (std::size_t r = 0; r < radars; ++r) {
      snapshot.radars.push_back(
          error_of(method->estimate(r), drive.sensor_to_vehicle(r, kStart_s + time_s), speed_scales[r]));
    }
    run.snapshots.push_back(std::move(snapshot));
    if (options.look) options.look(*method, time_s);
  };
  // Before any data, the estimate of a method is the nominal mounting.
  take_snapshot(0.0, 0.0, 0);

  EgoHistory ego;
  auto scan = std::make_unique<RadarScan>();
  auto detections = std::make_unique<alignment::ScanDetections>();
  std::vector<double> predicted(kMaxDetections);
  std::vector<std::uint32_t> step_changes(radars, 0);
  double previous_s = 0.0, driven_s = 0.0, next_s = 0.0;
  std::uint64_t iterations = 0;
  simulator::AlignmentEvent event;
  while (drive.next(event)) {
    const double now_s = event.time_s - kStart_s;
    if (event.speed_mps >= kMinSpeed_mps) driven_s += now_s - previous_s;
    previous_s = now_s;
    // The estimate before this event, after all earlier scans.
    if (now_s >= next_s && iterations > 0) {
      take_snapshot(now_s, driven_s, iterations);
      next_s +=
          now_s < kFineUntil_s ? std::min(options.fine_period_s, options.snapshot_period_s) : options.snapshot_period_s;
    }
    if (event.ego != nullptr) {
      ego.add(*event.ego);
      continue;
    }
    const RadarConfig& radar = vehicle.radars[event.radar];
    const RadarScan* taken = event.scan;
    if (options.only_stationary) {
      *scan = *event.scan;
      mark_what_moves(*scan, *event.truth);
      taken = scan.get();
    }
    alignment::take_detections(*taken, radar, *detections);
    const EgoSample motion = ego.at(event.scan->header.measurement_time_ns);
    method->process(event.radar, *detections, motion);
    ++run.scans;
    if (event.radar == 0) ++iterations;
    const bool is_counted = options.false_changes || !spec.step_changes.empty();
    const std::uint32_t count = is_counted ? method->estimate(event.radar).step_change.count : 0;
    if (count > step_changes[event.radar]) {
      step_changes[event.radar] = count;
      run.step_changes.push_back({event.radar, now_s});
    }
    if (options.residuals && now_s >= 0.8 * spec.duration_s) {
      *scan = *event.scan;
      mark_what_moves(*scan, *event.truth);
      alignment::take_detections(*scan, radar, *detections);
      method->predict(event.radar, *detections, motion, {predicted.data(), detections->count});
      for (std::size_t i = 0; i < detections->count; ++i) {
        run.corrected.add(detections->range_rate_mps[i] - predicted[i]);
        run.uncorrected.add(detections->range_rate_mps[i] - nominal_range_rate(*detections, i, radar, motion));
      }
    }
  }
  take_snapshot(previous_s, driven_s, iterations);
  return run;
}

TimeTo95 time_to_95(const Run& run, std::size_t radar, int parameter, double least) {
  return first_and_last(run, least, [&](const Snapshot& s) { return s.radars[radar].error(parameter); });
}

TimeTo95 time_to_95_sensor(const Run& run, std::size_t radar, int angle, double least) {
  return first_and_last(run, least, [&](const Snapshot& s) { return s.radars[radar].sensor_error_rad(angle); });
}

}  // namespace boresight::bench
