// Batch estimator of a recorded drive: the model of the windowed filter, solved over all windows at once, with the
// scans read again until the point of linearisation no longer moves (README.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/alignment_estimator/core/batch/config.hpp"
#include "services/alignment_estimator/core/batch/driving_clock.hpp"
#include "services/alignment_estimator/core/filter/ego_trend.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/windows/radar_sums.hpp"
#include "services/alignment_estimator/core/windows/solver.hpp"

namespace boresight::alignment::batch {

struct Result {
  std::string problem;  ///< why there is no result; "" if there is one
  std::vector<RadarEstimate> radars;
  /// Before the first sudden misalignment of a radar; nothing if there was none, or too little driving before it.
  std::vector<std::optional<RadarEstimate>> before;
  double driven_s = 0.0;
  int windows = 0, passes = 0;
  bool settled = false;  ///< the last pass moved the solution by less than BatchConfig::moved_stds
};

/// Memory is bounded: no scan is kept.
class Batch {
 public:
  Batch(const VehicleConfig& vehicle, const FilterConfig& filter, const windows::WindowsConfig& windows = {},
        const BatchConfig& config = {});

  /// First pass: a scan that the recursive estimator has processed, and its estimate of the radar since then.
  void observe(std::size_t radar, const ScanDetections& scan, const EgoSample& ego, const RadarEstimate& estimate);
  /// Further passes over the same scans, in the same order.
  void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego);
  /// Ends a pass. True: another is needed.
  [[nodiscard]] bool end_pass();
  /// After the last pass. Takes a second: solves once for each window that is not included.
  [[nodiscard]] Result result();

 private:
  struct Change {
    std::size_t block = 0;  ///< at which it was reported
    Eigen::Vector3d turn_vehicle_rad{0.0, 0.0, 0.0};
  };
  /// Of the latest pass.
  struct Totals {
    std::uint64_t scans = 0;
    double detections = 0.0, stationary = 0.0, inliers = 0.0, seconds = 0.0;
  };
  struct Radar {
    RadarConfig config;
    windows::RadarSums sums;
    Totals totals;
    RadarEstimate start;  ///< of the recursive estimator, at the end
    bool has_elevation = false;
    std::vector<Change> changes;  ///< sudden misalignments
    /// Number of changes before a block; nothing where the block is from both sides of one.
    [[nodiscard]] std::optional<std::size_t> phase_of(std::size_t block, std::size_t delay_blocks) const;
    /// Rotation of the mounting before the first change from the present one, as solved.
    std::optional<Eigen::Matrix3d> first_from_last{};
    /// Rotation about the vehicle's axes from the last mounting to that of a phase.
    [[nodiscard]] Eigen::Matrix3d turned_back(std::size_t phase) const;
  };
  /// Which side of a radar's sudden misalignments its rotation is of.
  enum class Side { kBefore, kAfter };
  [[nodiscard]] bool usable(const ScanDetections& scan, const EgoSample& ego) const;
  void plan();
  void begin_pass();
  void open_block(std::size_t block);
  void close_block();
  [[nodiscard]] std::size_t delay_blocks() const {
    return static_cast<std::size_t>(config_.step_change_delay_s / config_.block_s);
  }
  void add_block(std::size_t radar, std::size_t block, const windows::MergeNoise& noise);
  void find_loads();
  [[nodiscard]] std::size_t window_of(std::size_t block) const { return block * windows_ / blocks_; }
  [[nodiscard]] std::size_t first_block(std::size_t window) const {
    return (window * blocks_ + windows_ - 1) / windows_;
  }
  [[nodiscard]] double middle_s(std::size_t window) const;
  [[nodiscard]] static int loads_before(const std::vector<std::size_t>& loads, std::size_t window);
  /// The windows as the solver takes them: with load steps, and without what is from the other side of a change.
  [[nodiscard]] windows::Segments assembled(Side side, const std::vector<std::size_t>& loads) const;
  /// Solves until nothing moves; the number of solutions.
  int solve(windows::Solver& solver, windows::Segments& segments, double time_s, int most) const;
  [[nodiscard]] std::vector<RadarEstimate> estimates(const windows::Solver& solver, double time_s, int loads) const;
  void widen_by_jackknife(std::vector<RadarEstimate>& of) const;
  /// Solution with the radar's mounting before its first change, at the time of that change; nothing if there was none,
  /// or too little driving before it.
  [[nodiscard]] std::optional<windows::Solver> solved_before(std::size_t radar) const;
  [[nodiscard]] double first_change_s(std::size_t radar) const;
  void write_before(Result& result) const;
  void finish(RadarEstimate& estimate, const Radar& radar) const;

  FilterConfig filter_;
  windows::Priors priors_;
  BatchConfig config_;
  std::vector<Radar> radars_;
  DrivingClock clock_;
  EgoTrend trend_;
  Sightings sightings_;
  windows::Solver solver_;
  windows::Segments segments_;                             ///< as summed, of the latest pass
  windows::Segments solved_;                               ///< as the solution took them
  std::vector<std::size_t> window_;                        ///< of each segment
  std::vector<std::vector<std::size_t>> phase_;            ///< by segment and radar: number of its changes before
  std::vector<std::size_t> load_reports_, speed_reports_;  ///< blocks
  std::vector<std::size_t> loads_;                         ///< windows in which the load changes
  std::size_t blocks_ = 0, windows_ = 0;
  std::size_t block_ = 0;
  bool has_block_ = false, loads_found_ = false, settled_ = false;
  bool drives_ = false, sees_ = false;  ///< some scan had motion, and detections
  int pass_ = 0;
  std::string problem_;
};

}  // namespace boresight::alignment::batch
