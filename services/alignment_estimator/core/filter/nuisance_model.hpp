// How large the errors of the motion are and how long they last, learnt from what they turn out to be.
#pragma once

#include <array>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/filter/joint_state.hpp"

namespace boresight::alignment {

/// Ornstein–Uhlenbeck processes of δV, δω, body pitch and side slip, as states of the joint filter: scans of one
/// instant share them, scans of later instants as far as their correlation reaches. Variance and correlation time
/// follow the score of the innovations' likelihood, so that errors that last count once and not once a scan, and
/// errors that do not occur cost nothing.
class NuisanceModel {
 public:
  explicit NuisanceModel(const FilterConfig& config);

  /// What the ego signals state of themselves; takes effect until there is experience.
  void state_stds(double speed_std_mps, double yaw_rate_std_radps);
  /// From one instant to another: learns from the first one and takes the state to the next.
  void step(JointState& state, double elapsed_s);
  /// Stationary variances into the state, uncorrelated.
  void reset(JointState& state);

  [[nodiscard]] double variance(std::size_t i) const { return processes_[i].variance; }
  /// 1 if the body is known to pitch, 0 if what is estimated of it may as well be noise, and between.
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
    // Sliding sums of a test whether there is such an error at all.
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
