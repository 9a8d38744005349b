// Perfect labels, and those of which some are thrown out by chance.
#include "tests/benchmarks/ghosts/common/truth_method.hpp"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

namespace boresight::bench {
namespace {

constexpr std::uint32_t kMovingOnes = 400, kAll = 800;

/// Of a scan whose first half moves and is direct, and whose second half are ghosts: how many are told to move.
std::uint32_t told_to_move(TruthMethod method) {
  const auto scan = std::make_unique<CorrectedScan>();
  scan->number_of_valid_detections = kAll;
  std::vector<simulator::DetectionTruth> truth(kAll);
  for (std::uint32_t i = 0; i < kAll; ++i) {
    scan->detection_flags[i] = corrected_flag::kMoving;
    truth[i].provenance = i < kMovingOnes ? Provenance::kMoving : Provenance::kGhostType2;
  }
  method.tell(truth);
  const auto out = std::make_unique<ClassifiedScan>();
  method.classify(*scan, *out);
  std::uint32_t told = 0;
  for (std::uint32_t i = 0; i < kAll; ++i) {
    const bool moves = out->provenance[i] == Provenance::kMoving;
    EXPECT_EQ(out->ghost_probability[i], moves ? 0.0F : 1.0F);
    EXPECT_TRUE(i < kMovingOnes || !moves) << "what chance throws out it never lets through";
    told += moves ? 1 : 0;
  }
  return told;
}

TEST(TruthMethod, TellsTheTruth) {
  EXPECT_EQ(told_to_move(TruthMethod()), kMovingOnes);
}

TEST(TruthMethod, ThrowsOutAsManyAsItIsTold) {
  constexpr double kShare = 0.25;
  const std::uint32_t told = told_to_move(TruthMethod(kShare, 1));
  // Three standard deviations of a binomial distribution.
  EXPECT_NEAR(told, (1.0 - kShare) * kMovingOnes, 3.0 * std::sqrt(kShare * (1.0 - kShare) * kMovingOnes));
  EXPECT_EQ(told, told_to_move(TruthMethod(kShare, 1)));
  EXPECT_NE(told, told_to_move(TruthMethod(kShare, 2)));
}

}  // namespace
}  // namespace boresight::bench
