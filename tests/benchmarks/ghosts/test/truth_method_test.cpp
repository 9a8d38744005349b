// Perfect labels, and perfect labels with a random share of errors.
#include "tests/benchmarks/ghosts/common/truth_method.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

namespace boresight::bench {
namespace {

constexpr std::uint32_t kMovingOnes = 400, kAll = 800;

/// Number of detections labelled as moving in a scan whose first half are moving objects and second half ghosts.
std::uint32_t count_moving_labels(TruthMethod method) {
  const auto scan = std::make_unique<CorrectedScan>();
  scan->number_of_valid_detections = kAll;
  std::vector<simulator::DetectionTruth> truth(kAll);
  for (std::uint32_t i = 0; i < kAll; ++i) {
    scan->detection_flags[i] = corrected_flag::kMoving;
    truth[i].provenance = i < kMovingOnes ? Provenance::kMoving : Provenance::kGhostType2;
  }
  method.set_truth(truth);
  const auto out = std::make_unique<ClassifiedScan>();
  method.classify(*scan, *out);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < kAll; ++i) {
    const bool moves = out->provenance[i] == Provenance::kMoving;
    EXPECT_EQ(out->ghost_probability(i), moves ? 0.0F : 1.0F);
    EXPECT_TRUE(i < kMovingOnes || !moves) << "random errors never label a ghost as moving";
    count += moves ? 1 : 0;
  }
  return count;
}

TEST(TruthMethod, LabelsEqualTheTruth) {
  EXPECT_EQ(count_moving_labels(TruthMethod()), kMovingOnes);
}

TEST(TruthMethod, MislabelsTheRequestedShareOfMoving) {
  constexpr double kShare = 0.25;
  const std::uint32_t count = count_moving_labels(TruthMethod(kShare, 1));
  // Three standard deviations of a binomial distribution.
  EXPECT_NEAR(count, (1.0 - kShare) * kMovingOnes, 3.0 * std::sqrt(kShare * (1.0 - kShare) * kMovingOnes));
  EXPECT_EQ(count, count_moving_labels(TruthMethod(kShare, 1)));
  EXPECT_NE(count, count_moving_labels(TruthMethod(kShare, 2)));
}

}  // namespace
}  // namespace boresight::bench
