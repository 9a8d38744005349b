// All segments solved together: the parameters of every radar and of the vehicle, and the size of their fluctuations.
//
// Each radar's parameters are eliminated on their own, so that the cost is linear in the number of radars; what remains
// are the vehicle's parameters and the fluctuations that all radars share. A solution is made in steps of similar cost.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/windows/priors.hpp"
#include "services/alignment_estimator/core/windows/reduced.hpp"
#include "services/alignment_estimator/core/windows/segment.hpp"

namespace boresight::alignment::windows {

/// Values of a radar's own parameters.
struct OwnState {
  double rate_scale = 0.0;
  Eigen::Matrix3d sensor_to_vehicle = Eigen::Matrix3d::Identity();  ///< at Solver::time_s()
  double stamp_s = 0.0;
  Eigen::Vector2d position_error_m{0.0, 0.0};
  Eigen::Matrix<double, kKnots, 1> curve_rad = Eigen::Matrix<double, kKnots, 1>::Zero();
  double height_excess = 0.0;
  double mirror_share = 0.0;
  Eigen::Vector2d drift_radps{0.0, 0.0};  ///< of pitch and yaw
};

struct SharedState {
  double speed_scale = 1.0, yaw_rate_bias_radps = 0.0, yaw_rate_gain = 0.0, slip_radps2pm = 0.0;
  double pitch_per_acceleration_radps2pm = 0.0, stamp_s = 0.0;
  std::array<double, shared::kLoads> load_rad{};  ///< steps
  double first_load_rad = 0.0;                    ///< sum of the steps before those
};
using SharedMatrix = Eigen::Matrix<double, shared::kConstants, shared::kConstants>;

/// What is known of a radar.
struct RadarSolution {
  OwnState state;
  OwnMatrix covariance = OwnMatrix::Zero();
  OwnMatrix conditional = OwnMatrix::Zero();  ///< covariance if all that the radars share were known
  Eigen::Matrix<double, own::kCount, shared::kConstants> with_shared =
      Eigen::Matrix<double, own::kCount, shared::kConstants>::Zero();
  Fluctuation fluctuation;
  std::array<double, kFluctuations> median_std{};  ///< before any data: the prior's, or a larger one of a memory
  std::array<double, 2> drift_variance{};          ///< of the rates of pitch and yaw: learnt
  OwnMatrix prior = OwnMatrix::Zero();             ///< precision
  OwnState prior_state;                            ///< mean
  double pitch_variance_before = 1.0;              ///< of the prior
  bool has_elevation = true;
  Eigen::Vector2d tilt_variance{0.0, 0.0};  ///< of roll and pitch, where they are not measured
};

class Solver {
 public:
  Solver(std::size_t radars, const Priors& priors);

  [[nodiscard]] RadarSolution& radar(std::size_t i) { return radars_[i]; }
  [[nodiscard]] const RadarSolution& radar(std::size_t i) const { return radars_[i]; }
  [[nodiscard]] SharedState& shared() { return shared_; }
  [[nodiscard]] const SharedState& shared() const { return shared_; }
  [[nodiscard]] const SharedMatrix& shared_covariance() const { return shared_covariance_; }
  [[nodiscard]] const Fluctuation& common() const { return common_; }
  [[nodiscard]] double correlation_s(std::size_t k) const { return correlation_s_[k]; }
  [[nodiscard]] double load_variance(int step) const { return load_variance_[static_cast<std::size_t>(step)]; }
  [[nodiscard]] std::size_t size() const { return radars_.size(); }
  /// Time on the clock of the drive that the rotations belong to.
  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] const Priors& priors() const { return priors_; }

  /// Sets the prior of a radar: its nominal mounting, and the distance of its curve's knots.
  void set_prior(std::size_t radar, const Eigen::Matrix3d& nominal, bool has_elevation, double knot_step_rad);
  /// Sets the prior of a radar from an earlier drive: values, and covariance of all but the drift. A parameter that the
  /// settings do not estimate keeps its nominal value. No allocation.
  void restore(std::size_t radar, const OwnState& state, const OwnMatrix& covariance, const Fluctuation& fluctuation);
  /// Likewise of the vehicle's constants.
  void restore(const SharedState& state, const SharedMatrix& covariance, const Fluctuation& common,
               const std::array<double, kFluctuations>& correlation_s);
  /// The rotation of a radar starts again: from its nominal mounting, or from a static calibration.
  void forget_rotation(std::size_t radar, const Eigen::Matrix3d& nominal);
  void seed(std::size_t radar, const Eigen::Matrix3d& sensor_to_vehicle, const Eigen::Matrix3d& covariance);
  /// The model's point for the scans of a radar at a time of the drive, after so many load steps.
  [[nodiscard]] Point point(std::size_t radar, double time_s, int load) const;
  /// Covariance of the local parameters of a radar; of the constants only.
  /// Of the local parameters in a block: with the fluctuations.
  [[nodiscard]] LocalMatrix block_covariance(std::size_t radar) const;
  [[nodiscard]] LocalMatrix local_covariance(std::size_t radar) const;

  /// The fluctuations as learnt so far, for segments that are added to or merged.
  [[nodiscard]] MergeNoise merge_noise() const;
  /// Begins a new solution for this time, then makes it step by step; true: done. The segments must not change
  /// meanwhile. No allocation.
  void begin(double time_s);
  [[nodiscard]] bool step(Segments& segments);
  /// Gives up the solution that is being made.
  void stop() { stage_ = Stage::kIdle; }
  /// The radar has been turned: its rotation starts from here, with the variance of the prior.
  void turn(std::size_t radar, const Eigen::Vector3d& turn_vehicle_rad);
  /// Removes a load step that did not happen; `first`: the oldest, to which all else is referred from now on.
  void remove_load(int step);
  void absorb_first_load();
  [[nodiscard]] double load_rad(int steps) const;
  [[nodiscard]] bool busy() const { return stage_ != Stage::kIdle; }
  void solve(Segments& segments, double time_s) {
    begin(time_s);
    while (!step(segments)) {
    }
  }

 private:
  enum class Stage { kIdle, kPrior, kRadars, kBorder, kLearn, kCommit };
  struct Eliminated {
    OwnMatrix system, inverse;
    OwnVector score, solved;  ///< solved: system⁻¹·score
    Eigen::Matrix<double, own::kCount, kMaxShared> cross;
    OwnVector step;
    OwnMatrix covariance;
    Eigen::Matrix<double, own::kCount, shared::kConstants> with_shared;
  };
  /// Without the radar's own fluctuation, at the present point.
  [[nodiscard]] Reduced reduced(const Share& share, const Segment& segment, std::size_t radar) const;
  void begin_border(const Segments& segments);
  void gather(Segments& segments, std::size_t radar);
  void eliminate(std::size_t radar);
  void solve_border();
  void learn(Segments& segments, std::size_t radar);
  void learn_common(const Segments& segments);
  void commit();
  /// Time from the solution to a segment, over which a mounting drifts.
  [[nodiscard]] double drift_time(double middle_s) const;

  void set_rotation_prior(RadarSolution& radar, const Eigen::Matrix3d& mean, const Eigen::Matrix3d& covariance);

  Priors priors_;
  std::vector<RadarSolution> radars_;
  SharedState shared_, prior_shared_;
  SharedMatrix shared_prior_;  ///< precision
  SharedMatrix shared_covariance_;
  std::array<double, shared::kLoads> load_variance_{};
  Fluctuation common_;
  LocalVector scale_;  ///< of the local parameters: their prior stds
  std::array<double, kFluctuations> correlation_s_;
  std::array<double, kFluctuations> median_common_std_;  ///< before any data: the prior's, or a larger one of a memory
  double time_s_ = 0.0;

  // Work space of the solution that is being made.
  Stage stage_ = Stage::kIdle;
  std::size_t next_ = 0;
  int border_ = 0;  ///< number of shared columns in use
  std::vector<Eliminated> work_;
  Eigen::MatrixXd border_system_, border_inverse_;
  Eigen::VectorXd border_score_, border_step_;
};

}  // namespace boresight::alignment::windows
