#include "tests/benchmarks/ghosts/common/changed_method.hpp"

#include <gtest/gtest.h>

namespace boresight::bench {
namespace {

class ChangedMethodTest : public testing::Test {
 protected:
  ChangedMethodTest() {
    config_.method = ghosts::MethodName::kMirror;
    scan_->number_of_valid_detections = 2;
    for (std::size_t i = 0; i < 2; ++i) {
      scan_->x_vehicle_m[i] = 20.0f + 10.0f * static_cast<float>(i);
      scan_->range_m[i] = scan_->x_vehicle_m[i];
      scan_->range_std_m[i] = scan_->range_rate_std_mps[i] = 0.1f;
      scan_->azimuth_std_rad[i] = 0.01f;
      scan_->rcs_dbsm[i] = 5.0f;
      scan_->range_rate_over_ground_mps[i] = i == 0 ? 1.0f : 9.0f;
      scan_->detection_flags[i] = corrected_flag::kMoving;
    }
  }
  ghosts::Config config_;
  std::unique_ptr<CorrectedScan> scan_ = std::make_unique<CorrectedScan>();
  std::unique_ptr<ClassifiedScan> out_ = std::make_unique<ClassifiedScan>();
};

TEST_F(ChangedMethodTest, FixedThresholdDecidesWhatIsStationary) {
  ChangedMethod(config_, {.stationary_below_mps = 2.0}).classify(*scan_, *out_);
  EXPECT_EQ(out_->detection_flags[0], corrected_flag::kStationary);
  EXPECT_EQ(out_->detection_flags[1], corrected_flag::kMoving);
  EXPECT_EQ(scan_->detection_flags[0], corrected_flag::kMoving);
}

TEST_F(ChangedMethodTest, WithoutRcsTheProbabilityDoesNotDependOnIt) {
  scan_->fields = scan_field::kRcs;
  const auto probability_at = [&](bool gets_rcs, float rcs_dbsm) {
    scan_->rcs_dbsm[1] = rcs_dbsm;
    ChangedMethod(config_, {.gets_rcs = gets_rcs}).classify(*scan_, *out_);
    return out_->ghost_probability(1);
  };
  EXPECT_NE(probability_at(true, 5.0f), probability_at(true, -30.0f));
  EXPECT_EQ(probability_at(false, 5.0f), probability_at(false, -30.0f));
  EXPECT_EQ(scan_->fields, scan_field::kRcs);
}

TEST_F(ChangedMethodTest, PassesOnlyLabelsToTheTracker) {
  ChangedMethod(config_, {}).classify(*scan_, *out_);
  EXPECT_GT(out_->ghost_probability(1), 0.0f);
  EXPECT_LT(out_->ghost_probability(1), 1.0f);
  const Provenance label = out_->provenance[1];
  ChangedMethod(config_, {.passes_probabilities = false}).classify(*scan_, *out_);
  EXPECT_EQ(out_->provenance[1], label);
  EXPECT_EQ(out_->ghost_probability(1), label == Provenance::kMoving ? 0.0f : 1.0f);
}

TEST_F(ChangedMethodTest, KeepsTracksFromTheMethod) {
  auto tracks = std::make_unique<TrackList>();
  ChangedMethod without(config_, {.gets_tracks = false}), with(config_, {});
  without.add_tracks(*tracks);
  without.classify(*scan_, *out_);
  EXPECT_NE(out_->flags & pipeline_flag::kNoTracks, 0u);
  with.add_tracks(*tracks);
  with.classify(*scan_, *out_);
  EXPECT_EQ(out_->flags & pipeline_flag::kNoTracks, 0u);
}

}  // namespace
}  // namespace boresight::bench
