// Size and duration of the errors of the motion, learnt from their estimates.
// Equations: docs/algorithms/alignment.md (A18)(A19).
#pragma once

#include <array>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/filter/joint_state.hpp"

namespace boresight::alignment {

/// Ornstein–Uhlenbeck processes of δV, δω, body pitch and side slip, as states of the joint filter. Scans of one
/// instant share them; scans of later instants share them within the correlation time. Variance and correlation time
/// follow the score of the innovations' likelihood. A lasting error then counts once and not once per scan, and an
/// absent error does not widen σ.
class NuisanceModel {
 public:
  explicit NuisanceModel(const FilterConfig& config);

  /// Stds that the ego signals state; used until the learnt ones replace them.
  void state_stds(double speed_std_mps, double yaw_rate_std_radps);
  /// Steps from one instant to the next: learns from the first and predicts the state to the next.
  void step(JointState& state, double elapsed_s);
  /// Writes the stationary variances into the state, uncorrelated.
  void reset(JointState& state);

  [[nodiscard]] double variance(std::size_t i) const { return processes_[i].variance; }
  /// 1 if body pitch is significant, 0 if its estimate may be noise, with values between.
  [[nodiscard]] double pitch_share() const;
  [[nodiscard]] double correlation_s(std::size_t i) const { return processes_[i].correlation_s; }

 private:
  struct Process {
    double variance;
    double correlation_s;
    double min_correlation_s, max_correlation_s;
    double min_variance;
    double max_variance;
    // Since the last step of the state.
    double predicted_mean = 0.0, predicted_variance = 0.0, previous_mean = 0.0, keep = 0.0;
    bool armed = false;
    // Sliding sums of the test for the presence of this error.
    double presence = 0.0, presence_variance = 0.0;
    // Sliding sums: score and information of ln variance and of the correlation.
    double score = 0.0, fisher = 0.0, product = 0.0, square = 0.0;
  };
  void learn(Process& process, double mean, double variance, double elapsed_s);

  FilterConfig config_;
  std::array<Process, 4> processes_;
  double experience_s_ = 0.0;
  double last_elapsed_s_ = 0.0;
};

}  // namespace boresight::alignment
