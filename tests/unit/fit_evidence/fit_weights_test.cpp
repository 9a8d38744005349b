// The fit of the weights: by simulated labels, and against the posterior's own definition.
#include "services/boresight/fit_evidence/fit_weights.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::fit_evidence {
namespace {

using namespace ghosts;

constexpr auto kVerdictKind = static_cast<std::size_t>(EvidenceKind::kVerdict);

EvidenceWeights random_weights(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> weight(0.0, 0.6);
  EvidenceWeights w;
  for (LevelWeights* each : {&w.alone, &w.with_tracks, &w.ratio}) {
    each->constant = weight(random);
    for (std::size_t k = 0; k < kEvidences; ++k) {
      for (std::size_t level = 0; level < kEvidenceSpecs[k].levels; ++level) each->of[k][level] = weight(random);
    }
  }
  for (std::size_t k = kScanEvidences; k < kEvidences; ++k) w.alone.of[k] = {};  // of tracks
  for (std::size_t level = 0; level < kTrackLevels; ++level) {
    w.track_unsure[level] = weight(random);
    w.track_sure[level] = 2.0 * weight(random);
  }
  return w;
}

/// Independent levels, each as often as another; labels by the log odds.
std::vector<LabelledEvidence> labelled(unsigned seed, std::size_t number,
                                       const std::function<double(const Levels&)>& log_odds_of) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  std::vector<LabelledEvidence> all(number);
  for (LabelledEvidence& each : all) {
    for (std::size_t k = 0; k < kEvidences; ++k) {
      each.levels.of[k] = static_cast<std::uint8_t>(chance(random) * static_cast<double>(kEvidenceSpecs[k].levels));
    }
    each.levels.track = static_cast<std::uint8_t>(chance(random) * static_cast<double>(kTrackLevels));
    each.levels.sure = static_cast<float>(chance(random));
    each.levels.has_tracks = true;
    each.is_real = chance(random) < 1.0 / (1.0 + std::exp(-log_odds_of(each.levels)));
  }
  return all;
}

/// p (1 − p) of the labels in the mean: what a detection tells of a weight.
double mean_variance(const std::vector<LabelledEvidence>& detections,
                     const std::function<double(const Levels&)>& log_odds_of) {
  double sum = 0.0;
  for (const LabelledEvidence& each : detections) {
    const double p = 1.0 / (1.0 + std::exp(-log_odds_of(each.levels)));
    sum += p * (1.0 - p);
  }
  return sum / static_cast<double>(detections.size());
}

/// Compares differences of weights within one kind of evidence. The weights themselves are not determined: the fit may
/// add a constant to one kind and subtract it from another. `information`: Fisher information of all detections
/// together on the log odds.
void expect_near(const LevelWeights& fitted, const LevelWeights& truth, double information) {
  double squares = 0.0, compared = 0.0;
  for (std::size_t k = 0; k < kEvidences; ++k) {
    const double levels = static_cast<double>(kEvidenceSpecs[k].levels);
    const double std = std::sqrt(2.0 * levels / information);
    for (std::size_t level = 1; level < kEvidenceSpecs[k].levels; ++level) {
      const double error = fitted.of[k][level] - fitted.of[k][0] - truth.of[k][level] + truth.of[k][0];
      EXPECT_LT(std::abs(error), 4.5 * std) << kEvidenceSpecs[k].key << ' ' << level;
      squares += error * error / (std * std);
      compared += 1.0;
    }
  }
  EXPECT_LT(squares / compared, 1.6);
  EXPECT_GT(squares / compared, 0.3);
}

TEST(FitWeights, FindsTheWeightsThatMadeTheLabels) {
  constexpr std::size_t kNumber = 30'000;
  const EvidenceWeights truth = random_weights(1);
  const auto without_tracks = [&](const Levels& l) { return log_odds_alone(truth, l); };
  const auto alone = labelled(2, kNumber, without_tracks);
  expect_near(fit_weights(alone, FitConfig{}).alone, truth.alone, kNumber * mean_variance(alone, without_tracks));

  const auto with_tracks = [&](const Levels& l) { return posterior_log_odds(truth, l); };
  const auto tracked = labelled(3, kNumber, with_tracks);
  const EvidenceWeights fitted = fit_weights(tracked, FitConfig{});
  expect_near(fitted.with_tracks, truth.with_tracks, kNumber * mean_variance(tracked, with_tracks));
  for (std::size_t level = 1; level < kTrackLevels; ++level) {
    const auto difference = [&](const auto& w) { return w[level] - w[0]; };
    EXPECT_NEAR(difference(fitted.track_sure), difference(truth.track_sure), 0.5);
    EXPECT_NEAR(difference(fitted.track_unsure), difference(truth.track_unsure), 0.5);
  }
}

TEST(FitWeights, OfTheRatioUseAllKindsOfDetectionsWithKnownTracksWithoutThePrior) {
  constexpr std::size_t kNumber = 30'000;
  const EvidenceWeights truth = random_weights(7);
  const auto ratio = [&](const Levels& l) { return log_odds(truth.ratio, l, kEvidences); };
  auto detections = labelled(8, kNumber, ratio);
  const EvidenceWeights fitted = fit_weights(detections, FitConfig{});
  expect_near(fitted.ratio, truth.ratio, kNumber * mean_variance(detections, ratio));
  double real = 0.5, unreal = 0.5;
  for (const LabelledEvidence& each : detections) (each.is_real ? real : unreal) += 1.0;
  // The constant may move to the levels of a kind, and the sum is determined.
  double sum = 0.0, expected = 0.0;
  for (const LabelledEvidence& each : detections) {
    sum += log_odds(fitted.ratio, each.levels, kEvidences) / kNumber;
    expected += (ratio(each.levels) - std::log(real / unreal)) / kNumber;
  }
  EXPECT_NEAR(sum, expected, 0.1);
  for (std::size_t i = 0; i < kNumber; ++i) {
    detections.push_back(detections[i]);
    detections.back().is_real = i % 7 == 0;
    detections.back().levels.has_tracks = false;
  }
  const EvidenceWeights again = fit_weights(detections, FitConfig{});
  EXPECT_EQ(again.ratio.of, fitted.ratio.of) << "detections without known tracks change nothing";
  EXPECT_EQ(again.ratio.constant, fitted.ratio.constant);
}

/// Log of the posterior, up to a constant: likelihood of the labels, and a normal prior about the prior's means.
double log_posterior(const std::vector<LabelledEvidence>& detections, const EvidenceWeights& w, bool with_tracks,
                     const FitConfig& config) {
  double sum = 0.0;
  for (const LabelledEvidence& each : detections) {
    if (with_tracks && !each.levels.has_tracks) continue;
    const double odds = with_tracks ? posterior_log_odds(w, each.levels) : log_odds_alone(w, each.levels);
    sum -= std::log1p(std::exp(each.is_real ? -odds : odds));
  }
  const LevelWeights& levels = with_tracks ? w.with_tracks : w.alone;
  double squares = levels.constant * levels.constant;
  for (std::size_t k = 0; k < kEvidences; ++k) {
    for (std::size_t level = 0; level < kMostLevels; ++level) {
      const double mean = k == kVerdictKind && (level == 2 || level == 3) ? config.doubted_log_odds : 0.0;
      squares += std::pow(levels.of[k][level] - mean, 2);
    }
  }
  for (std::size_t level = 0; with_tracks && level < kTrackLevels; ++level) {
    squares += std::pow(w.track_unsure[level], 2) + std::pow(w.track_sure[level], 2);
  }
  return sum - 0.5 * config.ridge * squares;
}

TEST(FitWeights, EndsWhereThePosteriorHasNoSlope) {
  const EvidenceWeights truth = random_weights(4);
  auto detections = labelled(5, 1500, [&](const Levels& l) { return posterior_log_odds(truth, l); });
  for (std::size_t i = 0; i < detections.size(); i += 3) detections[i].levels.has_tracks = false;
  const FitConfig config{0.7, -2.0};
  const EvidenceWeights fitted = fit_weights(detections, config);
  const auto expect_flat = [&](bool with_tracks, const std::function<double&(EvidenceWeights&)>& weight) {
    constexpr double kStep = 1e-4;
    EvidenceWeights less = fitted, more = fitted;
    weight(less) -= kStep;
    weight(more) += kStep;
    const double slope =
        (log_posterior(detections, more, with_tracks, config) - log_posterior(detections, less, with_tracks, config)) /
        (2.0 * kStep);
    EXPECT_NEAR(slope, 0.0, 1e-3);
  };
  for (const bool with_tracks : {false, true}) {
    const auto levels = [with_tracks](EvidenceWeights& w) -> LevelWeights& {
      return with_tracks ? w.with_tracks : w.alone;
    };
    expect_flat(with_tracks, [&](EvidenceWeights& w) -> double& { return levels(w).constant; });
    for (std::size_t k = 0; k < kEvidences; ++k) {
      for (std::size_t level = 0; level < kEvidenceSpecs[k].levels; ++level) {
        expect_flat(with_tracks, [&](EvidenceWeights& w) -> double& { return levels(w).of[k][level]; });
      }
    }
  }
  for (std::size_t level = 0; level < kTrackLevels; ++level) {
    expect_flat(true, [&](EvidenceWeights& w) -> double& { return w.track_unsure[level]; });
    expect_flat(true, [&](EvidenceWeights& w) -> double& { return w.track_sure[level]; });
  }
}

TEST(FitWeights, WithoutDetectionsAllKeepTheirPrior) {
  const EvidenceWeights w = fit_weights({}, FitConfig{1.0, -2.5});
  EXPECT_EQ(w.prior_log_odds, 0.0);
  for (const LevelWeights* each : {&w.alone, &w.with_tracks}) {
    EXPECT_EQ(each->constant, 0.0);
    for (std::size_t k = 0; k < kEvidences; ++k) {
      for (std::size_t level = 0; level < kMostLevels; ++level) {
        EXPECT_EQ(each->of[k][level], k == kVerdictKind && (level == 2 || level == 3) ? -2.5 : 0.0);
      }
    }
  }
  EXPECT_EQ(w.track_unsure, (std::array<double, kTrackLevels>{}));
  EXPECT_EQ(w.track_sure, (std::array<double, kTrackLevels>{}));
}

TEST(FitWeights, AVerdictThatNoDetectionHasKeepsItsPrior) {
  auto detections = labelled(6, 500, [](const Levels&) { return 0.0; });
  for (LabelledEvidence& each : detections) each.levels.of[kVerdictKind] = 0;
  const EvidenceWeights w = fit_weights(detections, FitConfig{});
  EXPECT_NEAR(w.alone.of[kVerdictKind][2], FitConfig{}.doubted_log_odds, 1e-9);
  EXPECT_NEAR(w.alone.of[kVerdictKind][1], 0.0, 1e-9);
}

TEST(FitWeights, APriorOfOddsIsThatOfTheLabels) {
  std::vector<LabelledEvidence> detections(399);
  for (std::size_t i = 0; i < 100; ++i) detections[i].is_real = true;
  // One half of a detection for each: 100.5 and 299.5.
  EXPECT_NEAR(fit_weights(detections, FitConfig{}).prior_log_odds, std::log(100.5 / 299.5), 1e-12);
}

TEST(FitWeights, LabelsWithoutAnExceptionStayFinite) {
  std::vector<LabelledEvidence> detections(5000);
  for (std::size_t i = 0; i < detections.size(); ++i) {
    detections[i].is_real = i % 2 == 0;
    detections[i].levels.has_tracks = true;
    detections[i].levels.of[1] = i % 2 == 0 ? 3 : 0;
    detections[i].levels.track = i % 2 == 0 ? 4 : 0;
    detections[i].levels.sure = 1.0F;
  }
  const EvidenceWeights w = fit_weights(detections, FitConfig{});
  for (const double each : {w.alone.of[1][0], w.alone.of[1][3], w.with_tracks.of[1][3], w.track_sure[4]}) {
    EXPECT_TRUE(std::isfinite(each));
    EXPECT_LT(std::abs(each), 20.0);
  }
  EXPECT_GT(log_odds_alone(w, detections[0].levels), 3.0);
  EXPECT_LT(log_odds_alone(w, detections[1].levels), -3.0);
  EXPECT_GT(posterior_log_odds(w, detections[0].levels), 3.0);
  std::vector<LabelledEvidence> all_real(100);
  for (LabelledEvidence& each : all_real) each.is_real = true;
  EXPECT_TRUE(std::isfinite(fit_weights(all_real, FitConfig{}).prior_log_odds));
}

}  // namespace
}  // namespace boresight::fit_evidence
