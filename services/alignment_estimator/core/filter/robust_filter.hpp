// Boresight's own alignment estimator: a robust recursive information filter over all radars of the vehicle
// (docs/algorithms/alignment.md).
#pragma once

#include <cstdint>
#include <vector>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/filter/efficiency.hpp"
#include "services/alignment_estimator/core/filter/ego_trend.hpp"
#include "services/alignment_estimator/core/filter/graduated_start.hpp"
#include "services/alignment_estimator/core/filter/joint_state.hpp"
#include "services/alignment_estimator/core/filter/noise_scale.hpp"
#include "services/alignment_estimator/core/filter/nuisance_model.hpp"
#include "services/alignment_estimator/core/filter/small_step_change_detector.hpp"
#include "services/alignment_estimator/core/filter/spread.hpp"
#include "services/alignment_estimator/core/filter/step_change_detector.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// Large: never on the stack.
class RobustFilter : public Method {
 public:
  RobustFilter(const VehicleConfig& vehicle, const FilterConfig& config);

  void process(std::size_t radar, const ScanDetections& scan, const EgoSample& ego) override;
  [[nodiscard]] RadarEstimate estimate(std::size_t radar) const override;
  void predict(std::size_t radar, const ScanDetections& scan, const EgoSample& ego,
               std::span<double> out) const override;
  void save(Memory& memory) const override;
  void restore(const Memory& memory) override;
  bool seed(std::size_t radar, const Eigen::Vector3d& rotation_vehicle_rad, const Eigen::Matrix3d& covariance) override;

  /// For tests and benchmarks.
  [[nodiscard]] const JointState& state() const { return state_; }
  [[nodiscard]] const NuisanceModel& nuisance_model() const { return nuisance_model_; }
  [[nodiscard]] const StepChangeDetector& step_change_detector() const { return step_changes_; }
  [[nodiscard]] const SmallStepChangeDetector& small_step_change_detector() const { return small_step_changes_; }

 private:
  /// χ² of three degrees of freedom, exceeded once in 10⁴: beyond it two rotations differ.
  static constexpr double kDifferentRotation = 21.1;
  static constexpr double kEarlier_s = 5.0;  ///< interval between the rotations of Radar::earlier
  enum class Phase : std::uint8_t {
    kStarting,   ///< searching; the estimate is the prior or the restored memory
    kRunning,    //
    kSuspected,  ///< the estimate is frozen while a new start runs beside it
  };
  struct Radar {
    RadarConfig config;
    Eigen::Matrix3d nominal;
    UnknownElevation unknown;
    Phase phase = Phase::kStarting;
    bool remembered = false;  ///< the state holds a restored memory
    AlignmentState state = AlignmentState::kNoData;
    GraduatedStart start;
    Spread spread;
    NoiseScale noise;
    std::int64_t last_time_ns = 0;
    double seconds_of_drive = 0.0;
    double since_start_s = 0.0;
    Efficiency efficiency;
    double mean_sine = 0.0;      ///< sliding, of unmeasured elevations; 0 if they are measured
    double inlier_ratio = -1.0;  ///< sliding
    std::uint64_t scans_used = 0, detections_used = 0;
    std::int64_t suspected_ns = 0;
    bool drifted = false;
    AlignmentStepChange step_change{};
    Eigen::Matrix3d before_step_change = Eigen::Matrix3d::Identity();
    /// The rotation a few seconds ago: it undoes the effect of a step change on the estimate before its detection.
    struct Earlier {
      Eigen::Matrix3d sensor_to_vehicle;
      Eigen::Vector3d variance;
    };
    std::array<Earlier, 3> earlier;
    double since_earlier_s = 0.0;
    double since_change_s = 0.0;  ///< the earlier rotations are valid once this exceeds their age
    /// Variances of the rotation at the last change of the point of linearisation.
    Eigen::Vector3d linearised_variance = Eigen::Vector3d::Zero();
    Radar(const RadarConfig& radar, const FilterConfig& filter);
  };
  [[nodiscard]] bool usable(const EgoSample& ego) const;
  void advance(std::int64_t time_ns);
  [[nodiscard]] StartPrior start_prior(std::size_t radar) const;
  void search(std::size_t radar, const ScanMotion3d& motion, double elapsed_s);
  void adopt(std::size_t radar, const StartResult& found);
  void verify(std::size_t radar, const StartResult& found, std::int64_t time_ns);
  void place_speed_scale(std::size_t radar, const StartResult& found);
  void place(std::size_t radar, const StartResult& found);
  void reopen(std::size_t radar);
  void measure_step_change(std::size_t radar);
  [[nodiscard]] Radar::Earlier now(std::size_t radar) const;
  void update(std::size_t radar, const ScanMotion3d& motion, double elapsed_s, std::int64_t time_ns);
  void learn_noise(std::size_t radar, const ScanSums& sums, double elapsed_s);
  void linearise(std::size_t radar);
  void note_linearised(std::size_t radar);
  void watch(std::uint32_t suspicious, std::int64_t time_ns);
  [[nodiscard]] double second_order_yaw_variance(std::size_t radar) const;
  void forget_deviations(std::size_t radar);
  [[nodiscard]] bool drifts(std::size_t radar) const;
  void follow(std::uint32_t changed, std::int64_t time_ns);
  [[nodiscard]] bool any_running_but(std::size_t radar) const;

  FilterConfig config_;
  std::vector<Radar> radars_;
  JointState state_;
  NuisanceModel nuisance_model_;
  StepChangeDetector step_changes_;
  SmallStepChangeDetector small_step_changes_;
  EgoTrend trend_;
  Sightings sightings_;
  std::int64_t instant_ns_ = 0;
  bool has_instant_ = false;
};

}  // namespace boresight::alignment
