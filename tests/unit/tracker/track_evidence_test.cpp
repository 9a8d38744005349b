// Evidence for classes of the tracks of a list, and the tracker that publishes it.
#include "services/tracker/core/classes/track_evidence.hpp"

#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/tracker/core/classes/classifying_tracker.hpp"

namespace boresight::tracking {
namespace {

constexpr std::int64_t kScan_ns = 50'000'000;

VehicleConfig one_radar() {
  VehicleConfig vehicle;
  RadarConfig& radar = vehicle.radars.emplace_back();
  radar.id = 1;
  radar.field_of_view.azimuth_min_rad = -1.0;
  radar.field_of_view.azimuth_max_rad = 1.0;
  radar.field_of_view.range_max_m = 100.0;
  return vehicle;
}

/// One tree that asks for the speed: slow objects are pedestrians, fast ones cars.
ObjectForest by_speed() {
  ObjectForest forest;
  forest.table.missing.assign(kClassFeatures, 0.0F);
  forest.table.trees = {0};
  ForestNode root;
  root.feature = static_cast<std::uint16_t>(ClassFeature::kSpeed);
  root.threshold = 4.0F;
  root.other = 2;
  ForestNode slow, fast;
  slow.other = 0;
  fast.other = 1;
  forest.table.nodes = {root, slow, fast};
  forest.table.leaves = {{0.9F, 0.1F, 0.0F, 0.0F, 0.0F}, {0.0F, 0.1F, 0.7F, 0.1F, 0.1F}};
  return forest;
}

class Scans {
 public:
  Scans() {
    scan->header.source_id = 1;
    scan->geometry.sensor_to_vehicle = {1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  }
  /// A track ahead with one detection.
  void show(std::uint32_t id, float x_m, float speed_mps) {
    Track& track = list->tracks[list->number_of_tracks++] = {};
    track.tracking_id = id;
    track.position_vehicle_m = {x_m, 0.0F, 0.0F};
    track.velocity_over_ground_mps = {speed_mps, 0.0F};
    track.length_m = 4.0F;
    track.width_m = 2.0F;
    const auto i = scan->number_of_valid_detections++;
    scan->x_vehicle_m[i] = scan->range_m[i] = x_m;
    scan->y_vehicle_m[i] = scan->azimuth_vehicle_rad[i] = 0.0F;
    scan->range_rate_over_ground_mps[i] = speed_mps;
    scan->detection_flags[i] = corrected_flag::kMoving;
    scan->provenance[i] = Provenance::kMoving;
  }
  void begin() {
    scan->header.measurement_time_ns += kScan_ns;
    scan->number_of_valid_detections = list->number_of_tracks = 0;
  }
  std::unique_ptr<ClassifiedScan> scan = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> list = std::make_unique<TrackList>();
};

TEST(TrackEvidence, IsKeptByIdentityAndForgottenWithTheTrack) {
  TrackEvidence evidence(one_radar(), by_speed());
  Scans s;
  for (int k = 0; k < 10; ++k) {
    s.begin();
    if (k % 2 == 0) {
      s.show(7, 20.0F, 10.0F);
      s.show(8, 40.0F, 1.0F);
    } else {
      s.show(8, 40.0F, 1.0F);
      s.show(7, 20.0F, 10.0F);
    }
    evidence.step(*s.scan, *s.list);
  }
  ASSERT_TRUE(evidence.find(7) != nullptr && evidence.find(8) != nullptr);
  const auto speed = static_cast<std::size_t>(ClassFeature::kSpeed);
  EXPECT_NEAR(evidence.find(7)->features()[speed], 10.0, 1e-6);
  EXPECT_NEAR(evidence.find(8)->features()[speed], 1.0, 1e-6);
  EXPECT_NEAR(evidence.find(7)->duration_s(), 0.45, 1e-6);
  s.begin();
  s.show(8, 40.0F, 1.0F);
  evidence.step(*s.scan, *s.list);
  EXPECT_EQ(evidence.find(7), nullptr);
}

TEST(TrackEvidence, ScanOfAnUnknownRadarChangesNothing) {
  TrackEvidence evidence(one_radar(), by_speed());
  Scans s;
  s.begin();
  s.show(7, 20.0F, 10.0F);
  evidence.step(*s.scan, *s.list);
  s.begin();
  s.scan->header.source_id = 9;
  evidence.step(*s.scan, *s.list);
  EXPECT_NE(evidence.find(7), nullptr);
}

TEST(TrackEvidence, DoesNotAllocate) {
  TrackEvidence evidence(one_radar(), by_speed());
  Scans s;
  const runtime::CountAllocations counting;
  const std::uint64_t before = runtime::counted_allocations();
  for (int k = 0; k < 20; ++k) {
    s.begin();
    for (std::uint32_t id = 1; id <= 40; ++id)
      s.show(id + static_cast<std::uint32_t>(k), static_cast<float>(id) * 2.0F, 5.0F);
    evidence.step(*s.scan, *s.list);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

/// States one list.
class Listed final : public MultiObjectTracker {
 public:
  explicit Listed(const TrackList& list) : list_(&list) {}
  StepResult step(const ClassifiedScan&) override { return {}; }
  void write(TrackList& out) const override { out = *list_; }

 private:
  const TrackList* list_;
};

TEST(ClassifyingTracker, PublishesTheForestsClassesAndNothingElseChanges) {
  Scans s;
  ClassifyingTracker tracker(std::make_unique<Listed>(*s.list), TrackEvidence(one_radar(), by_speed()));
  for (int k = 0; k < 10; ++k) {
    s.begin();
    s.show(7, 20.0F, 10.0F);
    s.show(8, 40.0F, 1.0F);
    tracker.step(*s.scan);
  }
  const auto out = std::make_unique<TrackList>();
  tracker.write(*out);
  ASSERT_EQ(out->number_of_tracks, 2u);
  EXPECT_EQ(out->tracks[0].object_class, ObjectClass::kCar);
  EXPECT_EQ(out->tracks[1].object_class, ObjectClass::kPedestrian);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const auto& p = out->tracks[k].class_probability;
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0F), 1.0F, 1e-5F);
    EXPECT_EQ(out->tracks[k].tracking_id, s.list->tracks[k].tracking_id);
    EXPECT_EQ(out->tracks[k].position_vehicle_m, s.list->tracks[k].position_vehicle_m);
  }
}

}  // namespace
}  // namespace boresight::tracking
