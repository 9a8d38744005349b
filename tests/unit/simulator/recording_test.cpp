// The files of a drive agree with each other and with the drive: the gateway decodes the recordings to the measured
// scans, and the tables hold the truth of these scans.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/drive_writer.hpp"

namespace boresight::simulator {
namespace {

namespace fs = std::filesystem;

constexpr double kDuration_s = 6.0;
constexpr std::uint64_t kSeed = 4;

VehicleConfig demo_vehicle() {
  return config::read_vehicle_file(fs::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
}

/// A street with all effects on radars that a scenario can have.
Scenario disturbed() {
  Scenario s = scenario("city_canyon");
  s.effects.speed_scale = 1.01;
  s.effects.misalignment[3] = {0.02, -0.01, 0.005};
  s.effects.step_changes = {{1, 2.0, {0.03, 0.0, -0.01}}, {1, 4.0, {0.0, 0.02, 0.0}}};
  s.effects.blockages = {{2, 1.0, 4.0, 30.0, -3.2, 3.2}};
  s.effects.interference = {{4, 2.5, 1.0, 6.0, 15.0}};
  return s;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

using TableRow = std::map<std::string, std::string>;

/// A CSV table by its column names; every row must have all columns.
std::vector<TableRow> table_of(const fs::path& file) {
  std::istringstream lines(text_of(file));
  const auto cells_of = [](const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<TableRow> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), names.size()) << file << ": " << line;
    TableRow row;
    for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) row[names[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

double number(const TableRow& row, const std::string& column) {
  return std::stod(row.at(column));
}
/// Radar and number of a scan.
using ScanKey = std::pair<std::uint32_t, std::uint64_t>;
ScanKey scan_of(const TableRow& row) {
  return {static_cast<std::uint32_t>(std::stoul(row.at("radar"))), std::stoull(row.at("scan"))};
}

/// Keeps the messages of the gateway.
class Kept : public ingest::Sink {
 public:
  RadarScan* begin_scan() override { return (open_ = std::make_unique<RadarScan>()).get(); }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override {
    open_->header.measurement_time_ns = time.time_ns;
    scans[radar_id].push_back(std::move(open_));
    conditions[radar_id].push_back(statistics(radar_id).conditions);
  }
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const ingest::MeasurementTime&) override { egos.push_back(ego_); }
  void fault(Fault, std::string_view what, std::uint32_t) override { faults.emplace_back(what); }
  SourceStatistics& statistics(std::uint32_t radar_id) override { return statistics_[radar_id]; }

  std::map<std::uint32_t, std::vector<std::unique_ptr<RadarScan>>> scans;
  std::map<std::uint32_t, std::vector<std::uint32_t>> conditions;  // when the scan was published
  std::vector<EgoMotion> egos;
  std::vector<std::string> faults;

 private:
  std::unique_ptr<RadarScan> open_;
  EgoMotion ego_{};
  std::array<SourceStatistics, kMaxRadars + 1> statistics_{};
};

class Recording : public testing::Test {
 protected:
  static void SetUpTestSuite() { files_ = write(disturbed(), kSeed, "a"); }
  static void TearDownTestSuite() { fs::remove_all(folder()); }
  static fs::path folder() { return fs::temp_directory_path() / ("boresight-recording-" + std::to_string(::getpid())); }
  static DriveFiles write(const Scenario& scenario, std::uint64_t seed, const std::string& name) {
    return write_drive(scenario, demo_vehicle(), seed, kDuration_s, folder() / name, [](double) {});
  }
  static inline DriveFiles files_;
};

std::vector<fs::path> all(const DriveFiles& f) {
  return {f.radars, f.ego, f.truth, f.detections, f.objects, f.sensors, f.visibility};
}

TEST_F(Recording, TheSameSeedGivesTheSameBytesAndAnotherDoesNot) {
  const DriveFiles same = write(disturbed(), kSeed, "b"), other = write(disturbed(), kSeed + 1, "c");
  for (std::size_t i = 0; i < all(files_).size(); ++i) {
    const std::string text = text_of(all(files_)[i]);
    EXPECT_FALSE(text.empty());
    EXPECT_TRUE(text == text_of(all(same)[i])) << all(files_)[i];
    // The truth of the whole drive does not depend on the seed.
    if (all(files_)[i] == files_.truth) continue;
    EXPECT_FALSE(text == text_of(all(other)[i])) << all(files_)[i];
  }
}

TEST_F(Recording, TheGatewayReadsWhatWasMeasured) {
  Kept kept;
  const VehicleConfig vehicle = demo_vehicle();
  ingest::Gateway gateway(vehicle, kept);
  const auto reader = recording::open_recordings({files_.ego, files_.radars},
                                                 [](const std::string& problem) { ADD_FAILURE() << problem; });
  recording::Frame frame;
  while (reader->next(frame)) gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
  gateway.finish();
  for (const std::string& fault : kept.faults) ADD_FAILURE() << fault;

  Drive drive(disturbed(), vehicle, kSeed, kDuration_s);
  std::map<std::uint32_t, std::size_t> next;
  std::size_t detections = 0, ego = 0;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) {
      ++ego;
      continue;
    }
    const RadarScan& sent = *event->scan;
    const std::uint32_t id = sent.header.source_id;
    ASSERT_LT(next[id], kept.scans[id].size());
    const RadarScan& got = *kept.scans[id][next[id]++];
    ASSERT_EQ(got.header.measurement_time_ns, event->time_ns);
    ASSERT_EQ(got.number_of_valid_detections, sent.number_of_valid_detections);
    EXPECT_EQ(got.range_rate_min_mps, sent.range_rate_min_mps);
    EXPECT_EQ(got.range_rate_max_mps, sent.range_rate_max_mps);
    for (std::size_t i = 0; i < sent.number_of_valid_detections; ++i) {
      // These are 32-bit floats on the wire too: nothing is lost.
      ASSERT_EQ(got.range_m[i], sent.range_m[i]);
      ASSERT_EQ(got.azimuth_rad[i], sent.azimuth_rad[i]);
      ASSERT_EQ(got.elevation_rad[i], sent.elevation_rad[i]);
      ASSERT_EQ(got.range_rate_mps[i], sent.range_rate_mps[i]);
      ASSERT_EQ(got.range_std_m[i], sent.range_std_m[i]);
      ASSERT_EQ(got.azimuth_std_rad[i], sent.azimuth_std_rad[i]);
      ASSERT_EQ(got.elevation_std_rad[i], sent.elevation_std_rad[i]);
      ASSERT_EQ(got.range_rate_std_mps[i], sent.range_rate_std_mps[i]);
      ASSERT_NEAR(got.rcs_dbsm[i], sent.rcs_dbsm[i], 0.5);                              // whole dBsm
      ASSERT_NEAR(got.existence_probability[i], sent.existence_probability[i], 0.005);  // per cent
      ASSERT_EQ(got.detection_flags[i], 0u);
    }
    detections += got.number_of_valid_detections;
  }
  for (const auto& [id, scans] : kept.scans) EXPECT_EQ(next[id], scans.size());
  EXPECT_EQ(detections, files_.number_of_detections);
  EXPECT_GE(kept.egos.size() + 3, ego);
}

TEST_F(Recording, EgoSignalsAreThoseOfTheDriveWithinTheirQuantisation) {
  Kept kept;
  const VehicleConfig vehicle = demo_vehicle();
  ingest::Gateway gateway(vehicle, kept);
  const auto reader = recording::open_recordings({files_.ego}, [](const std::string&) {});
  recording::Frame frame;
  while (reader->next(frame)) gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
  gateway.finish();
  Drive drive(disturbed(), vehicle, kSeed, kDuration_s);
  std::vector<EgoSignals> signals;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) signals.push_back(event->ego);
  }
  ASSERT_EQ(kept.egos.size(), signals.size());
  for (std::size_t i = 0; i < signals.size(); ++i) {
    EXPECT_NEAR(kept.egos[i].speed_mps, signals[i].speed_mps, 0.01 / 3.6);
    EXPECT_NEAR(kept.egos[i].yaw_rate_radps, signals[i].yaw_rate_radps, 0.123 * M_PI / 180.0);
  }
}

TEST_F(Recording, OnlyTheBlockedRadarReportsBlockageOnTheWire) {
  Kept kept;
  const VehicleConfig vehicle = demo_vehicle();
  ingest::Gateway gateway(vehicle, kept);
  const auto reader = recording::open_recordings({files_.radars}, [](const std::string&) {});
  recording::Frame frame;
  while (reader->next(frame)) gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
  gateway.finish();
  for (const auto& [id, conditions] : kept.conditions) {
    for (std::size_t i = 1; i < conditions.size(); ++i) {
      // A scan's status message follows it, so it applies to the next scan. The loss grows to 30 dB by 4 s: it is 3 dB
      // at 1.3 s and 15 dB at 2.5 s.
      const double before_s =
          1e-9 * static_cast<double>(kept.scans[id][i - 1]->header.measurement_time_ns - Drive::kStart_ns);
      const std::uint32_t expected = id != 2 || before_s < 1.3 ? 0u
                                     : before_s < 2.5          ? source_condition::kPartlyBlocked
                                                               : source_condition::kBlocked;
      EXPECT_EQ(conditions[i], source_condition::kReported | expected) << "radar " << id << " after " << before_s;
    }
  }
}

TEST_F(Recording, TheTruthOfDetectionsIsThatOfTheDrive) {
  const std::vector<TableRow> rows = table_of(files_.detections);
  ASSERT_EQ(rows.size(), files_.number_of_detections);
  const std::map<std::string, Provenance> names = {{"moving", Provenance::kMoving},
                                                   {"stationary", Provenance::kStationary},
                                                   {"ghost_type_1", Provenance::kGhostType1},
                                                   {"ghost_type_2", Provenance::kGhostType2},
                                                   {"clutter", Provenance::kClutter}};
  Drive drive(disturbed(), demo_vehicle(), kSeed, kDuration_s);
  std::size_t at = 0;
  std::map<Provenance, std::size_t> kinds;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    ASSERT_EQ(event->truth->size(), event->scan->number_of_valid_detections);
    for (std::size_t i = 0; i < event->truth->size(); ++i, ++at) {
      const DetectionTruth& truth = (*event->truth)[i];
      const TableRow& row = rows.at(at);
      ASSERT_EQ(scan_of(row), ScanKey(event->scan->header.source_id, event->scan->header.source_sequence));
      ASSERT_EQ(row.at("index"), std::to_string(i));
      ASSERT_NEAR(number(row, "t_s"), event->t_s, 1e-6);
      ASSERT_EQ(names.at(row.at("provenance")), truth.provenance);
      ASSERT_EQ(row.at("object"), std::to_string(truth.object_id));
      ASSERT_EQ(row.at("bounces"), std::to_string(truth.bounces));
      ASSERT_EQ(row.at("mirror"), std::to_string(truth.mirror_body));
      const std::string& source = row.at("source");
      const bool false_one = truth.provenance == Provenance::kClutter;
      ASSERT_EQ(source == "body", truth.object_id != 0);
      ASSERT_EQ(source == "none", false_one);
      if (truth.object_id == 0 && !false_one) {
        ASSERT_EQ(truth.provenance, Provenance::kStationary);
        const bool structure = truth.origin.kind == Origin::Kind::kStructure;
        ASSERT_EQ(source, (structure ? "structure[" : "scatter[") + std::to_string(truth.origin.index) + "]");
        ASSERT_LT(truth.origin.index, structure ? drive.scenario().structures.size() : drive.scenario().scatter.size());
      }
      ++kinds[truth.provenance];
    }
  }
  EXPECT_EQ(at, rows.size());
  for (const auto& [name, kind] : names) EXPECT_GT(kinds[kind], 20u) << name;
}

TEST_F(Recording, TheTruthOfSensorsHasMountingBlockageInterferenceAndCountsOfEachScan) {
  const std::vector<TableRow> rows = table_of(files_.sensors);
  ASSERT_EQ(rows.size(), files_.scans);
  std::size_t detections = 0;
  for (const TableRow& row : rows) {
    const double t = number(row, "t_s");
    const std::string& id = row.at("radar");
    const bool first = id == "1" && t >= 2.0, second = id == "1" && t >= 4.0;
    EXPECT_NEAR(number(row, "alignment_yaw_deg"), ((id == "3" ? 0.02 : 0.0) + (first ? 0.03 : 0.0)) * kDegreesPerRadian,
                1e-5);
    EXPECT_NEAR(number(row, "alignment_pitch_deg"),
                ((id == "3" ? -0.01 : 0.0) + (second ? 0.02 : 0.0)) * kDegreesPerRadian, 1e-5);
    EXPECT_NEAR(number(row, "alignment_roll_deg"),
                ((id == "3" ? 0.005 : 0.0) + (first ? -0.01 : 0.0)) * kDegreesPerRadian, 1e-5);
    EXPECT_EQ(number(row, "step_changes"), (first ? 1.0 : 0.0) + (second ? 1.0 : 0.0));
    const double blockage_db = id == "2" ? 10.0 * std::clamp(t - 1.0, 0.0, 3.0) : 0.0;
    EXPECT_NEAR(number(row, "blockage_max_db"), blockage_db, 1e-3);
    EXPECT_NEAR(number(row, "blockage_mean_db"), blockage_db, 1e-3);
    EXPECT_EQ(row.at("stated"), blockage_db < 3.0 ? "clear" : blockage_db < 15.0 ? "partly_blocked" : "blocked");
    const bool disturbed = id == "4" && t >= 2.5 && t < 3.5;
    EXPECT_EQ(number(row, "noise_rise_db"), disturbed ? 6.0 : 0.0);
    EXPECT_EQ(number(row, "interference_per_scan"), disturbed ? 15.0 : 0.0);
    double sum = 0.0;
    for (const char* kind : {"moving", "stationary", "ghost_type_1", "ghost_type_2", "clutter"}) {
      sum += number(row, kind);
    }
    EXPECT_EQ(sum, number(row, "detections"));
    detections += static_cast<std::size_t>(sum);
  }
  EXPECT_EQ(detections, files_.number_of_detections);
}

TEST_F(Recording, TheTruthOfVisibilityAgreesWithDetectionsAndObjects) {
  std::map<std::pair<ScanKey, std::string>, std::array<double, 3>>
      counted;  // by scan and object: direct, types 1 and 2
  for (const TableRow& row : table_of(files_.detections)) {
    if (row.at("object") == "0") continue;
    const std::string& kind = row.at("provenance");
    ++counted[{scan_of(row), row.at("object")}].at(kind == "ghost_type_1" ? 1 : kind == "ghost_type_2" ? 2 : 0);
  }
  std::map<std::string, std::size_t> states;
  const std::vector<TableRow> rows = table_of(files_.visibility);
  for (const TableRow& row : rows) {
    const double centres = number(row, "centres"), in_view = number(row, "in_view"), seen = number(row, "seen");
    EXPECT_LE(in_view, centres);
    EXPECT_LE(seen, in_view);
    EXPECT_EQ(row.at("state"), seen > 0 ? "seen" : in_view > 0 ? "occluded" : "outside");
    ++states[row.at("state")];
    const auto found = counted.find({scan_of(row), row.at("object")});
    const std::array<double, 3> none{};
    const std::array<double, 3>& n = found == counted.end() ? none : found->second;
    EXPECT_EQ(number(row, "direct"), n[0]);
    EXPECT_EQ(number(row, "ghost_type_1"), n[1]);
    EXPECT_EQ(number(row, "ghost_type_2"), n[2]);
    if (found != counted.end()) counted.erase(found);
  }
  EXPECT_TRUE(counted.empty()) << counted.size() << " objects were detected but have no row";
  EXPECT_GT(states["seen"], 500u);
  EXPECT_GT(states["occluded"], 500u);
}

TEST_F(Recording, TheTruthOfObjectsIsThatOfTheWorld) {
  const Drive drive(disturbed(), demo_vehicle(), kSeed, kDuration_s);
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < drive.world().number_of_bodies(); ++i) {
    index[std::to_string(drive.world().body(i, 0.0).id)] = i;
  }
  EXPECT_EQ(index.size(), drive.world().number_of_bodies()) << "ids are unique";
  std::map<std::string, std::size_t> kinds;
  for (const TableRow& row : table_of(files_.objects)) {
    const double t = number(row, "t_s");
    const Body body = drive.world().body(index.at(row.at("object")), t);
    const EgoState ego = drive.ego(t);
    const Eigen::Vector2d d = body.position_m - ego.position_m;
    EXPECT_NEAR(std::hypot(number(row, "x_vehicle_m"), number(row, "y_vehicle_m")), d.norm(), 2e-3);
    EXPECT_NEAR(std::remainder(std::atan2(number(row, "y_vehicle_m"), number(row, "x_vehicle_m")) + ego.heading_rad -
                                   std::atan2(d.y(), d.x()),
                               2.0 * M_PI) *
                    d.norm(),
                0.0, 2e-3);
    EXPECT_NEAR(std::hypot(number(row, "vx_over_ground_mps"), number(row, "vy_over_ground_mps")),
                body.velocity_mps.norm(), 2e-3);
    ++kinds[row.at("kind")];
  }
  for (const char* kind : {"car", "van", "pedestrian", "cyclist"}) EXPECT_GT(kinds[kind], 20u) << kind;
}

TEST(DriveWriter, RefusesUnsupportedVehiclesAndUnwritableFolders) {
  const fs::path folder = fs::temp_directory_path() / ("boresight-refused-" + std::to_string(::getpid()));
  const auto problem = [&](const Scenario& scenario, const VehicleConfig& vehicle) -> std::string {
    try {
      write_drive(scenario, vehicle, 1, 0.1, folder, [](double) {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  Scenario s = scenario("tunnel");
  s.effects.step_changes = {{9, 1.0, {}}};
  EXPECT_EQ(problem(s, demo_vehicle()),
            "radars.step_change.radar: 9 is no radar of the vehicle demo; allowed: 1, 2, 3, 4");
  VehicleConfig other = demo_vehicle();
  other.radars[1].profile = RadarProfile::kArs408;
  EXPECT_NE(problem(scenario("tunnel"), other).find("front_right"), std::string::npos);
  other = demo_vehicle();
  other.radars[2].e2e.required = true;
  EXPECT_NE(problem(scenario("tunnel"), other).find("rear_left"), std::string::npos);
  other = demo_vehicle();
  other.ego.profile = EgoProfile::kMapping;
  EXPECT_NE(problem(scenario("tunnel"), other).find("Toyota"), std::string::npos);
  other = demo_vehicle();
  other.radars[0].source.sender.clear();
  EXPECT_NE(problem(scenario("tunnel"), other).find("sender"), std::string::npos);
  other.radars.clear();
  EXPECT_NE(problem(scenario("tunnel"), other).find("no radar"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder)) << "nothing is written for a wrong scenario";
  EXPECT_THROW(write_drive(scenario("tunnel"), demo_vehicle(), 1, 0.1, "/proc/nowhere", [](double) {}),
               std::runtime_error);
}

}  // namespace
}  // namespace boresight::simulator
