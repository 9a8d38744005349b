#include "services/boresight/monitor/scan_record.hpp"

#include <memory>
#include <sstream>

namespace boresight::monitor {
namespace {

using Line = ScanRecordReader::Line;

class ScanRecord : public ::testing::Test {
 protected:
  void SetUp() override {
    scan_->header = {};
    scan_->header.source_id = 3;
    scan_->header.source_sequence = 17;
    scan_->header.measurement_time_ns = 123'456'789'012'345;
    scan_->flags = pipeline_flag::kNoTracks;
    scan_->geometry.sensor_position_vehicle_m = {3.6F, -0.7F, 0.5F};
    scan_->number_of_valid_detections = 7;
    for (std::size_t i = 0; i < 7; ++i) {
      scan_->x_vehicle_m[i] = 10.25F * static_cast<float>(i);
      scan_->y_vehicle_m[i] = -1.5F;
      scan_->range_rate_over_ground_mps[i] = -3.25F;
      scan_->ghost_probability[i] = 0.125F;
      scan_->provenance[i] = static_cast<Provenance>(std::min<std::size_t>(i, 5));
    }
    scan_->provenance[6] = Provenance::kUnknown;
    scan_->detection_flags[6] = corrected_flag::kOutsideRegion;
    scan_->x_vehicle_m[6] = NAN;
    scan_->number_of_reflector_segments = 1;
    scan_->reflector_segments[0] = {{1.0F, 2.0F}, {3.0F, 4.5F}, 0.1F, 9};
    tracks_->header.source_id = 3;
    tracks_->header.measurement_time_ns = 123'456'789'012'345;
    tracks_->number_of_tracks = 2;
    tracks_->tracks[0].tracking_id = 7;
    Track& second = tracks_->tracks[1];
    second.tracking_id = 8;
    second.status = TrackStatus::kConfirmed;
    second.movement = MovementState::kStopped;
    second.position_vehicle_m = {30.0F, -2.5F, 0.0F};
    second.heading_rad = 1.5F;
    second.length_m = 4.5F;
    second.width_m = 2.0F;
    second.number_of_detections = 6;
  }
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  std::unique_ptr<ClassifiedScan> read_scan_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> read_tracks_ = std::make_unique<TrackList>();
};

TEST_F(ScanRecord, IsReadAsItWasWritten) {
  std::stringstream record;
  write_scan(record, *scan_);
  write_tracks(record, *tracks_);
  ScanRecordReader reader(record, "scans.txt");
  ASSERT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kScan);
  EXPECT_EQ(read_scan_->header.source_id, 3u);
  EXPECT_EQ(read_scan_->header.source_sequence, 17u);
  EXPECT_EQ(read_scan_->header.measurement_time_ns, 123'456'789'012'345);
  EXPECT_EQ(read_scan_->flags, pipeline_flag::kNoTracks);
  EXPECT_EQ(read_scan_->geometry.sensor_position_vehicle_m, scan_->geometry.sensor_position_vehicle_m);
  ASSERT_EQ(read_scan_->number_of_valid_detections, 7u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(read_scan_->x_vehicle_m[i], scan_->x_vehicle_m[i]);
    EXPECT_EQ(read_scan_->y_vehicle_m[i], scan_->y_vehicle_m[i]);
    EXPECT_EQ(read_scan_->range_rate_over_ground_mps[i], -3.25F);
    EXPECT_EQ(read_scan_->ghost_probability[i], 0.125F);
    EXPECT_EQ(read_scan_->provenance[i], scan_->provenance[i]);
    EXPECT_EQ(read_scan_->detection_flags[i], 0u);
  }
  EXPECT_TRUE(std::isnan(read_scan_->x_vehicle_m[6]));
  EXPECT_EQ(read_scan_->detection_flags[6] & corrected_flag::kRejected, corrected_flag::kWeak);
  ASSERT_EQ(read_scan_->number_of_reflector_segments, 1u);
  EXPECT_EQ(read_scan_->reflector_segments[0].end_vehicle_m[1], 4.5F);
  ASSERT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kTracks);
  ASSERT_EQ(read_tracks_->number_of_confirmed_tracks, 1u) << "tentative ones are not recorded";
  const Track& track = read_tracks_->tracks[0];
  EXPECT_EQ(track.tracking_id, 8u);
  EXPECT_EQ(track.movement, MovementState::kStopped);
  EXPECT_EQ(track.position_vehicle_m, tracks_->tracks[1].position_vehicle_m);
  EXPECT_EQ(track.heading_rad, 1.5F);
  EXPECT_EQ(track.length_m, 4.5F);
  EXPECT_EQ(track.number_of_detections, 6u);
  EXPECT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kEnd);
}

TEST_F(ScanRecord, CutAnywhereYieldsTheWholeLines) {
  std::stringstream record;
  write_scan(record, *scan_);
  const std::size_t first = record.str().size();
  write_scan(record, *scan_);
  const std::string whole = record.str();
  for (std::size_t length = first; length < whole.size() - 1; ++length) {
    std::istringstream cut(whole.substr(0, length));
    ScanRecordReader reader(cut, "scans.txt");
    EXPECT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kScan);
    EXPECT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kEnd) << "cut after " << length;
    EXPECT_EQ(reader.damaged().count, length == first ? 0u : 1u) << "cut after " << length;
  }
}

TEST_F(ScanRecord, DamagedLinesAreCountedAndNoOtherLineIsLost) {
  std::istringstream record(
      "scan 1 1 1 0 0 0 0 4000000000 .\nscan 1 1 1 0 0 0 0 0 0 .\nscan 1 1 1 0 0 0 0 1 q 0 0 0 0 0 .\n\n"
      "scan 1 1 1 0 0 0 0 0 0 .\n");
  ScanRecordReader reader(record, "scans.txt");
  EXPECT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kScan);
  EXPECT_EQ(reader.damaged().count, 1u);
  EXPECT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kScan);
  EXPECT_EQ(read_scan_->number_of_valid_detections, 0u);
  EXPECT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kEnd);
  EXPECT_EQ(reader.damaged().count, 3u);
  EXPECT_EQ(reader.damaged().first,
            "scans.txt:1: number of detections is '4000000000', allowed: a whole number from 0 to 1024")
      << "the first is kept";
}

TEST_F(ScanRecord, DamagedLineIsReportedWithFieldAndAllowedValues) {
  struct {
    const char* line;
    const char* why;
  } const cases[] = {
      {"", "ends before kind of line"},
      {"something else", "kind of line is 'something', allowed: scan or tracks"},
      {"scan", "ends before source id"},
      {"scan -1 1 1 0 0 0 0 0 0 .", "source id is '-1', allowed: a whole number from 0 to 4294967295"},
      {"scan 1 1 1 0 0 north 0 0 0 .", "place of the sensor is 'north', allowed: a number"},
      {"scan 1 1 1 0 0 0 0 2 m 0 0 0 0 q 0 0 0 0 0 .", "label of detection 2 is 'q', allowed: a letter of ums12cx"},
      {"scan 1 1 1 0 0 0 0 2 m 0 0 0 0 u 0", "ends before y of detection 2"},
      {"scan 1 1 1 0 0 0 0 1 ms 0 0 0 0 0 .", "label of detection 1 is 'ms', allowed: a letter of ums12cx"},
      {"scan 1 1 1 0 0 0 0 0 65 .", "number of reflector segments is '65', allowed: a whole number from 0 to 64"},
      {"scan 1 1 1 0 0 0 0 0 1 0 0 0 1e .", "end of reflector segment 1 is '1e', allowed: a number"},
      {"scan 1 1 1 0 0 0 0 0 0 0.", "its end is '0.', allowed: '.'"},
      {"scan 1 1 1 0 0 0 0 0 0", "ends before its end"},
      {"scan 1 1 1 0 0 0 0 0 0 . x", "its end is ' x', allowed: '.'"},
      {"tracks 1 1 1 129 .", "number of tracks is '129', allowed: a whole number from 0 to 128"},
      {"tracks 1 1 1 1 8 4 0 0 0 4 2 6 .", "movement of track 1 is '4', allowed: a whole number from 0 to 3"},
      {"\x1b[2J\xff scan", "kind of line is '?[2J?', allowed: scan or tracks"},
      {"scans-of-a-radar-which-no-one-knows 1", "kind of line is 'scans-of-a-radar-which-n…', allowed: scan or tracks"},
  };
  for (const auto& [line, why] : cases) {
    std::istringstream record(std::string(line) + "\n");
    ScanRecordReader reader(record, "r");
    EXPECT_EQ(reader.next(*read_scan_, *read_tracks_), Line::kEnd) << line;
    EXPECT_EQ(reader.damaged().count, 1u) << line;
    EXPECT_EQ(reader.damaged().first, std::string("r:1: ") + why);
  }
}

}  // namespace
}  // namespace boresight::monitor
