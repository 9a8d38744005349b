// Equations (G1) and (G2) by hand.
#include "services/ghost_filter/core/evidence/weights.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

/// Weights of which each is a different number.
EvidenceWeights distinct_weights() {
  EvidenceWeights w;
  w.prior_log_odds = -0.4;
  w.alone.constant = 0.25;
  w.ratio.constant = 1.75;
  w.with_tracks.constant = -0.75;
  for (std::size_t k = 0; k < kEvidences; ++k) {
    for (std::size_t level = 0; level < kMostLevels; ++level) {
      w.ratio.of[k][level] = 0.05 * static_cast<double>(k) - 0.02 * static_cast<double>(level);
      w.alone.of[k][level] = 0.1 * static_cast<double>(k) - 0.03 * static_cast<double>(level);
      w.with_tracks.of[k][level] = -0.2 * static_cast<double>(k) + 0.07 * static_cast<double>(level);
    }
  }
  w.track_unsure = {-1.0, -0.5, 0.0, 0.5, 1.0};
  w.track_sure = {-4.0, -2.0, 1.0, 2.0, 3.0};
  return w;
}

TEST(EvidenceWeights, AddUpWithoutTracks) {
  Levels levels;
  levels.of[2] = 3;
  levels.of[7] = 1;
  // 0.25 + 0.1·(0 + … + 7) − 0.03·(3 + 1): those of the scans.
  EXPECT_NEAR(log_odds_alone(distinct_weights(), levels), 0.25 + 2.8 - 0.12, 1e-12);
  EXPECT_NEAR(log_likelihood_ratio(distinct_weights(), levels), 0.25 + 2.8 - 0.12 + 0.4, 1e-12);
}

TEST(EvidenceWeights, OfTracksAreBlendedByHowSureTheObjectIs) {
  Levels levels;
  levels.has_tracks = true;
  levels.of[1] = 2;
  levels.track = 3;
  const double others = -0.75 - 0.2 * 45.0 + 0.14;
  for (const float sure : {0.0F, 0.25F, 1.0F}) {
    levels.sure = sure;
    const double s = static_cast<double>(sure);
    EXPECT_NEAR(posterior_log_odds(distinct_weights(), levels), others + (1.0 - s) * 0.5 + s * 2.0, 1e-9);
  }
}

TEST(EvidenceWeights, WithoutTracksThePosteriorIsThatOfTheScansAlone) {
  Levels levels;
  levels.of[4] = 2;
  levels.track = 4;
  levels.sure = 1.0F;
  EXPECT_EQ(posterior_log_odds(distinct_weights(), levels), log_odds_alone(distinct_weights(), levels));
}

TEST(EvidenceWeights, WithTracksTheRatioHasWeightsOfItsOwn) {
  Levels levels;
  levels.of[2] = 3;
  levels.of[9] = 2;
  levels.has_tracks = true;
  // 1.75 + 0.05·(0 + … + 9) − 0.02·(3 + 2).
  EXPECT_NEAR(log_likelihood_ratio(distinct_weights(), levels), 1.75 + 2.25 - 0.1, 1e-12);
}

TEST(EvidenceWeights, TheRatioDependsOnTheTracksByTheirMirrorImagesOnly) {
  Levels none, object;
  none.has_tracks = object.has_tracks = true;
  object.track = 4;
  object.sure = 1.0F;
  EXPECT_EQ(log_likelihood_ratio(distinct_weights(), none), log_likelihood_ratio(distinct_weights(), object));
}

TEST(EvidenceWeights, AreTheMostThatAPieceOfEvidenceCanSay) {
  const EvidenceWeights w = distinct_weights();
  for (std::size_t k = 0; k < kEvidences; ++k) {
    Levels levels;
    const double before = log_odds(w.alone, levels, kEvidences) - w.alone.of[k][0];
    for (std::size_t level = 0; level < kMostLevels; ++level) {
      levels.of[k] = static_cast<std::uint8_t>(level);
      EXPECT_NEAR(log_odds(w.alone, levels, kEvidences) - before, w.alone.of[k][level], 1e-12);
    }
  }
}

TEST(EvidenceWeights, OfNothingSayNothing) {
  Levels levels;
  levels.has_tracks = true;
  levels.of.fill(3);
  levels.track = 2;
  levels.sure = 0.5F;
  EXPECT_EQ(posterior_log_odds(EvidenceWeights{}, levels), 0.0);
  EXPECT_EQ(log_likelihood_ratio(EvidenceWeights{}, levels), 0.0);
}

}  // namespace
}  // namespace boresight::ghosts
