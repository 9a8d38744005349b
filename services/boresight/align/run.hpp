// Runs an alignment method over a recording: the service's core gets ego motions and scans; its estimates are sampled
// once a second.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/alignment_estimator/core/batch/batch.hpp"
#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"
#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/core/estimator.hpp"
#include "services/boresight/align/residuals.hpp"
#include "services/boresight/align/result.hpp"
#include "services/boresight/align/truth_file.hpp"
#include "services/boresight/align/truth_watch.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::align {

/// Values of --method: the methods of the estimator, batch, and batch_calibration.
[[nodiscard]] std::vector<std::string> method_names();

class Run {
 public:
  struct Options {
    std::string method = "boresight";  ///< one of method_names()
    alignment::Config config;          ///< its method is replaced by `method`
    /// Origin of the estimator's clock on the recording's clock; at most ten seconds after the first input. NaN: the
    /// time of the first input.
    double origin_s = std::numeric_limits<double>::quiet_NaN();
    alignment::batch_calibration::Config batch_calibration{};
    alignment::batch_calibration::Progress batch_calibration_progress{};  ///< called by finish()
    std::optional<Truth> truth;
    std::function<std::int64_t()> cpu_time_ns;  ///< of this thread, for the cost of a scan
  };
  /// Throws std::invalid_argument for an unknown method.
  Run(const VehicleConfig& vehicle, Options options);

  /// In the order of time, ego motions before the scans of the same time; headers are written here.
  void add_ego(EgoMotion& motion, double time_s);
  void add_scan(RadarScan& scan, double time_s);
  /// Of copies of detections: not estimated from, but named as a wrong input.
  void add_rejected_scan(RadarScan& scan, double time_s);
  /// After the last input. True: the method needs the same input again, from its beginning.
  [[nodiscard]] bool needs_another_pass();
  [[nodiscard]] Result finish();

 private:
  struct Radar {
    RadarConfig config;
    Eigen::Matrix3d nominal;
    TruthWatch truth;
    bool measures_elevation = false;
    std::uint64_t scans = 0, scans_without_ego = 0, detections = 0;
    std::int64_t cpu_ns = 0, max_cpu_ns = 0;
    std::uint64_t timed_scans = 0;
    ResidualSample residuals;
    std::uint32_t step_changes_seen = 0;
    std::vector<StepChangeEvent> step_changes;
    Radar(const RadarConfig& of, const Eigen::Matrix3d& nominal_mounting, TruthWatch watch)
        : config(of), nominal(nominal_mounting), truth(std::move(watch)) {}
  };
  [[nodiscard]] std::int64_t to_ns(double time_s);
  [[nodiscard]] double to_s(std::int64_t time_ns) const;
  void observe_until(double time_s);
  [[nodiscard]] Sample sample(double time_s);
  /// After a scan.
  static void observe_step_changes(Radar& radar, const alignment::RadarEstimate& estimate, double origin_s);
  void observe_vehicle_changes(const alignment::RadarEstimate& estimate);
  void finish_estimator(Result& result);
  void finish_batch(Result& result);
  /// Reason, finding and drift in words.
  void describe(Result& result) const;

  VehicleConfig vehicle_;
  Options options_;
  std::unique_ptr<alignment::Estimator> estimator_;  ///< null for batch_calibration, which needs all input at once
  std::unique_ptr<alignment::batch::Batch> batch_;   ///< null for all other methods
  int passes_ = 0;                                   ///< that are complete
  std::vector<VehicleChangeEvent> load_changes_, speed_changes_;
  EgoHistory ego_;
  std::vector<Radar> radars_;
  std::unique_ptr<alignment::ScanDetections> detections_;
  std::uint64_t ego_motions_ = 0;
  double ego_start_s_, ego_end_s_, start_s_, end_s_;
  double next_sample_s_ = 0.0;
  std::vector<Sample> series_;
};

}  // namespace boresight::align
