// Tables of any data set: the same rows as from the recording, and exactly the documented columns.
#include <array>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "services/boresight/decode/csv.hpp"
#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "services/boresight/run/rows.hpp"
#include "services/boresight/run/table_feed.hpp"
#include "tests/unit/run/drive_in_memory.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::run {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string page_of(const std::string& name) {
  return schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/" + name);
}

/// The tables that `boresight decode` writes.
class TableSink : public ingest::Sink {
 public:
  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(std::uint32_t radar, const ingest::MeasurementTime& time) override {
    empty_scans += scan_->number_of_valid_detections == 0 ? 1 : 0;
    decode::append_detections(detections, *scan_, radar, time);
  }
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const ingest::MeasurementTime& time) override { decode::append_ego(motions, ego_, time); }
  void fault(Fault, std::string_view, std::uint32_t) override {}
  SourceStatistics& statistics(std::uint32_t) override { return statistics_; }

  std::string detections{decode::detection_header()}, motions{decode::ego_header()};
  std::size_t empty_scans = 0;

 private:
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  EgoMotion ego_{};
  SourceStatistics statistics_{};
};

class RunTables : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    return folder_.path() / name;
  }

  struct Played {
    testing::TextFiles files;
    std::vector<std::string> problems;
    std::vector<std::string> ignored;
    std::uint64_t scans = 0;
    std::int64_t start_ns = 0;
  };
  void play(const std::string& detections, const std::string& motions, const VehicleConfig& vehicle,
            Played& played) const {
    input::Problems problems([&](const std::string& text) { played.problems.push_back(text); });
    recording::ByteSource drive_source(write("detections.csv", detections)), ego_source(write("ego.csv", motions));
    input::DriveReader drive(drive_source, vehicle, problems);
    input::EgoReader ego(ego_source, vehicle.ego, problems);
    const auto chain = std::make_unique<Chain>(vehicle, Settings{}, played.files.listeners());
    TableFeed feed(drive, ego, *chain);
    while (feed.next()) {
    }
    chain->finish();
    played.files.writer.flush();
    for (const RadarCounts& radar : chain->counts().radars) played.scans += radar.scans;
    played.start_ns = chain->start_ns();
    played.ignored = drive.ignored_columns();
  }

  testing::TemporaryFolder folder_{"tables"};
};

constexpr std::array kTableFiles = {File::kScans,     File::kDetections,        File::kReflectors, File::kTracks,
                                    File::kRoadEdges, File::kCollisionWarnings, File::kAlignment};

/// Plays recordings through the chain.
void play_recordings(const std::vector<std::filesystem::path>& recordings, const VehicleConfig& vehicle,
                     testing::TextFiles& rows) {
  const auto chain = std::make_unique<Chain>(vehicle, Settings{}, rows.listeners());
  GatewayFeed feed(*chain);
  testing::play(recordings, vehicle, *chain, feed);
  rows.writer.flush();
}

void decode_recordings(const std::vector<std::filesystem::path>& recordings, const VehicleConfig& vehicle,
                       TableSink& tables) {
  const auto reader = recording::open_recordings(recordings, [](const std::string&) {});
  ingest::Gateway gateway(vehicle, tables);
  recording::Frame frame;
  while (reader->next(frame)) gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
  gateway.finish();
  ASSERT_EQ(tables.empty_scans, 0u) << "a table cannot hold them";
}

TEST_F(RunTables, GiveTheRowsOfTheRecordingThatTheyWereDecodedFrom) {
  const VehicleConfig vehicle = testing::demo_vehicle();
  const std::vector<std::filesystem::path> recordings = {testing::demo_drive().ego, testing::demo_drive().radars};
  testing::TextFiles recorded;
  play_recordings(recordings, vehicle, recorded);
  TableSink tables;
  decode_recordings(recordings, vehicle, tables);
  Played played;
  play(tables.detections, tables.motions, vehicle, played);
  EXPECT_THAT(played.problems, IsEmpty());
  EXPECT_THAT(played.ignored, ElementsAre("\"cycle\"", "\"index\"", "\"time_source\"", "\"integrity\""));
  EXPECT_GT(recorded.of(File::kDetections).size(), 100'000u);
  for (const File file : kTableFiles) {
    EXPECT_TRUE(recorded.of(file) == played.files.of(file)) << kFileNames[static_cast<std::size_t>(file)];
  }
}

TEST_F(RunTables, GiveTheRowsOfTheRecordingIfRangeRatesExceedTheUnambiguousInterval) {
  const VehicleConfig vehicle = testing::demo_vehicle();
  simulator::Scenario scenario = simulator::scenario("demo_drive");
  scenario.effects.unambiguous_mps = 6.0;  // the vehicle drives faster
  const simulator::DriveFiles drive =
      simulator::write_drive(scenario, vehicle, 42, 4.0, folder_.path() / "drive", [](double) {});
  const std::vector<std::filesystem::path> recordings = {drive.ego, drive.radars};
  testing::TextFiles recorded;
  play_recordings(recordings, vehicle, recorded);
  TableSink tables;
  decode_recordings(recordings, vehicle, tables);
  Played played;
  play(tables.detections, tables.motions, vehicle, played);
  for (const File file : kTableFiles) {
    EXPECT_TRUE(recorded.of(file) == played.files.of(file)) << kFileNames[static_cast<std::size_t>(file)];
  }
  // Without the interval the estimator cannot use folded range rates, and the results differ.
  std::string unnamed = tables.detections;
  const std::string column = "range_rate_max_mps";
  unnamed.replace(unnamed.find(column), column.size(), "unnamed");
  Played without_interval;
  play(unnamed, tables.motions, vehicle, without_interval);
  EXPECT_FALSE(recorded.of(File::kDetections) == without_interval.files.of(File::kDetections));
}

TEST_F(RunTables, MayBeginAtTimeZero) {
  Played played;
  play("t_s,radar,range_m,azimuth_rad,range_rate_mps,valid\n0,1,20,0.1,-9.9,1\n0.05,1,19.5,0.1,-9.9,0\n",
       "t_s,speed_mps,yaw_rate_radps\n0,10,0\n0.05,10,0\n0.1,10,0\n", testing::demo_vehicle(), played);
  EXPECT_EQ(played.scans, 2u);
  EXPECT_EQ(played.start_ns, 0);
  const testing::Table rows = testing::table_of(played.files.of(File::kDetections));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].at("t_s"), "0.050000");
  EXPECT_EQ(rows[1].at("time_ns"), "50000000");
  EXPECT_EQ(rows[0].at("rejected"), "");
  EXPECT_EQ(rows[1].at("rejected"), "") << "what the sensor calls invalid is evidence for the ghost filter";
  EXPECT_NE(rows[1].at("origin"), "unknown");
  EXPECT_EQ(rows[0].at("elevation_rad"), "");
  EXPECT_EQ(rows[0].at("rcs_dbsm"), "");
  EXPECT_NE(rows[0].at("range_rate_over_ground_mps"), "");
}

TEST_F(RunTables, AreReadWithTheNamesOfDecodeAndOfAlign) {
  Played decoded, aligned;
  play("time_s,radar,cycle,range_m,azimuth_rad,elevation_rad,range_rate_mps,flags\n1,1,5,20,0.1,0,-1,ambiguous\n",
       "time_s,speed_mps,yaw_rate_radps\n1,10,0\n", testing::demo_vehicle(), decoded);
  play("t,radar,range,az,el,vr,ambiguous,cycle\n1,1,20,0.1,0,-1,1,5\n", "t,v,yaw_rate\n1,10,0\n",
       testing::demo_vehicle(), aligned);
  EXPECT_THAT(decoded.problems, IsEmpty());
  EXPECT_THAT(decoded.ignored, ElementsAre("\"cycle\""));
  EXPECT_EQ(decoded.files.of(File::kDetections), aligned.files.of(File::kDetections));
  EXPECT_EQ(testing::table_of(decoded.files.of(File::kDetections)).size(), 1u);
}

TEST_F(RunTables, SkipLinesThatCannotBeRead) {
  Played played;
  play(
      "t_s,radar,range_m,azimuth_rad,range_rate_mps,flags\n5,1,20,0.1,-1,\n5.05,7,20,0.1,-1,\n5.1,1,x,0.1,-1,\n"
      "5.15,1,20,0.1,-1,odd\n3,1,20,0.1,-1,\n",
      "t_s,speed_mps,yaw_rate_radps\n5,10,0\n", testing::demo_vehicle(), played);
  EXPECT_EQ(played.scans, 1u);
  EXPECT_THAT(played.problems,
              ElementsAre(HasSubstr("detections.csv:3:6: radar: radar 7 is not in the vehicle file"),
                          HasSubstr("detections.csv:4:7: range_m: read \"x\", allowed is a number -100 … 100000 m"),
                          HasSubstr("detections.csv:5:18: flags: read \"odd\", allowed is nothing or one of invalid"),
                          HasSubstr("detections.csv:6:1: t_s: read 3 s after 5 s")));
}

TEST(RunTableTimes, KeepEveryNanosecond) {
  const auto exact = [](const std::string& text) { return input::nanoseconds_of(text, std::stod(text)); };
  EXPECT_EQ(exact("1700000000.123456789"), 1'700'000'000'123'456'789);
  EXPECT_EQ(exact("-1.5"), -1'500'000'000);
  EXPECT_EQ(exact("+2"), 2'000'000'000);
  EXPECT_EQ(exact(".25"), 250'000'000);
  EXPECT_EQ(exact("1e-3"), 1'000'000);
  EXPECT_EQ(exact("0.12345678951"), 123'456'790);
  EXPECT_EQ(exact("-0.000000001"), -1);
}

TEST_F(RunTables, HaveExactlyTheDocumentedColumnsAndRanges) {
  const auto sections = schema_page::sections(page_of("tables.md"));
  for (const char* const section : {"Detections", "Ego motions"}) {
    const bool is_ego = std::string(section) == "Ego motions";
    struct Documented {
      std::string name;
      bool is_required;
      std::optional<std::pair<double, double>> range;
    };
    std::vector<Documented> columns;
    for (const auto& cells : sections.at(section)) {
      if (schema_page::code(cells.at(0)).empty()) continue;
      columns.push_back({schema_page::code(cells.at(0)), cells.at(1) == "yes", schema_page::bounds(cells.at(2))});
    }
    ASSERT_GE(columns.size(), is_ego ? 3u : 15u);
    std::string header;
    for (const Documented& column : columns) header += (header.empty() ? "" : ",") + column.name;
    for (const Documented& left_out : columns) {
      std::string others;
      for (const Documented& column : columns) {
        if (column.name != left_out.name) others += (others.empty() ? "" : ",") + column.name;
      }
      const auto read = [&] {
        Played played;
        play(is_ego ? "t_s,radar,range_m,azimuth_rad,range_rate_mps\n" : others + "\n",
             is_ego ? others + "\n" : "t_s,speed_mps,yaw_rate_radps\n", testing::demo_vehicle(), played);
      };
      if (left_out.is_required) {
        EXPECT_THROW(read(), input::TableError) << left_out.name;
      } else {
        EXPECT_NO_THROW(read()) << left_out.name;
      }
    }
    // One row in which one column has this value; true if the row is read.
    const auto reads = [&](const std::string& changed, const std::string& value) {
      std::string row;
      for (const Documented& column : columns) {
        row += row.empty() ? "" : ",";
        row += column.name == changed ? value : column.name == "radar" ? "1" : column.name == "flags" ? "" : "0";
      }
      const std::string detections = "t_s,radar,range_m,azimuth_rad,range_rate_mps\n1,1,9,0,0\n";
      const std::string motions = "t_s,speed_mps,yaw_rate_radps\n1,1,0\n";
      Played played;
      play(is_ego ? detections : header + "\n" + row + "\n", is_ego ? header + "\n" + row + "\n" : motions,
           testing::demo_vehicle(), played);
      EXPECT_THAT(played.ignored, IsEmpty());
      return played.problems.empty();
    };
    EXPECT_TRUE(reads("", "")) << section;
    for (const Documented& column : columns) {
      if (!column.range || column.name == "radar") continue;
      // Documented to four digits.
      const auto& [low, high] = *column.range;
      EXPECT_TRUE(reads(column.name, fmt::format("{}", 0.9999 * high))) << column.name;
      EXPECT_FALSE(reads(column.name, fmt::format("{}", 1.0001 * high + 1e-3))) << column.name;
      EXPECT_FALSE(reads(column.name, fmt::format("{}", 1.0001 * low - 1e-3))) << column.name;
    }
  }
}

TEST(RunPages, DescribeExactlyTheColumnsThatAreWritten) {
  const auto sections = schema_page::sections(page_of("run.md"));
  const std::map<std::string, std::string_view> headers = {
      {"scans.csv", kScansHeader},           {"detections.csv", kDetectionsHeader},
      {"reflectors.csv", kReflectorsHeader}, {"tracks.csv", kTracksHeader},
      {"road_edges.csv", kRoadEdgesHeader},  {"collision_warnings.csv", kCollisionWarningsHeader},
      {"alignment.csv", kAlignmentHeader}};
  for (const auto& [file, header] : headers) {
    ASSERT_TRUE(sections.contains(file)) << file;
    std::string documented;
    for (const auto& cells : sections.at(file)) {
      const std::string name = schema_page::code(cells.at(0));
      if (!name.empty()) documented += (documented.empty() ? "" : ",") + name;
    }
    EXPECT_EQ(documented, header) << file;
  }
}

}  // namespace
}  // namespace boresight::run
