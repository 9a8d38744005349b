// All segments solved together: the parameters of every radar and of the vehicle, and the size of their fluctuations.
//
// Each radar's parameters are eliminated on their own, so that the cost is linear in the number of radars; what remains
// are the vehicle's parameters and the fluctuations that all radars share.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/windows/segment.hpp"

namespace boresight::alignment::windows {

/// Priors: standard deviations before any data.
struct Priors {
  double speed_scale_std = 0.03;
  double rate_scale_std = 0.003;
  double rotation_std_rad = 0.0698;
  double yaw_rate_bias_std_radps = 0.00175;
  double yaw_rate_gain_std = 0.03;
  double slip_std_radps2pm = 0.006;
  double pitch_per_acceleration_std_radps2pm = 0.006;
  double common_stamp_std_s = 0.05;
  double stamp_std_s = 0.02;
  double position_std_m = 0.03;
  double curve_std_rad = 0.00262;
  double curve_length_rad = 0.262;
  double mirror_share_std = 1.0;
  double load_std_rad = 0.0105;
  double step_std_rad = 0.0698;
  // Fluctuations: medians of their standard deviations, and the standard deviation of the logarithm.
  std::array<double, kFluctuations> own_std{5e-4, 9e-4, 5e-4};
  std::array<double, kFluctuations> common_std{1.4e-3, 1.7e-3, 3e-4};
  double log_fluctuation_std = 1.0;
  double common_correlation_s = 20.0;
};

/// Values of a radar's own parameters.
struct OwnState {
  double rate_scale = 0.0;
  Eigen::Matrix3d sensor_to_vehicle = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d earlier = Eigen::Matrix3d::Identity();
  double stamp_s = 0.0;
  Eigen::Vector2d position_error_m{0.0, 0.0};
  Eigen::Matrix<double, kKnots, 1> curve_rad = Eigen::Matrix<double, kKnots, 1>::Zero();
  double mirror_share = 0.0;
};

struct SharedState {
  double speed_scale = 1.0, yaw_rate_bias_radps = 0.0, yaw_rate_gain = 0.0, slip_radps2pm = 0.0;
  double pitch_per_acceleration_radps2pm = 0.0, stamp_s = 0.0;
  std::array<double, shared::kLoads> load_rad{};  ///< steps
};

/// What is known of a radar, as the drive goes on.
struct RadarSolution {
  OwnState state;
  OwnMatrix covariance = OwnMatrix::Zero();
  Eigen::Matrix<double, own::kCount, shared::kConstants> with_shared =
      Eigen::Matrix<double, own::kCount, shared::kConstants>::Zero();
  Fluctuation fluctuation;
  OwnMatrix prior = OwnMatrix::Zero();  ///< precision
  OwnState prior_state;                 ///< mean
  bool has_elevation = true;
  bool started = false;
};

class Solver {
 public:
  Solver(std::size_t radars, const Priors& priors);

  [[nodiscard]] RadarSolution& radar(std::size_t i) { return radars_[i]; }
  [[nodiscard]] const RadarSolution& radar(std::size_t i) const { return radars_[i]; }
  [[nodiscard]] SharedState& shared() { return shared_; }
  [[nodiscard]] const SharedState& shared() const { return shared_; }
  [[nodiscard]] const Eigen::Matrix<double, shared::kConstants, shared::kConstants>& shared_covariance() const {
    return shared_covariance_;
  }
  [[nodiscard]] const Fluctuation& common() const { return common_; }
  [[nodiscard]] double load_variance(int step) const { return load_variance_[static_cast<std::size_t>(step)]; }
  [[nodiscard]] std::size_t size() const { return radars_.size(); }

  /// Sets the prior of a radar: nominal mounting, and its curve's covariance over the knots. Only once.
  void set_prior(std::size_t radar, const Eigen::Matrix3d& nominal, bool has_elevation);
  void set_curve_prior(std::size_t radar, double knot_step_rad);
  /// The model's point for the scans of a radar now. `load`: number of load steps so far.
  [[nodiscard]] Point point(std::size_t radar, int load, bool earlier = false) const;
  /// Covariance of the local parameters of a radar now; of the constants only.
  [[nodiscard]] LocalMatrix local_covariance(std::size_t radar) const;

  /// Begins a segment; older ones that are merged lose the deviations from their common mean.
  void begin_segment(Segments& segments, int load) const;
  /// Solves once, and learns the fluctuations. No allocation.
  void solve(Segments& segments);

 private:
  void gather(const Segments& segments, std::size_t radar);
  void eliminate(std::size_t radar);
  void apply(std::size_t radar);
  void learn(Segments& segments);
  [[nodiscard]] double common_share(const Segment& segment) const;

  Priors priors_;
  std::vector<RadarSolution> radars_;
  SharedState shared_;
  Eigen::Matrix<double, shared::kConstants, shared::kConstants> shared_covariance_;
  std::array<double, shared::kLoads> load_variance_{};
  Fluctuation common_;

  // Work space.
  int border_ = 0;  ///< number of shared columns in use
  struct Eliminated {
    OwnMatrix system;
    OwnVector score;
    Eigen::Matrix<double, own::kCount, kMaxShared> cross;   ///< then system⁻¹·cross
    OwnVector solved;                                        ///< system⁻¹·score
    OwnMatrix inverse;
  };
  std::vector<Eliminated> work_;
  Eigen::MatrixXd border_system_, border_inverse_;
  Eigen::VectorXd border_score_, border_step_;
};

}  // namespace boresight::alignment::windows
