#include "services/alignment_estimator/core/filter/nuisance_model.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/small_maths.hpp"

namespace boresight::alignment {

namespace {

/// Instants further apart are treated as independent.
constexpr double kMaxStep_s = 0.3;
/// Weight of the start values, in instants (units of Fisher information of ln σ²).
constexpr double kPriorInformation = 10.0;
constexpr double kCorrelationInformation = 60.0;
constexpr double kRecent_s = 10.0;
/// Stds that the test for the presence of an error must exceed.
constexpr double kSignificant = 2.0;
constexpr double kMinCorrelation_s = 0.005, kMaxCorrelation_s = 1.5;
/// A body on its springs oscillates at 1 to 2 Hz, and its dampers stop this within one oscillation. A longer deviation
/// is not body motion but a mounting error.
constexpr double kMinBodyCorrelation_s = 0.2, kMaxBodyCorrelation_s = 0.6;

}  // namespace

NuisanceModel::NuisanceModel(const FilterConfig& config) : config_(config) {
  const auto process = [](double std, double correlation_s, double min_correlation_s, double max_correlation_s,
                          double min_std, double max_std) {
    Process p{};
    p.variance = std * std;
    p.correlation_s = correlation_s;
    p.min_correlation_s = min_correlation_s;
    p.max_correlation_s = max_correlation_s;
    p.min_variance = min_std * min_std;
    p.max_variance = max_std * max_std;
    return p;
  };
  processes_[0] =
      process(config.speed_std_mps, config.ego_correlation_s, kMinCorrelation_s, kMaxCorrelation_s, 1e-3, 1.0);
  processes_[1] =
      process(config.yaw_rate_std_radps, config.ego_correlation_s, kMinCorrelation_s, kMaxCorrelation_s, 5e-5, 0.1);
  processes_[2] = process(config.body_pitch_std_rad, config.body_correlation_s, kMinBodyCorrelation_s,
                          kMaxBodyCorrelation_s, 1e-4, 0.05);
  processes_[3] = process(config.side_slip_std_rad, config.body_correlation_s, kMinBodyCorrelation_s,
                          kMaxBodyCorrelation_s, 1e-5, 0.02);
}

void NuisanceModel::state_stds(double speed_std_mps, double yaw_rate_std_radps) {
  if (experience_s_ > 0.0) return;
  if (speed_std_mps > 0.0) processes_[0].variance = square(std::clamp(speed_std_mps, 5e-3, 0.5));
  if (yaw_rate_std_radps > 0.0) processes_[1].variance = square(std::clamp(yaw_rate_std_radps, 2e-4, 0.05));
}

void NuisanceModel::reset(JointState& state) {
  for (std::size_t i = 0; i < processes_.size(); ++i) {
    state.set_variance(column::kNuisances + static_cast<Eigen::Index>(i), processes_[i].variance);
    processes_[i].armed = false;
  }
  state.nuisances.setZero();
}

double NuisanceModel::pitch_share() const {
  const Process& pitch = processes_[2];
  if (!(pitch.presence_variance > 0.0)) return 0.0;
  const double stds = pitch.presence / std::sqrt(pitch.presence_variance);
  return std::clamp(stds / kSignificant - 1.0, 0.0, 1.0);
}

void NuisanceModel::step(JointState& state, double elapsed_s) {
  const double elapsed = std::abs(elapsed_s);
  for (std::size_t i = 0; i < processes_.size(); ++i) {
    Process& p = processes_[i];
    const Eigen::Index index = column::kNuisances + static_cast<Eigen::Index>(i);
    const double mean = state.nuisances(static_cast<Eigen::Index>(i));
    if (p.armed && elapsed < kMaxStep_s) learn(p, mean, state.covariance(index, index), elapsed);
    // The process is symmetric in time: a late scan is no special case.
    p.keep = std::exp(-elapsed / p.correlation_s);
    state.decay(index, p.keep, (1.0 - p.keep * p.keep) * p.variance);
    p.previous_mean = mean;
    p.predicted_mean = state.nuisances(static_cast<Eigen::Index>(i)) = p.keep * mean;
    p.predicted_variance = state.covariance(index, index);
    p.armed = true;
  }
  experience_s_ += std::min(elapsed, kMaxStep_s);
  last_elapsed_s_ = elapsed;
}

void NuisanceModel::learn(Process& p, double mean, double variance, double elapsed_s) {
  // Gain of this instant's data. The measurement of the error without the prediction is the innovation over the gain.
  const double gain = 1.0 - variance / p.predicted_variance;
  if (!(gain > 1e-6) || !(gain <= 1.0) || !std::isfinite(mean)) return;
  const double moved = mean - p.predicted_mean;
  const double normalised = std::min(moved * moved / (gain * p.predicted_variance), 25.0);
  const double fade = std::exp(-elapsed_s / config_.nuisance_memory_s);
  p.score = fade * p.score + gain * (normalised - 1.0);
  p.fisher = fade * p.fisher + gain * gain;
  const double raw = p.predicted_mean + moved / gain;
  const double inverse_noise = gain / (p.predicted_variance * (1.0 - gain) + 1e-12 * p.predicted_variance);
  const double recent = std::exp(-elapsed_s / kRecent_s);
  p.presence = recent * p.presence + (std::min(raw * raw * inverse_noise, 25.0) - 1.0) * inverse_noise;
  p.presence_variance = recent * recent * p.presence_variance + 2.0 * inverse_noise * inverse_noise;
  const double weight = gain / p.predicted_variance;  // inverse variance of the innovation
  p.product = fade * p.product + weight * (moved / gain) * p.previous_mean;
  p.square = fade * p.square + weight * p.previous_mean * p.previous_mean;
  // Small Newton steps; the sums are reduced by the part that the step removes.
  const double rate = std::min(1.0, elapsed_s / 1.0);
  const double change = std::clamp(rate * p.score / (p.fisher + kPriorInformation), -0.2, 0.2);
  p.variance = std::clamp(p.variance * std::exp(change), p.min_variance, p.max_variance);
  p.score -= change * p.fisher;
  const double correct = rate * p.product / (p.square + kCorrelationInformation);
  const double keep = std::clamp(p.keep + std::clamp(correct, -0.05, 0.05), 0.0, 0.98);
  const double step_s = std::max(last_elapsed_s_, 1e-3);
  const double correlation = keep > 1e-3 ? -step_s / std::log(keep) : p.min_correlation_s;
  p.correlation_s = std::clamp(correlation, p.min_correlation_s, p.max_correlation_s);
  p.product -= correct * p.square;
}

}  // namespace boresight::alignment
