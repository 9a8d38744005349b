#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/batch_calibration/gate.hpp"
#include "services/alignment_estimator/core/batch_calibration/joint.hpp"
#include "services/alignment_estimator/core/batch_calibration/judgement.hpp"
#include "services/alignment_estimator/core/published/draw.hpp"

namespace boresight::alignment::batch_calibration {

namespace {

/// A larger step means that there is no solution.
constexpr double kMaxStep = 0.02;

class Moments {
 public:
  void add(double x) {
    ++n_;
    const double square = x * x;
    m1_ += x;
    m2_ += square;
    m3_ += square * x;
    m4_ += square * square;
  }
  [[nodiscard]] Residuals residuals() const {
    Residuals r;
    r.count = n_;
    if (n_ == 0) return r;
    const auto n = static_cast<double>(n_);
    const double m = m1_ / n, m2 = m2_ / n, m3 = m3_ / n, m4 = m4_ / n;
    const double variance = m2 - m * m;
    r.rmse_mps = std::sqrt(m2);
    if (variance < 1e-12) return r;
    r.skewness = (m3 - 3.0 * m * m2 + 2.0 * m * m * m) / std::pow(variance, 1.5);
    r.kurtosis = (m4 - 4.0 * m * m3 + 6.0 * m * m * m2 - 3.0 * m * m * m * m) / (variance * variance);
    return r;
  }

 private:
  std::size_t n_ = 0;
  double m1_ = 0.0, m2_ = 0.0, m3_ = 0.0, m4_ = 0.0;
};

void add_residuals(const Recording& radar, const Eigen::Vector4d& b, bool elevation, Moments& one, Moments& all) {
  for (const Detection& d : radar.detections) {
    const double residual = published::PlanarModel(radar.nominal, b, d.speed_mps, d.yaw_rate_radps)
                                .value(d.azimuth_rad, elevation ? d.elevation_rad : 0.0) -
                            d.range_rate_mps;
    one.add(residual);
    all.add(residual);
  }
}

/// The published iteration; fills the history.
Eigen::VectorXd iterate(std::span<const Recording> radars, Eigen::VectorXd x, const Config& config, Result& result,
                        const std::function<void(double)>& progress) {
  published::Draw draw(config.seed);
  // The drawn detections lie anywhere in a recording that exceeds the cache. Copying all of them before the first use
  // overlaps the cache misses; fetching them one by one would take most of the time.
  std::vector<Detection> drawn(config.detections_per_iteration);
  JointEquations joint(radars.size());
  for (std::size_t i = 0; i <= config.iterations; ++i) {
    constexpr std::size_t kIterationsBetweenProgress = 256;
    if (progress && i % kIterationsBetweenProgress == 0) {
      progress(static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(config.iterations, 1)));
    }
    joint.clear();
    for (std::size_t r = 0; r < radars.size(); ++r) {
      const Recording& radar = radars[r];
      published::NormalEquations equations;
      published::PlanarModel model(radar.nominal, of_radar(x, r), 0.0, 0.0);
      if (!radar.detections.empty()) {
        for (Detection& d : drawn) d = radar.detections[draw.below(radar.detections.size())];
        for (const Detection& d : drawn) add(d, model, equations);
      }
      joint.add(r, equations);
      // A radar without data has no gradient. A unit diagonal keeps the equations regular and its parameters unchanged.
      if (radar.detections.empty()) joint.jtj.diagonal().segment<3>(first_angle(r)).setOnes();
    }
    joint.jtr(0) += config.speed_scale_cost;  // (31): its derivative to k_v is 0.1 + Σ R·∂R/∂k_v
    if (i % std::max<std::size_t>(config.history_every, 1) == 0 || i == config.iterations) {
      result.history.push_back(
          {i, config.speed_scale_cost * x(0) + 0.5 * joint.rtr, std::vector<double>(x.data(), x.data() + x.size())});
    }
    if (i == config.iterations) break;
    const Eigen::VectorXd step = total_least_squares_step(joint, config.rate);
    if (step.cwiseAbs().maxCoeff() < kMaxStep) x += step;
  }
  return x;
}

}  // namespace

Result calibrate(std::span<const Recording> recordings, const Config& config, const Progress& progress) {
  const auto of = [&](Phase phase) -> std::function<void(double)> {
    if (!progress) return {};
    return [&progress, phase](double share) { progress(phase, share); };
  };
  Result result;
  result.radars.resize(recordings.size());
  std::vector<Recording> radars = gated(recordings, config, of(Phase::kGate));
  bool any = false;
  for (std::size_t r = 0; r < radars.size(); ++r) {
    result.radars[r].offered = recordings[r].detections.size();
    result.radars[r].used = radars[r].detections.size();
    any = any || result.radars[r].used > 0;
    // Drawn once, since a recording with elevation has one elevation per detection too.
    fill_in(radars[r], config, config.seed * 1000 + r);
  }
  if (!any) {
    result.problem = "no radar has enough stationary detections";
    return result;
  }
  Eigen::VectorXd start = Eigen::VectorXd::Zero(first_angle(radars.size()));
  start(0) = config.start_speed_scale;
  for (std::size_t r = 0; r < radars.size(); ++r) {
    if (!radars[r].detections.empty()) start(first_angle(r) + 1) = config.start_pitch_rad;
  }
  const Eigen::VectorXd found = iterate(radars, start, config, result, of(Phase::kIteration));
  if (!found.allFinite()) {
    result.problem = "the iteration diverged";
    return result;
  }

  const std::vector<Parameter> judged = judge(radars, found, config, of(Phase::kJudgement));
  result.speed_scale = judged[0];
  // The same without assumed elevations: k_v and yaw alone, elevation 0.
  std::vector<Recording> flat = radars;
  std::vector<Eigen::Index> held;
  for (std::size_t r = 0; r < flat.size(); ++r) {
    if (!flat[r].has_elevation) {
      for (Detection& d : flat[r].detections) d.elevation_rad = 0.0;
    }
    held.push_back(first_angle(r) + 1);
    held.push_back(first_angle(r) + 2);
    if (flat[r].detections.empty()) held.push_back(first_angle(r));
  }
  Eigen::VectorXd level = Eigen::VectorXd::Zero(found.size());
  level(0) = 1.0;
  const Eigen::VectorXd yaw_only = solve(flat, level, held).parameters;

  Moments before_all, after_all, yaw_only_all, yaw_only_one;
  for (std::size_t r = 0; r < radars.size(); ++r) {
    const auto at = static_cast<std::size_t>(first_angle(r));
    RadarResult& radar = result.radars[r];
    radar.yaw = judged[at];
    radar.pitch = judged[at + 1];
    radar.roll = judged[at + 2];
    Moments before, after;
    add_residuals(radars[r], {1.0, 0.0, 0.0, 0.0}, radars[r].has_elevation, before, before_all);
    add_residuals(radars[r], of_radar(found, r), true, after, after_all);
    add_residuals(flat[r], of_radar(yaw_only, r), true, yaw_only_one, yaw_only_all);
    radar.before = before.residuals();
    radar.after = after.residuals();
  }
  result.before = before_all.residuals();
  result.after = after_all.residuals();
  result.yaw_only = yaw_only_all.residuals();
  result.ok = true;
  return result;
}

const char* to_text(Support support) {
  switch (support) {
    case Support::kSupported:
      return "supported";
    case Support::kFollowsFillIn:
      return "not supported: follows the assumed elevations";
    case Support::kSpreads:
      return "not supported: differs between draws of the assumed elevations";
    case Support::kUncertain:
      return "not supported: too uncertain";
    case Support::kNoData:
      return "no data";
  }
  return "";
}

}  // namespace boresight::alignment::batch_calibration
