#include <memory>
#include <sstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "tests/unit/align/tables.hpp"

namespace boresight::input {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

VehicleConfig vehicle_of(std::initializer_list<std::uint32_t> ids) {
  VehicleConfig vehicle;
  for (const std::uint32_t id : ids) {
    RadarConfig radar;
    radar.id = id;
    radar.name = std::to_string(id);
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

struct Read {
  struct Scan {
    double time_s;
    std::uint32_t radar, count, fields;
    std::vector<float> range_rates, elevations, azimuth_stds;
    std::vector<std::uint16_t> flags;
  };
  std::vector<Scan> scans;
  std::vector<std::string> reported, ignored;
  std::uint64_t bad = 0, lines = 0, dropped = 0;
  std::map<std::uint32_t, std::uint64_t> unknown;
  std::string error;
};

class Tables : public ::testing::Test {
 protected:
  std::filesystem::path file_ = std::filesystem::temp_directory_path() / ("input_csv." + std::to_string(getpid()));
  void TearDown() override { std::filesystem::remove(file_); }

  Read drive(const std::string& text, std::initializer_list<std::uint32_t> ids = {1, 2}) {
    align::testing::write_text(file_, text);
    Read read;
    Problems problems([&](const std::string& problem) { read.reported.push_back(problem); });
    const VehicleConfig vehicle = vehicle_of(ids);
    try {
      recording::ByteSource source(file_);
      DriveReader reader(source, vehicle, problems);
      const auto scan = std::make_unique<RadarScan>();
      for (double time_s = 0.0; reader.next(*scan, time_s);) {
        Read::Scan& s = read.scans.emplace_back();
        s = {time_s, scan->header.source_id, scan->number_of_valid_detections, scan->fields, {}, {}, {}, {}};
        for (std::size_t i = 0; i < s.count; ++i) {
          s.range_rates.push_back(scan->range_rate_mps[i]);
          s.elevations.push_back(scan->elevation_rad[i]);
          s.azimuth_stds.push_back(scan->azimuth_std_rad[i]);
          s.flags.push_back(scan->detection_flags[i]);
        }
      }
      read.ignored = reader.ignored_columns();
      read.dropped = reader.dropped_detections();
      read.unknown = reader.unknown_radars();
    } catch (const TableError& error) {
      read.error = error.what();
    }
    read.bad = problems.bad_lines();
    read.lines = problems.lines();
    return read;
  }
  /// A drive with that row between two good ones; the report on it without the file's name.
  std::string report_on(const std::string& row) {
    const Read read = drive("t,radar,range,az,el,vr\n0,1,9,0.1,0,-1\n" + row + "\n0.1,1,9,0.1,0,-2\n");
    EXPECT_EQ(read.scans.size(), 2u) << "the rows about it are kept";
    EXPECT_EQ(read.bad, 1u);
    return read.reported.size() == 1 ? read.reported[0].substr(file_.string().size()) : "";
  }
};

TEST_F(Tables, RowsOfOneTimeAndRadarAreAScan) {
  const Read read = drive(
      "t,radar,range,az,el,vr,is_stationary\n0.00,1,9,0.1,0.01,-1,1\n0.00,1,9,0.1,0.02,-2,0\n0.00,2,9,0.1,0.03,-3,1\n"
      "0.05,2,9,0.1,0.04,-4,1\n");
  ASSERT_EQ(read.scans.size(), 3u);
  EXPECT_EQ(read.scans[0].radar, 1u);
  EXPECT_THAT(read.scans[0].range_rates, ElementsAre(-1.0F, -2.0F));
  EXPECT_THAT(read.scans[0].elevations, ElementsAre(0.01F, 0.02F));
  EXPECT_EQ(read.scans[0].fields, scan_field::kElevation);
  EXPECT_EQ(read.scans[1].radar, 2u);
  EXPECT_EQ(read.scans[2].time_s, 0.05);
  EXPECT_EQ(read.lines, 4u);
  EXPECT_THAT(read.ignored, ElementsAre()) << "the truth needs no mention";
}

TEST_F(Tables, ColumnsAreFoundByNameAndUnknownOnesNamed) {
  const Read read = drive("\xEF\xBB\xBFvr, az ,snr,radar,t,range\r\n-3,0.5,99,2,1.5,7\r\n-4,0.5,,2,1.5,7");
  ASSERT_EQ(read.scans.size(), 1u) << "CR LF, a byte order mark, and no end of the last line";
  EXPECT_THAT(read.scans[0].range_rates, ElementsAre(-3.0F, -4.0F));
  EXPECT_EQ(read.scans[0].fields, 0u) << "no elevation";
  EXPECT_THAT(read.ignored, ElementsAre("\"snr\""));
}

TEST_F(Tables, ElevationMayBeMissingOfAllOrSomeDetections) {
  const Read read = drive("t,radar,range,az,el,vr\n0,1,9,0,,-1\n0,1,9,0,nan,-1\n0,2,9,0,,-1\n0,2,9,0,0.1,-1\n");
  ASSERT_EQ(read.scans.size(), 2u);
  EXPECT_EQ(read.scans[0].fields, 0u);
  EXPECT_THAT(read.scans[0].flags, ElementsAre(0, 0));
  EXPECT_EQ(read.scans[1].fields, scan_field::kElevation);
  EXPECT_THAT(read.scans[1].flags, ElementsAre(detection_flag::kUnusable, 0)) << "0 would be a wrong elevation";
}

TEST_F(Tables, StatedStdsAndAmbiguityAreTakenOver) {
  const Read read = drive("t,radar,range,az,vr,az_std,vr_min,vr_max\n0,1,9,0,-1,0.01,-20,20\n0,1,9,0,-1,,-20,20\n");
  ASSERT_EQ(read.scans.size(), 1u);
  EXPECT_EQ(read.scans[0].fields, scan_field::kStds | scan_field::kAmbiguity);
  EXPECT_THAT(read.scans[0].azimuth_stds, ElementsAre(0.01F, 0.0F)) << "0: not stated";
}

TEST_F(Tables, BadRowsAreReportedByPlaceAndReasonAndSkipped) {
  EXPECT_EQ(report_on("0.05,1,9,0.1,0,fast"), ":3:16: vr: read \"fast\", allowed is a number -500 … 500 m/s");
  EXPECT_THAT(report_on("0.05,1,9,0.1,0,"), HasSubstr("3:16: vr: read \"\""));
  EXPECT_THAT(report_on("0.05,1,9,0.1,0,nan"), HasSubstr("vr: read \"nan\""));
  EXPECT_THAT(report_on("0.05,1,9,0.1,0,inf"), HasSubstr("vr: read \"inf\""));
  EXPECT_THAT(report_on("0.05,1,9,0.1,inf,1"), HasSubstr("el: read \"inf\""));
  EXPECT_THAT(report_on("0.05,1,9,0.1,0,1e999"), HasSubstr("vr: read \"1e999\""));
  EXPECT_THAT(report_on("0.05,1,9,45.0,0,1"),
              HasSubstr("3:10: az: read \"45.0\", allowed is a number -3.14159 … 3.14159 rad"));
  EXPECT_THAT(report_on("0.05,1,9,0.1,2,1"), HasSubstr("or nothing"));
  EXPECT_THAT(report_on("0.05,17,9,0.1,0,1"), HasSubstr("radar: read \"17\", allowed is a number 1 … 16"));
  EXPECT_THAT(report_on("0.05,1.5,9,0.1,0,1"), HasSubstr("allowed is a whole number 1 … 16"));
  EXPECT_THAT(report_on("0.05,3,9,0.1,0,1"), HasSubstr("radar 3 is not in the vehicle file, which has 1, 2"));
  EXPECT_THAT(report_on("1.7e18,1,9,0.1,0,1"), HasSubstr("t: read"));
  EXPECT_THAT(report_on("0.05,1,9"), HasSubstr("has 3 columns, the header has 6"));
  EXPECT_THAT(report_on("0.05,1,9,0.1,0,1,7"), HasSubstr("has 7 columns, the header has 6"));
  EXPECT_THAT(report_on("0.05,1,9,0.1,0,1x"), HasSubstr("vr: read \"1x\""));
  EXPECT_THAT(report_on(std::string("0.05,1,9,0.1,0,\x1b[31m")), HasSubstr("\"?[31m\"")) << "nothing upsets a terminal";
  EXPECT_THAT(report_on(std::string(6000, '7')), HasSubstr("longer than 4096 characters"));
  EXPECT_THAT(report_on(std::string("\0\0,1", 4)), HasSubstr("t: read \"??\""));
}

TEST_F(Tables, NumbersOfEveryWritingAreRead) {
  const Read read = drive("t,radar,range,az,el,vr\n +1e0, 1 ,9.,-.5,1e-400,+2.5E0\n");
  ASSERT_EQ(read.scans.size(), 1u);
  EXPECT_EQ(read.scans[0].time_s, 1.0);
  EXPECT_THAT(read.scans[0].range_rates, ElementsAre(2.5F));
}

TEST_F(Tables, TimesMayGoBackByASecondAndForwardByAnHour) {
  const std::string header = "t,radar,range,az,vr\n";
  EXPECT_EQ(drive(header + "10,1,9,0,1\n9.1,2,9,0,1\n10.05,1,9,0,1\n").bad, 0u) << "radars are not synchronised";
  EXPECT_THAT(drive(header + "10,1,9,0,1\n8.9,2,9,0,1\n").reported[0], HasSubstr("read 8.9 s after 10 s"));
  const Read spike = drive(header + "10,1,9,0,1\n99999,1,9,0,1\n10.05,1,9,0,1\n10.1,1,9,0,1\n");
  EXPECT_EQ(spike.bad, 1u) << "a single wrong time must not make all that follow wrong";
  EXPECT_EQ(spike.scans.size(), 3u);
  const Read parked = drive(header + "10,1,9,0,1\n99999,1,9,0,1\n99999.05,1,9,0,1\n99999.1,1,9,0,1\n");
  EXPECT_EQ(parked.bad, 1u) << "the line that has to be confirmed";
  EXPECT_EQ(parked.scans.size(), 3u);
}

TEST_F(Tables, OnlyTheFirstTenProblemsAreReported) {
  std::string text = "t,radar,range,az,vr\n";
  for (int i = 0; i < 25; ++i) text += "x,1,9,0,1\n";
  const Read read = drive(text);
  EXPECT_EQ(read.reported.size(), 10u);
  EXPECT_EQ(read.bad, 25u);
}

TEST_F(Tables, DetectionsBeyondTheMostAScanCanHaveAreCounted) {
  std::string text = "t,radar,range,az,vr\n";
  for (std::size_t i = 0; i < kMaxDetections + 7; ++i) text += "0,1,9,0,1\n";
  const Read read = drive(text + "0.05,1,9,0,1\n");
  ASSERT_EQ(read.scans.size(), 2u);
  EXPECT_EQ(read.scans[0].count, kMaxDetections);
  EXPECT_EQ(read.dropped, 7u);
}

TEST_F(Tables, UselessFilesAreErrors) {
  EXPECT_THAT(drive("").error,
              HasSubstr("is empty; the first line must name the columns t_s,radar,range_m,azimuth_rad,"));
  EXPECT_THAT(drive("\n\n# nothing\n").error, HasSubstr("is empty"));
  EXPECT_THAT(drive("0.0,1,9,0.1,0,-1,1\n").error, HasSubstr("begins with a number"));
  EXPECT_THAT(drive("t,radar,range,el,vr\n").error, HasSubstr("the header lacks azimuth_rad"));
  EXPECT_THAT(drive("t,radar,range,az,az,vr\n").error, HasSubstr("column az is given twice"));
  const Read header_only = drive("t,radar,range,az,vr");
  EXPECT_EQ(header_only.error, "");
  EXPECT_TRUE(header_only.scans.empty());
}

TEST_F(Tables, AnyBytesAreRefusedWithoutHarm) {
  std::string noise;
  std::uint32_t state = 12345;
  for (int i = 0; i < 200'000; ++i) noise += static_cast<char>((state = state * 1664525u + 1013904223u) >> 24);
  EXPECT_THAT(drive(noise).error, HasSubstr("header"));
  const Read read = drive("t,radar,range,az,vr\n" + noise + "\n0,1,9,0,1\n");
  EXPECT_EQ(read.scans.size(), 1u);
  EXPECT_GT(read.bad, 100u);
}

TEST_F(Tables, EgoMotionIsReadWithTheVehiclesStds) {
  align::testing::write_text(file_, "yaw_rate,t,v,gear\n0.1,5,20,D\nx,5.1,20,D\n0.2,5.2,-3,R\n");
  Problems problems([](const std::string&) {});
  recording::ByteSource source(file_);
  EgoConfig config;
  config.speed_std_mps = 0.07;
  EgoReader reader(source, config, problems);
  EgoMotion motion{};
  double time_s = 0.0;
  ASSERT_TRUE(reader.next(motion, time_s));
  EXPECT_EQ(time_s, 5.0);
  EXPECT_FLOAT_EQ(motion.speed_mps, 20.0F);
  EXPECT_FLOAT_EQ(motion.speed_std_mps, 0.07F);
  EXPECT_FLOAT_EQ(motion.yaw_rate_radps, 0.1F);
  EXPECT_TRUE(motion.has(ego_field::kSpeed | ego_field::kYawRate));
  ASSERT_TRUE(reader.next(motion, time_s));
  EXPECT_FLOAT_EQ(motion.speed_mps, -3.0F);
  EXPECT_FALSE(reader.next(motion, time_s));
  EXPECT_EQ(problems.bad_lines(), 1u);
  EXPECT_THAT(reader.ignored_columns(), ElementsAre("\"gear\""));
}

}  // namespace
}  // namespace boresight::input
