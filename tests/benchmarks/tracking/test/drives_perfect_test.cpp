// Perfect origins of detections.
#include <memory>

#include "tests/benchmarks/tracking/drives/perfect/true_origins.hpp"

namespace boresight::bench::tracking {
namespace {

TEST(DrivesTrueOrigins, ReplaceTheProbabilitiesOfClassifiedDetectionsOnly) {
  const auto scan = std::make_unique<ClassifiedScan>();
  scan->number_of_valid_detections = 4;
  scan->set_certain(0, Provenance::kMoving);
  scan->set_certain(1, Provenance::kGhostType1);
  scan->set_probabilities(1, {0.3F, 0.0F, 0.7F, 0.0F, 0.0F, 0.0F});
  scan->set_certain(2, Provenance::kUnknown);
  scan->set_certain(3, Provenance::kMoving);
  scan->detection_flags[1] = corrected_flag::kMoving;
  set_true_origins({{Provenance::kClutter, ""}, {Provenance::kMoving, ""}, {Provenance::kMoving, ""}}, *scan);
  EXPECT_EQ(scan->provenance[0], Provenance::kClutter);
  EXPECT_EQ(scan->probability(Provenance::kMoving, 0), 0.0F);
  EXPECT_EQ(scan->probability(Provenance::kClutter, 0), 1.0F);
  EXPECT_EQ(scan->probability(Provenance::kMoving, 1), 1.0F);
  EXPECT_EQ(scan->ghost_probability(1), 0.0F);
  EXPECT_EQ(scan->detection_flags[1], corrected_flag::kMoving);
  EXPECT_EQ(scan->provenance[2], Provenance::kUnknown) << "rejected";
  EXPECT_EQ(scan->probability(Provenance::kMoving, 2), 0.0F);
  EXPECT_EQ(scan->probability(Provenance::kMoving, 3), 1.0F) << "the truth ends before";
}

}  // namespace
}  // namespace boresight::bench::tracking
