// Rows of the tables of a run folder: the message's values under the columns' names.
#include "services/boresight/run/rows.hpp"

#include <map>
#include <memory>

#include "tests/unit/run/drive_in_memory.hpp"

namespace boresight::run {
namespace {

/// A scan with two detections and a track, as it leaves the tracker.
class RowsOfAScan : public ::testing::Test {
 protected:
  RowsOfAScan() {
    scan_->header.source_id = 2;
    scan_->number_of_valid_detections = classified_->number_of_valid_detections = 2;
    classified_->provenance[0] = Provenance::kGhostType2;
    classified_->set_probabilities(0, {0.25F, 0.125F, 0.0625F, 0.5F, 0.03125F, 0.03125F});
    classified_->detection_flags[1] = corrected_flag::kWeak;
    tracks_->number_of_tracks = tracks_->number_of_confirmed_tracks = 1;
    tracks_->tracker_flags =
        tracker_flag::kWorkBudgetReached | tracker_flag::kCapacityReached | tracker_flag::kGatesCut;
    tracks_->likelihood_evaluations = 1234;
    Track& track = tracks_->tracks[0];
    track.tracking_id = 7;
    track.status = TrackStatus::kConfirmed;
    track.object_class = ObjectClass::kVan;
    track.existence_probability = 0.75F;
    track.mirror_probability = 0.125F;
    track.class_probability = {0.0F, 0.25F, 0.125F, 0.0F, 0.0F, 0.625F};
    track.flags = track_flag::kOutOfView | track_flag::kZeroDoppler;
    track.position_vehicle_m = {20.0F, -3.0F, 0.75F};
    // Row and column of an entry are its digits.
    for (std::size_t a = 0; a < kTrackStateSize; ++a) {
      for (std::size_t b = 0; b < kTrackStateSize; ++b) {
        track.covariance[a * kTrackStateSize + b] = static_cast<float>(10 * std::min(a, b) + std::max(a, b));
      }
    }
    track.covariance[4 * kTrackStateSize + 4] = 0.0625F;
    track.covariance[5 * kTrackStateSize + 5] = 0.25F;
    track.covariance[6 * kTrackStateSize + 6] = 0.015625F;
    result_.scan(ScanResult{{1'000'000'000, 0}, 3, *scan_, *classified_, *tracks_});
    files_.writer.flush();
  }
  [[nodiscard]] testing::Table rows(File file) const { return testing::table_of(files_.of(file)); }

  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::unique_ptr<ClassifiedScan> classified_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  testing::TextFiles files_;
  Listeners result_ = files_.listeners();
};

TEST_F(RowsOfAScan, StateTheProbabilityOfEveryOriginOfAClassifiedDetection) {
  const testing::Table detections = rows(File::kDetections);
  ASSERT_EQ(detections.size(), 2u);
  const std::map<std::string, std::string> expected = {{"p_moving", "0.25"},         {"p_stationary", "0.125"},
                                                       {"p_ghost_type_1", "0.0625"}, {"p_ghost_type_2", "0.5"},
                                                       {"p_clutter", "0.03125"},     {"p_ambiguity", "0.03125"}};
  for (const auto& [column, cell] : expected) {
    EXPECT_EQ(detections[0].at(column), cell) << column;
    EXPECT_EQ(detections[1].at(column), "") << column;
  }
  EXPECT_EQ(detections[0].at("origin"), "ghost_type_2");
  EXPECT_EQ(detections[1].at("rejected"), "weak");
}

TEST_F(RowsOfAScan, StateTheProbabilitiesAndTheUncertaintyOfATrack) {
  const testing::Table tracks = rows(File::kTracks);
  ASSERT_EQ(tracks.size(), 1u);
  const std::map<std::string, std::string> expected = {{"id", "7"},
                                                       {"class", "van"},
                                                       {"existence", "0.75"},
                                                       {"mirror_probability", "0.125"},
                                                       {"p_unknown", "0"},
                                                       {"p_car", "0.25"},
                                                       {"p_truck", "0.125"},
                                                       {"p_pedestrian", "0"},
                                                       {"p_van", "0.625"},
                                                       {"flags", "out_of_view+zero_doppler"},
                                                       {"x_vehicle_m", "20"},
                                                       {"heading_std_rad", "0.25"},
                                                       {"length_std_m", "0.5"},
                                                       {"width_std_m", "0.125"},
                                                       {"cov_x_x", "0"},
                                                       {"cov_x_vy", "3"},
                                                       {"cov_y_y", "11"},
                                                       {"cov_vx_vy", "23"},
                                                       {"cov_vy_vy", "33"}};
  for (const auto& [column, cell] : expected) EXPECT_EQ(tracks[0].at(column), cell) << column;
}

TEST_F(RowsOfAScan, StateTheWorkAndTheLimitsOfTheTracker) {
  const testing::Table scans = rows(File::kScans);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].at("tracker_flags"), "work_budget_reached+capacity_reached+gates_cut");
  EXPECT_EQ(scans[0].at("likelihood_evaluations"), "1234");
}

}  // namespace
}  // namespace boresight::run
