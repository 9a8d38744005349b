#include "services/boresight/track/tracker_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace boresight::track {

void fill_scan(const std::vector<MeasuredPoint>& points, std::size_t step, double step_s, ClassifiedScan& scan) {
  constexpr double kSecond_ns = 1e9;
  scan.header = {};
  scan.header.version = ClassifiedScan::kVersion;
  scan.header.source_id = 1;
  scan.header.sequence = scan.header.source_sequence = step;
  scan.header.measurement_time_ns = std::llround(static_cast<double>(step) * step_s * kSecond_ns);
  scan.header.time_source = TimeSource::kSensorSynchronised;
  scan.fields = scan.flags = 0;
  scan.number_of_reflector_segments = 0;
  scan.geometry = {};
  scan.geometry.sensor_to_vehicle = {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  scan.geometry.speed_scale = 1.0F;
  scan.number_of_valid_detections = static_cast<std::uint32_t>(std::min(points.size(), kMaxDetections));
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    const MeasuredPoint& point = points[i];
    scan.x_vehicle_m[i] = static_cast<float>(point.position_m.x());
    scan.y_vehicle_m[i] = static_cast<float>(point.position_m.y());
    scan.z_vehicle_m[i] = 0.0F;
    scan.range_m[i] = static_cast<float>(point.position_m.norm());
    scan.azimuth_vehicle_rad[i] = static_cast<float>(std::atan2(point.position_m.y(), point.position_m.x()));
    const bool has_range_rate = std::isfinite(point.range_rate_mps);
    scan.range_rate_over_ground_mps[i] = has_range_rate ? static_cast<float>(point.range_rate_mps) : 0.0F;
    scan.rcs_dbsm[i] = scan.snr_db[i] = 0.0F;
    scan.range_std_m[i] = scan.azimuth_std_rad[i] = scan.range_rate_std_mps[i] = 0.0F;
    scan.detection_flags[i] = corrected_flag::kMoving;
    scan.set_certain(i, Provenance::kMoving);
    scan.moving_log_likelihood_ratio[i] = 0.0F;  // no evidence for or against: the table says nothing of origins
  }
}

double TrackerRun::mean_cpu_ms() const {
  if (cpu_ms.empty()) return 0.0;
  return std::accumulate(cpu_ms.begin(), cpu_ms.end(), 0.0) / static_cast<double>(cpu_ms.size());
}

double TrackerRun::worst_cpu_ms() const {
  return cpu_ms.empty() ? 0.0 : *std::max_element(cpu_ms.begin(), cpu_ms.end());
}

TrackerRun run_tracker(const MakeTracker& make, const std::vector<std::vector<MeasuredPoint>>& scans, double step_s,
                       std::size_t passes, std::int64_t (*cpu_time_ns)(), const std::function<void()>& between_scans) {
  constexpr double kMillisecond_ns = 1e6;
  TrackerRun run;
  run.cpu_ms.assign(scans.size(), std::numeric_limits<double>::infinity());
  const auto scan = std::make_unique<ClassifiedScan>();
  const auto tracks = std::make_unique<TrackList>();
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const std::unique_ptr<tracking::MultiObjectTracker> tracker = make();
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (between_scans) between_scans();
      fill_scan(scans[i], i + 1, step_s, *scan);
      const std::int64_t begin_ns = cpu_time_ns();
      const tracking::StepResult result = tracker->step(*scan);
      run.cpu_ms[i] = std::min(run.cpu_ms[i], static_cast<double>(cpu_time_ns() - begin_ns) / kMillisecond_ns);
      tracker->write(*tracks);
      std::vector<ExtendedObject> estimates = estimates_of(*tracks);
      if (pass > 0) {
        run.is_repeatable = run.is_repeatable && estimates == run.estimates[i];
        continue;
      }
      run.estimates.push_back(std::move(estimates));
      run.budget_reached += result.budget_reached ? 1 : 0;
      run.gates_cut += result.cut_gates > 0 ? 1 : 0;
      run.dropped_detections += result.dropped_detections;
      run.dropped_objects += result.dropped_objects;
      run.likelihood_evaluations += result.likelihood_evaluations;
    }
  }
  return run;
}

}  // namespace boresight::track
