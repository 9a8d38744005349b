#include "services/simulator/judge/confusion.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace boresight::judge {
namespace {

TEST(Confusion, CountsByTruthWithoutRejectedDetections) {
  Confusion c;
  for (int i = 0; i < 3; ++i) c.add(Provenance::kGhostType1, Provenance::kGhostType1, false);
  for (int i = 0; i < 4; ++i) c.add(Provenance::kGhostType1, Provenance::kGhostType2, false);
  c.add(Provenance::kGhostType1, Provenance::kMoving, false);
  for (int i = 0; i < 5; ++i) c.add(Provenance::kGhostType1, Provenance::kUnknown, true);
  EXPECT_EQ(c.count(Provenance::kGhostType1), 8u);
  EXPECT_EQ(c.rejected(Provenance::kGhostType1), 5u);
  EXPECT_DOUBLE_EQ(c.percent(Provenance::kGhostType1, Provenance::kGhostType1), 37.5);
  EXPECT_DOUBLE_EQ(c.percent_ghost(Provenance::kGhostType1), 87.5);
  EXPECT_TRUE(std::isnan(c.percent(Provenance::kMoving, Provenance::kMoving)));
}

}  // namespace
}  // namespace boresight::judge
