#include "services/tracker/core/classes/track_points.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::tracking {
namespace {

class PointsOfTracks : public testing::Test {
 protected:
  PointsOfTracks() { scan_->fields = scan_field::kRcs; }

  void detect(float x, float y, float range_rate_mps) {
    const auto i = scan_->number_of_valid_detections++;
    scan_->x_vehicle_m[i] = x;
    scan_->y_vehicle_m[i] = y;
    scan_->range_m[i] = std::hypot(x, y);
    scan_->azimuth_vehicle_rad[i] = std::atan2(y, x);
    scan_->range_rate_over_ground_mps[i] = range_rate_mps;
    scan_->detection_flags[i] = corrected_flag::kMoving;
    scan_->provenance[i] = Provenance::kMoving;
  }
  void track(float x, float y, float speed_mps) {
    Track& t = list_->tracks[list_->number_of_tracks++] = {};
    t.position_vehicle_m = {x, y, 0.0F};
    t.velocity_over_ground_mps = {speed_mps, 0.0F};
    t.length_m = 4.0F;
    t.width_m = 2.0F;
  }
  [[nodiscard]] std::vector<std::size_t> numbers() const {
    std::vector<std::size_t> of_tracks;
    TrackPoints points{{}};
    points.find(*scan_, 0, levels_, *list_);
    for (std::size_t k = 0; k < list_->number_of_tracks; ++k) of_tracks.push_back(points.of(k).size());
    return of_tracks;
  }
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> list_ = std::make_unique<TrackList>();
  RadarLevels levels_{1, {}};
};

TEST_F(PointsOfTracks, DetectionBelongsToTheNearestTrackThatMovesLikeIt) {
  track(20.0F, 0.0F, 10.0F);
  track(20.0F, 3.5F, 10.0F);
  track(60.0F, 0.0F, 10.0F);
  detect(18.0F, 0.5F, 10.0F);
  detect(22.5F, 0.9F, 9.8F);
  detect(20.0F, 3.2F, 10.0F);
  EXPECT_EQ(numbers(), (std::vector<std::size_t>{2, 1, 0}));
}

TEST_F(PointsOfTracks, DetectionOfAnotherRangeRateOrPlaceIsNoTracks) {
  track(20.0F, 0.0F, 10.0F);
  detect(20.0F, 0.0F, -10.0F);
  detect(30.0F, 0.0F, 10.0F);
  EXPECT_EQ(numbers(), (std::vector<std::size_t>{0}));
}

TEST_F(PointsOfTracks, StationaryAndRejectedDetectionsAreNoPoints) {
  track(20.0F, 0.0F, 10.0F);
  detect(20.0F, 0.0F, 10.0F);
  detect(20.0F, 0.0F, 10.0F);
  scan_->detection_flags[0] = corrected_flag::kStationary;
  scan_->provenance[1] = Provenance::kUnknown;
  EXPECT_EQ(numbers(), (std::vector<std::size_t>{0}));
}

TEST_F(PointsOfTracks, RotatedRadarHasInViewWhatItLooksAt) {
  track(0.0F, 20.0F, 5.0F);
  RadarConfig radar;
  radar.field_of_view.azimuth_min_rad = -0.8;
  radar.field_of_view.azimuth_max_rad = 0.8;
  radar.field_of_view.range_max_m = 100.0;
  scan_->geometry.sensor_to_vehicle = {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  EXPECT_EQ(observation_of(list_->tracks[0], *scan_, radar).in_view, 0.0);
  // Turned to the left by a quarter.
  scan_->geometry.sensor_to_vehicle = {0.0F, -1.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  EXPECT_EQ(observation_of(list_->tracks[0], *scan_, radar).in_view, 1.0);
  list_->tracks[0].flags = track_flag::kOccluded;
  EXPECT_EQ(observation_of(list_->tracks[0], *scan_, radar).in_view, 0.0);
}

}  // namespace
}  // namespace boresight::tracking
