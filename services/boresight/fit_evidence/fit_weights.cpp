#include "services/boresight/fit_evidence/fit_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace boresight::fit_evidence {

using namespace ghosts;

namespace {

/// Places of the weights in a vector: constant, levels of each kind, tracks.
constexpr std::size_t kTrackUnsure = 1 + kEvidences * kMostLevels;
constexpr std::size_t kTrackSure = kTrackUnsure + kTrackLevels;
constexpr std::size_t kSize = kTrackSure + kTrackLevels;
constexpr std::size_t kRegressors = 1 + kEvidences + 2;  // that are not 0, of one detection

std::size_t place(std::size_t kind, std::size_t level) {
  return 1 + kind * kMostLevels + level;
}

enum class Which : std::uint8_t { kAlone, kRatio, kWithTracks };

std::size_t kinds_of(Which which) {
  return which == Which::kAlone ? kScanEvidences : kEvidences;
}

struct Regressor {
  std::size_t place;
  double value;
};
using Regressors = std::array<Regressor, kRegressors>;

Regressors regressors(const Levels& levels, Which which) {
  Regressors x{};
  x[0] = {0, 1.0};
  const double sure = static_cast<double>(levels.sure), known = which == Which::kWithTracks ? 1.0 : 0.0;
  for (std::size_t k = 0; k < kEvidences; ++k) {
    x[1 + k] = {place(k, levels.of[k]), k < kinds_of(which) ? 1.0 : 0.0};
  }
  x[1 + kEvidences] = {kTrackUnsure + levels.track, known * (1.0 - sure)};
  x[2 + kEvidences] = {kTrackSure + levels.track, known * sure};
  return x;
}

bool takes(Which which, const LabelledEvidence& each) {
  return which == Which::kAlone || each.levels.has_tracks;
}

/// ln N/F of real and false detections, with one half of a detection for each.
double prior_log_odds(const std::vector<LabelledEvidence>& detections, Which which) {
  double real = 0.5, unreal = 0.5;
  for (const LabelledEvidence& each : detections) {
    if (takes(which, each)) (each.is_real ? real : unreal) += 1.0;
  }
  return std::log(real / unreal);
}

/// Newton's method; the posterior is concave.
Eigen::VectorXd maximise(const std::vector<LabelledEvidence>& detections, Which which, const Eigen::VectorXd& prior,
                         double ridge) {
  constexpr int kMostRounds = 50;
  constexpr double kSmallStep = 1e-6, kLargestStep = 1.0;  // log odds
  Eigen::VectorXd w = prior;
  for (int round = 0; round < kMostRounds; ++round) {
    Eigen::VectorXd gradient = ridge * (prior - w);
    Eigen::MatrixXd information = ridge * Eigen::MatrixXd::Identity(kSize, kSize);
    for (const LabelledEvidence& each : detections) {
      if (!takes(which, each)) continue;
      const Regressors x = regressors(each.levels, which);
      double log_odds = 0.0;
      for (const Regressor& r : x) log_odds += r.value * w(static_cast<Eigen::Index>(r.place));
      const double p = 1.0 / (1.0 + std::exp(-log_odds));
      const double error = (each.is_real ? 1.0 : 0.0) - p, weight = p * (1.0 - p);
      for (const Regressor& a : x) {
        const auto row = static_cast<Eigen::Index>(a.place);
        gradient(row) += error * a.value;
        for (const Regressor& b : x) {
          information(static_cast<Eigen::Index>(b.place), row) += weight * a.value * b.value;
        }
      }
    }
    const Eigen::VectorXd step = information.ldlt().solve(gradient);
    const double largest = step.cwiseAbs().maxCoeff();
    w += std::min(1.0, kLargestStep / largest) * step;
    if (largest < kSmallStep) break;
  }
  return w;
}

LevelWeights level_weights(const Eigen::VectorXd& w) {
  LevelWeights out;
  out.constant = w(0);
  for (std::size_t k = 0; k < kEvidences; ++k) {
    for (std::size_t level = 0; level < kEvidenceSpecs[k].levels; ++level) {
      out.of[k][level] = w(static_cast<Eigen::Index>(place(k, level)));
    }
  }
  return out;
}

}  // namespace

EvidenceWeights fit_weights(const std::vector<LabelledEvidence>& detections, const FitConfig& config) {
  constexpr auto kVerdict = static_cast<std::size_t>(EvidenceKind::kVerdict);
  Eigen::VectorXd prior = Eigen::VectorXd::Zero(kSize);
  for (const std::size_t doubted : {2U, 3U}) {
    prior(static_cast<Eigen::Index>(place(kVerdict, doubted))) = config.doubted_log_odds;
  }
  EvidenceWeights weights;
  weights.prior_log_odds = prior_log_odds(detections, Which::kAlone);
  weights.alone = level_weights(maximise(detections, Which::kAlone, prior, config.ridge));
  weights.ratio = level_weights(maximise(detections, Which::kRatio, prior, config.ridge));
  weights.ratio.constant -= prior_log_odds(detections, Which::kRatio);
  const Eigen::VectorXd with_tracks = maximise(detections, Which::kWithTracks, prior, config.ridge);
  weights.with_tracks = level_weights(with_tracks);
  for (std::size_t level = 0; level < kTrackLevels; ++level) {
    weights.track_unsure[level] = with_tracks(static_cast<Eigen::Index>(kTrackUnsure + level));
    weights.track_sure[level] = with_tracks(static_cast<Eigen::Index>(kTrackSure + level));
  }
  return weights;
}

}  // namespace boresight::fit_evidence
