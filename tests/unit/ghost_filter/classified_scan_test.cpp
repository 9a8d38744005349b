// The probabilities of a classified scan: one column for each origin.
#include "interfaces/messages/classified_scan.hpp"

#include <memory>

#include <gtest/gtest.h>

namespace boresight {
namespace {

TEST(ClassifiedScan, HasAColumnOfProbabilitiesForEachOrigin) {
  const auto scan = std::make_unique<ClassifiedScan>();
  scan->set_probabilities(5, {0.5F, 0.25F, 0.125F, 0.0625F, 0.03125F, 0.03125F});
  const ClassifiedScan& read = *scan;
  EXPECT_EQ(read.probability(Provenance::kMoving, 5), 0.5F);
  EXPECT_EQ(read.probability(Provenance::kAmbiguity, 5), 0.03125F);
  for (const Provenance origin : kOrigins) {
    EXPECT_EQ(read.probability(origin, 5), read.origin_probability[static_cast<std::size_t>(origin) - 1][5]);
    EXPECT_EQ(read.probability(origin, 4), 0.0F);
    EXPECT_EQ(read.probability(origin, 6), 0.0F);
  }
  scan->probability(Provenance::kClutter, 5) = 0.75F;
  EXPECT_EQ(read.origin_probability[4][5], 0.75F);
}

TEST(ClassifiedScan, GhostProbabilityIsWhatMovingAndStationaryLeave) {
  const auto scan = std::make_unique<ClassifiedScan>();
  scan->set_probabilities(0, {0.5F, 0.125F, 0.125F, 0.125F, 0.0625F, 0.0625F});
  EXPECT_EQ(scan->ghost_probability(0), 1.0F - 0.5F - 0.125F);
  EXPECT_EQ(scan->ghost_probability(1), 0.0F) << "not classified";
}

TEST(ClassifiedScan, ACertainOriginHasACertainRatioAndAnUnknownOneNone) {
  const auto scan = std::make_unique<ClassifiedScan>();
  for (const Provenance origin : kOrigins) {
    scan->set_certain(3, origin);
    EXPECT_EQ(scan->moving_log_likelihood_ratio[3],
              origin == Provenance::kMoving ? ClassifiedScan::kCertain : -ClassifiedScan::kCertain);
  }
  scan->set_certain(3, Provenance::kUnknown);
  EXPECT_EQ(scan->moving_log_likelihood_ratio[3], 0.0F);
}

TEST(ClassifiedScan, ACertainOriginReplacesAllProbabilities) {
  const auto scan = std::make_unique<ClassifiedScan>();
  for (const Provenance origin : kOrigins) {
    scan->set_certain(3, origin);
    EXPECT_EQ(scan->provenance[3], origin);
    for (const Provenance each : kOrigins) EXPECT_EQ(scan->probability(each, 3), each == origin ? 1.0F : 0.0F);
  }
  scan->set_certain(3, Provenance::kUnknown);
  EXPECT_EQ(scan->provenance[3], Provenance::kUnknown);
  for (const Provenance each : kOrigins) EXPECT_EQ(scan->probability(each, 3), 0.0F);
}

}  // namespace
}  // namespace boresight
