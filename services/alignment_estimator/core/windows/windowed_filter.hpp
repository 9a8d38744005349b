// Boresight's own alignment estimator: what each radar saw in some seconds is kept as information about the parameters
// of its model, and all of it is solved again whenever a new part is complete (docs/algorithms/alignment.md).
#pragma once

#include <cstdint>
#include <vector>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/filter/ego_trend.hpp"
#include "services/alignment_estimator/core/filter/graduated_start.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/windows/change_monitor.hpp"
#include "services/alignment_estimator/core/windows/common_watch.hpp"
#include "services/alignment_estimator/core/windows/config.hpp"
#include "services/alignment_estimator/core/windows/radar_sums.hpp"
#include "services/alignment_estimator/core/windows/solver.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// Large: never on the stack.
class WindowedFilter : public Method {
 public:
  WindowedFilter(const VehicleConfig& vehicle, const FilterConfig& config, const windows::WindowsConfig& settings = {});

  void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) override;
  [[nodiscard]] RadarEstimate estimate(std::size_t radar) const override;
  void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego,
               std::span<double> out) const override;
  void save(Memory& memory) const override;
  void restore(const Memory& memory, double away_s) override;
  bool seed(std::size_t radar, const Eigen::Vector3d& rotation_vehicle_rad, const Eigen::Matrix3d& covariance) override;

  [[nodiscard]] const windows::Solver& solver() const { return solver_; }
  [[nodiscard]] int load_changes() const { return static_cast<int>(load_change_.count); }
  [[nodiscard]] double load_rad() const { return solver_.load_rad(load_); }

 private:
  /// Driving time of a block, of a segment, and between two solutions; at the start every block gives one.
  static constexpr double kBlock_s = 1.0, kSegment_s = 2.0, kSolve_s = 2.0, kStart_s = 5.0;
  struct Radar {
    RadarConfig config;
    Eigen::Matrix3d nominal;
    GraduatedStart start;
    windows::RadarSums sums;
    /// As it was before the blocks that may be from a turned radar: its residuals are no noise.
    windows::RadarSums::Learnt learnt_before;
    /// Where the derivatives are taken. It follows the estimate about known axes only: along a direction that the data
    /// do not determine, derivatives at several points would pose as information (first-estimates Jacobian).
    Eigen::Matrix3d linearised;
    double linearised_speed_scale = 1.0;
    bool running = false;
    bool remembered = false;    ///< begins from a memory or a static calibration
    bool contradicted = false;  ///< its first scans showed another rotation than the memory
    AlignmentState state = AlignmentState::kNoData;
    AlignmentReason reason = AlignmentReason::kTooFewDetections;
    std::int64_t last_time_ns = 0;
    double seconds_of_drive = 0.0;
    double inlier_ratio = -1.0;
    std::uint64_t scans_used = 0, detections_used = 0;
    AlignmentStepChange step_change{};
    std::int64_t drift_since_ns = 0;  ///< 0: none
    int drifting_solutions = 0;       ///< in a row
    /// Rotation and scale that the vehicle's pitch and scale are counted from: of the first block that is compared.
    Eigen::Matrix3d reference = Eigen::Matrix3d::Identity();
    double reference_scale = 0.0;  ///< 0: not set
    Radar(const RadarConfig& radar, const FilterConfig& filter, const windows::WindowsConfig& settings);
  };
  [[nodiscard]] bool usable(const EgoSample& ego) const;
  /// Begins again with the prior of a radar with or without elevations; a remembered yaw stays.
  void set_has_elevation(std::size_t radar, bool has_elevation);
  /// Whether the first scans show another yaw or pitch than the memory: the car may have been repaired.
  [[nodiscard]] bool contradicts_memory(std::size_t radar, const StartResult& found, const ScanMotion3d& motion) const;
  /// Widens what was restored of a radar by its fluctuations.
  void allow_fluctuations(std::size_t radar);
  /// Writes the present state, with covariances that need no correlations.
  void save_present(Memory& memory) const;
  /// Whether what the process began with is still true of this radar, and tells more than its present state.
  [[nodiscard]] bool keeps_restored(std::size_t radar, const Memory::Radar& present) const;
  [[nodiscard]] bool keeps_restored_vehicle(const Memory& present) const;
  void search(std::size_t radar, const ScanMotion3d& motion, double elapsed_s);
  void update(std::size_t radar, const ScanMotion3d& motion, const EgoSample& ego, double elapsed_s);
  /// Makes the next step of the solution.
  void step();
  void wait(Radar& radar, AlignmentReason reason);
  [[nodiscard]] AlignmentReason reason_of(std::size_t radar) const;
  void judge_drift(std::size_t radar);
  void close_block();
  /// Moves `linearised` to the latest solution about known axes. Returns the point of the derivatives.
  [[nodiscard]] windows::Point move_derivatives(std::size_t radar);
  void begin_block(std::size_t radar);
  void judge_block();
  void judge_vehicle();
  void take_change(std::size_t radar);
  void take_load(const windows::CommonStep& step, std::int64_t time_ns);
  void take_speed(const windows::CommonStep& step, std::int64_t time_ns);
  void decide_load();
  /// Yaw is known well enough to judge a change of all radars; settled: also of this radar.
  [[nodiscard]] bool knows_yaw(std::size_t radar) const;
  [[nodiscard]] bool settled(std::size_t radar) const;

  FilterConfig config_;
  windows::Priors priors_;
  windows::SumsConfig sums_config_;
  std::vector<Radar> radars_;
  windows::Solver solver_;
  windows::Segments segments_;
  windows::ChangeConfig change_config_;
  windows::RestoreConfig restore_config_;
  Memory restored_;  ///< as it began, with its doubts; no radars: none
  windows::ChangeMonitor changes_;
  windows::CommonWatch load_watch_, speed_watch_;
  std::vector<windows::Deviation2> deviations_;
  std::vector<windows::ScaleDeviation> scales_;
  std::vector<windows::ChangeVerdict> verdicts_;
  std::vector<double> work_, work_stds_;
  int load_ = 0;                ///< load steps so far, with one that is being judged
  double load_since_s_ = -1.0;  ///< driving time at which one began that may not have happened: after a restart
  AlignmentVehicleChange load_change_{}, speed_change_{};
  EgoTrend trend_;
  Sightings sightings_;
  std::int64_t block_start_ns_ = 0;
  bool has_block_ = false;
  double driven_s_ = 0.0, solved_s_ = 0.0;
};

}  // namespace boresight::alignment
