// Scores of probabilities, and their reference.
#include "services/boresight/fit_evidence/scores.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "services/boresight/fit_evidence/base_rate.hpp"

namespace boresight::fit_evidence {
namespace {

fit_evidence::LabelledEvidence with_past(std::uint8_t level, bool is_real) {
  fit_evidence::LabelledEvidence each;
  each.levels.of[static_cast<std::size_t>(ghosts::EvidenceKind::kPast)] = level;
  each.is_real = is_real;
  return each;
}

TEST(Scores, AreMeansOverDetectionsByTheWeights) {
  ghosts::EvidenceWeights weights;
  weights.alone.of[static_cast<std::size_t>(ghosts::EvidenceKind::kPast)][1] = std::log(3.0);  // p = 0.75
  Scores scores;
  EXPECT_TRUE(std::isnan(scores.brier()));
  EXPECT_TRUE(std::isnan(scores.log_loss()));
  scores.add(std::array{with_past(1, true), with_past(1, false), with_past(0, true)}, weights);
  EXPECT_EQ(scores.detections(), 3u);
  EXPECT_NEAR(scores.brier(), (0.0625 + 0.5625 + 0.25) / 3.0, 1e-12);
  EXPECT_NEAR(scores.log_loss(), -std::log(0.75 * 0.25 * 0.5) / 3.0, 1e-12);
}

TEST(Scores, LogarithmicLossOfACertainErrorIsFinite) {
  EXPECT_NEAR(log_loss(1.0, false), -std::log(1e-4), 1e-9);
  EXPECT_NEAR(log_loss(0.0, true), -std::log(1e-4), 1e-9);
}

TEST(BaseRateOfARadar, HasTheLabelsOfThePastOnly) {
  BaseRate rate;
  EXPECT_EQ(rate.at(1, 0.0), 0.5) << "nothing is known before the first scan";
  for (int i = 0; i < 3; ++i) rate.add(1, true);
  EXPECT_EQ(rate.at(1, 0.0), 3.5 / 4.0);
  EXPECT_EQ(rate.at(2, 0.0), 0.5) << "another radar";
  const double kept = std::exp(-1.0);
  EXPECT_NEAR(rate.at(1, BaseRate::kMemory_s), (3.0 * kept + 0.5) / (3.0 * kept + 1.0), 1e-12);
}

}  // namespace
}  // namespace boresight::fit_evidence
