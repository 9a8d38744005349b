// The command as users call it: methods, exit codes, and independence of the truth in the table.
#include "services/boresight/align/run.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "services/boresight/align/json.hpp"
#include "services/boresight/align/plot.hpp"
#include "services/boresight/align/table.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/drive_writer.hpp"
#include "tests/unit/align/tables.hpp"

namespace boresight::align {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The numbers of `"key":[…]`, at its first place.
std::vector<double> numbers_of(const std::string& json, const std::string& key) {
  std::vector<double> numbers;
  const std::size_t begin = json.find("\"" + key + "\":[");
  if (begin == std::string::npos) return numbers;
  const std::size_t open = json.find('[', begin);
  std::istringstream list(json.substr(open + 1, json.find(']', open) - open - 1));
  for (std::string item; std::getline(list, item, ',');) numbers.push_back(std::strtod(item.c_str(), nullptr));
  return numbers;
}

/// The JSON without the cost of a scan, which depends on the machine.
std::string without_cost(std::string json) {
  for (const std::string key : {"\"cpu_us_per_scan\":", "\"max_cpu_us_per_scan\":"}) {
    for (std::size_t at = json.find(key); at != std::string::npos; at = json.find(key, at)) {
      at += key.size();
      json.erase(at, json.find(',', at) - at);
    }
  }
  return json;
}

class Align : public ::testing::Test {
 protected:
  static constexpr double kDuration_s = 20.0;

  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("align_run." + std::to_string(getpid()));
    fs::create_directories(folder_);
    simulator::AlignmentSpec spec = simulator::four_corner_radars();
    spec.duration_s = kDuration_s;
    spec.seed = 3;
    tables_ = testing::simulated_tables(spec, [](bool stationary) { return stationary ? "1" : "0"; });
    testing::write_text(folder_ / "drive.csv", tables_.drive);
    testing::write_text(folder_ / "ego.csv", tables_.ego);
    fs::copy_file(fs::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/alignment_drive.toml", folder_ / "vehicle.toml");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static int shell(const std::string& command) {
    const int status =
        std::system(("cd " + folder_.string() + " && rm -f out.json && " + command + " > out.txt 2> err.txt").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static int align(const std::string& arguments) { return shell(BORESIGHT_BINARY_DIR "/boresight align " + arguments); }
  static int align_drive(const std::string& text, const std::string& more = "") {
    testing::write_text(folder_ / "changed.csv", text);
    return align("--drive changed.csv --ego ego.csv --vehicle vehicle.toml --json out.json --method azimuth_1d " +
                 more);
  }
  static std::string out() { return text_of(folder_ / "out.txt"); }
  static std::string errors() { return text_of(folder_ / "err.txt"); }
  static std::string json() { return text_of(folder_ / "out.json"); }

  inline static fs::path folder_;
  inline static testing::Tables tables_;
};

const std::string kInputs = "--drive drive.csv --ego ego.csv --vehicle vehicle.toml --json out.json ";

TEST_F(Align, EveryMethodRunsAndItsResultIsValid) {
  for (const std::string& method : method_names()) {
    if (method == "batch_calibration") continue;  // takes long; below
    SCOPED_TRACE(method);
    ASSERT_EQ(align(kInputs + "--plot out.svg --method " + method), 0) << errors();
    EXPECT_TRUE(json::Value::accept(json()));
    EXPECT_THAT(json(), HasSubstr("\"method\":\"" + method + "\""));
    EXPECT_THAT(json(), Not(HasSubstr("nan")));
    EXPECT_THAT(text_of(folder_ / "out.svg"), HasSubstr("</svg>"));
    EXPECT_THAT(out(), HasSubstr("4 rear_right"));
    EXPECT_EQ(errors(), "");
  }
}

TEST_F(Align, BatchReadsTheTablesAgainAndSaysHowOften) {
  ASSERT_EQ(align(kInputs + "--method batch"), 0) << errors();
  const auto result = nlohmann::json::parse(json());
  EXPECT_GE(result.at("batch").at("passes").get<int>(), 3);
  EXPECT_GE(result.at("batch").at("windows").get<int>(), 3);
  EXPECT_EQ(result.at("problem"), "");
  for (const auto& radar : result.at("radars")) {
    EXPECT_TRUE(radar.at("observable").at("yaw").get<bool>());
    EXPECT_EQ(radar.at("finding"), "none");
    EXPECT_GT(radar.at("range_rate_scale").at("std").get<double>(), 0.0);
    EXPECT_EQ(radar.at("azimuth_curve").at("error_deg").size(), kAzimuthCurveKnots);
    EXPECT_EQ(radar.at("scans").get<int>(), result.at("recording").at("scans").get<int>() / 4) << "counted once";
  }
  EXPECT_THAT(out(), HasSubstr("range-rate scale "));
  EXPECT_THAT(out(), HasSubstr(" times\n"));
}

TEST_F(Align, BatchRefusesStandardInputAndNamesAShortDrive) {
  EXPECT_EQ(align("--drive - --ego ego.csv --vehicle vehicle.toml --method batch < drive.csv"), 2);
  EXPECT_THAT(errors(), HasSubstr("cannot be standard input"));
  std::string few;
  std::istringstream lines(tables_.drive);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == 't' || std::strtod(line.c_str(), nullptr) < 9.0) few += line + "\n";
  }
  testing::write_text(folder_ / "few.csv", few);
  EXPECT_EQ(align("--drive few.csv --ego ego.csv --vehicle vehicle.toml --method batch --json out.json"), 1);
  EXPECT_THAT(errors(), HasSubstr("are too few for the batch method: it needs 15 s"));
  EXPECT_TRUE(json::Value::accept(json()));
}

TEST(BatchCalibration, SaysWhatTheDataSupportAndHowItIterated) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.duration_s = 20.0;
  for (simulator::AlignmentRadar& radar : spec.radars) radar.measures_elevation = false;
  simulator::AlignmentDrive drive(spec);
  align::Run::Options options;
  options.method = "batch_calibration";
  options.batch_calibration.iterations = 4000;
  options.batch_calibration.judgement_draws = 2;
  align::Run run(drive.vehicle(), options);
  auto scan = std::make_unique<RadarScan>();
  for (simulator::AlignmentEvent event; drive.next(event);) {
    if (event.ego != nullptr) {
      EgoMotion motion = *event.ego;
      run.add_ego(motion, event.time_s);
    } else {
      *scan = *event.scan;
      run.add_scan(*scan, event.time_s);
    }
  }
  const Result result = run.finish();
  ASSERT_EQ(result.problem, "");
  EXPECT_TRUE(result.x_is_iteration);
  ASSERT_EQ(result.series.size(), 41u);
  EXPECT_EQ(result.series.back().x, 4000.0);
  ASSERT_EQ(result.radars.size(), 4u);
  for (const RadarResult& radar : result.radars) {
    ASSERT_EQ(radar.support.size(), 3u);
    EXPECT_THAT(radar.support[1], HasSubstr("not supported")) << "pitch without measured elevation";
    EXPECT_FALSE(radar.message.is_observable(alignment_axis::kVehiclePitch));
    EXPECT_FALSE(radar.message.is_observable(alignment_axis::kPitch));
    EXPECT_NEAR(radar.message.vehicle_yaw_rad, result.series.back().radars[radar.id - 1].values[1], 1e-6);
  }
  const std::string json = to_json(result, {});
  EXPECT_TRUE(json::Value::accept(json));
  EXPECT_THAT(json, HasSubstr("\"iteration\":[0.0,100.0,"));
  EXPECT_THAT(json, HasSubstr("\"support\":{\"alpha\":"));
  EXPECT_THAT(to_svg(result), HasSubstr(">thousand iterations<"));
  EXPECT_THAT(to_table(result), HasSubstr("beta not supported"));
}

TEST_F(Align, BatchCalibrationReportsItsProgress) {
  std::string one_radar;  // a quarter of the time
  std::istringstream lines(tables_.drive);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t radar = line.find(',') + 1;
    if (line.compare(radar, 2, "1,") == 0 || line.compare(radar, 5, "radar") == 0) one_radar += line + "\n";
  }
  testing::write_text(folder_ / "one_radar.csv", one_radar);
  ASSERT_EQ(
      align("--drive one_radar.csv --ego ego.csv --vehicle vehicle.toml --method batch_calibration --json out.json"), 0)
      << errors();
  // No terminal: no bar, a line a step.
  EXPECT_EQ(errors(),
            "boresight align: batch_calibration, step 1 of 3: finding stationary detections …\n"
            "boresight align: batch_calibration, step 2 of 3: iterating …\n"
            "boresight align: batch_calibration, step 3 of 3: judging what the data support …\n");
  EXPECT_TRUE(json::Value::accept(json()));
}

TEST_F(Align, TheSeriesHasAnEntryASecondAndTheEnd) {
  ASSERT_EQ(align(kInputs + "--method azimuth_1d"), 0) << errors();
  const std::vector<double> t = numbers_of(json(), "t");
  ASSERT_GT(t.size(), 2u);
  EXPECT_NEAR(static_cast<double>(t.size()), kDuration_s + 1.0, 1.0);
  EXPECT_EQ(t[1] - t[0], 1.0);
  EXPECT_EQ(numbers_of(json(), "yaw_std_deg").size(), t.size());
  EXPECT_LT(numbers_of(json(), "k_v_std").back(), numbers_of(json(), "k_v_std").front());
}

TEST_F(Align, TheTruthInTheTableDoesNotMatter) {
  ASSERT_EQ(align_drive(tables_.drive), 0);
  const std::string as_it_is = without_cost(json());
  ASSERT_THAT(as_it_is, HasSubstr("CONVERG"));
  std::string flipped = tables_.drive, lying = tables_.drive;
  for (std::size_t at = flipped.find('\n', flipped.find('\n') + 1); at != std::string::npos;
       at = flipped.find('\n', at + 1)) {
    flipped[at - 1] = flipped[at - 1] == '1' ? '0' : '1';
    lying[at - 1] = 'x';
  }
  ASSERT_NE(flipped, tables_.drive);
  ASSERT_EQ(align_drive(flipped), 0);
  EXPECT_EQ(without_cost(json()), as_it_is);
  ASSERT_EQ(align_drive(lying), 0) << "not even read";
  EXPECT_EQ(without_cost(json()), as_it_is);
  std::string absent;
  std::istringstream lines(tables_.drive);
  for (std::string line; std::getline(lines, line);) absent += line.substr(0, line.rfind(',')) + "\n";
  ASSERT_EQ(align_drive(absent), 0);
  EXPECT_EQ(without_cost(json()), as_it_is);
}

TEST_F(Align, StandardInputIsAsGoodAsAFileAndTheOriginOfTimeDoesNotMatter) {
  ASSERT_EQ(align(kInputs + "--method azimuth_1d"), 0);
  const std::string by_file = numbers_of(json(), "yaw_deg").empty() ? "" : json().substr(json().find("\"radars\""));
  ASSERT_EQ(
      shell("cat drive.csv | " BORESIGHT_BINARY_DIR
            "/boresight align --drive - --ego ego.csv --vehicle vehicle.toml --json out.json --method azimuth_1d"),
      0)
      << errors();
  EXPECT_EQ(without_cost(json().substr(json().find("\"radars\""))), without_cost(by_file));
  // An epoch of days before, kept exact by whole numbers of seconds.
  const auto shifted = [](const std::string& table) {
    std::istringstream lines(table);
    std::string line, result;
    std::getline(lines, result);
    result += '\n';
    while (std::getline(lines, line)) {
      const std::size_t comma = line.find(',');
      result += fmt::format("{:.6f}", std::strtod(line.c_str(), nullptr) - 1e6) + line.substr(comma) + "\n";
    }
    return result;
  };
  testing::write_text(folder_ / "ego_shifted.csv", shifted(tables_.ego));
  testing::write_text(folder_ / "drive_shifted.csv", shifted(tables_.drive));
  ASSERT_EQ(align("--drive drive_shifted.csv --ego ego_shifted.csv --vehicle vehicle.toml --json out.json "
                  "--method azimuth_1d"),
            0)
      << errors();
  EXPECT_NEAR(numbers_of(json(), "t").front(), 1.0 - 1e6, 0.1);
  const double yaw = numbers_of(json(), "yaw_deg").back();
  ASSERT_EQ(align(kInputs + "--method azimuth_1d"), 0);
  EXPECT_NEAR(yaw, numbers_of(json(), "yaw_deg").back(), 1e-6);
}

TEST_F(Align, TheTruthIsComparedWith) {
  testing::write_text(folder_ / "truth.txt",
                      "k_v 1.01\nradar 1 mount_az_deg 45.0 alpha_deg -1 beta_deg 1 gamma_deg 2\ndisturbance\n");
  ASSERT_EQ(align(kInputs + "--method azimuth_1d --truth truth.txt"), 0) << errors();
  EXPECT_THAT(json(), HasSubstr("\"nees\":{\"k_v\":"));
  EXPECT_THAT(json(), HasSubstr("\"k_v_error\":"));
  EXPECT_THAT(out(), HasSubstr("error"));
  ASSERT_EQ(align(kInputs + "--method azimuth_1d --truth vehicle.toml"), 3);
  EXPECT_THAT(errors(), HasSubstr("vehicle.toml:4: unknown line"));
}

TEST_F(Align, SpeedScaleIsComparedWithWhatTheRadarSees) {
  const auto error_with = [this](const std::string& more) {
    testing::write_text(folder_ / "truth.txt",
                        "k_v 1.01\nradar 1 mount_az_deg 45.0 alpha_deg -1 beta_deg 1 gamma_deg 2\n" + more);
    EXPECT_EQ(align(kInputs + "--method azimuth_1d --truth truth.txt"), 0) << errors();
    return nlohmann::json::parse(json()).at("k_v_error").get<double>();
  };
  std::string of_all;
  for (std::uint32_t radar = 1; radar <= kMaxRadars; ++radar) {
    of_all += "real_car range_rate_scale 1.0025 1 radar " + std::to_string(radar) + "\n";
  }
  const double of_vehicle = error_with("");
  EXPECT_NEAR(error_with(of_all), of_vehicle - 1.01 * 0.0025, 1e-6);
  const double of_one = error_with("real_car range_rate_scale 1.0025 1 radar 1\n");
  EXPECT_LT(of_one, of_vehicle - 1e-5);
  EXPECT_GT(of_one, of_vehicle - 1.01 * 0.0025 + 1e-5) << "only one of several radars has its own scale";
}

TEST_F(Align, AFewBadLinesAreReportedAndManyMakeItFail) {
  std::string few = tables_.drive;
  few.insert(few.find('\n') + 1, "1,1,x,0,0,0,1\n");
  EXPECT_EQ(align_drive(few), 0);
  EXPECT_THAT(errors(), HasSubstr("changed.csv:2:5: range: read \"x\""));
  EXPECT_THAT(errors(), HasSubstr("1 of "));
  EXPECT_THAT(json(), HasSubstr("\"bad_lines\":1"));
  std::string many = tables_.drive;
  const auto lines = std::count(many.begin(), many.end(), '\n');
  for (std::ptrdiff_t i = 0; i < lines / 50; ++i) many += "broken\n";
  EXPECT_EQ(align_drive(many), 1);
  EXPECT_THAT(errors(), HasSubstr("more than one in a hundred"));
  EXPECT_TRUE(json::Value::accept(json())) << "what is there is written all the same";
}

TEST_F(Align, UnknownRadarsAreReportedAndMakeItFail) {
  EXPECT_EQ(align_drive(tables_.drive + "30,9,9,0,0,1,1\n"), 1);
  EXPECT_THAT(errors(), HasSubstr("radar 9 (1 lines) is not in vehicle.toml"));
  EXPECT_TRUE(json::Value::accept(json()));
}

TEST_F(Align, ADriveWithoutDetectionsOrEgoMotionIsReportedAndFails) {
  EXPECT_EQ(align_drive("t,radar,range,az,el,vr\n"), 1);
  EXPECT_THAT(errors(), HasSubstr("there is no detection in the drive"));
  EXPECT_TRUE(json::Value::accept(json()));
  EXPECT_EQ(align_drive(""), 3);
  EXPECT_THAT(errors(), HasSubstr("changed.csv: is empty"));
  testing::write_text(folder_ / "other_clock.csv", "t,v,yaw_rate\n1.7e9,20,0\n1700000000.05,20,0\n");
  EXPECT_EQ(align("--drive drive.csv --ego other_clock.csv --vehicle vehicle.toml --method azimuth_1d"), 1);
  EXPECT_THAT(errors(), HasSubstr("scans have no ego motion near their time"));
}

TEST_F(Align, WrongCommandLinesAndFilesAreReported) {
  EXPECT_EQ(align("--drive drive.csv --ego ego.csv"), 2);
  EXPECT_EQ(align(kInputs + "--method magic"), 2);
  EXPECT_EQ(align("--drive - --ego - --vehicle vehicle.toml"), 2);
  EXPECT_EQ(align("--drive drive.csv --ego ego.csv --vehicle drive.csv"), 2);
  EXPECT_EQ(align(kInputs + "--method azimuth_1d --config vehicle.toml"), 2);
  EXPECT_EQ(align("--drive nowhere.csv --ego ego.csv --vehicle vehicle.toml --method azimuth_1d"), 3);
  EXPECT_THAT(errors(), HasSubstr("nowhere.csv: No such file"));
  EXPECT_EQ(align("--drive . --ego ego.csv --vehicle vehicle.toml --method azimuth_1d"), 3);
  EXPECT_EQ(align("--drive drive.csv --ego ego.csv --vehicle vehicle.toml --method azimuth_1d --json no/out.json"), 3);
  EXPECT_THAT(errors(), HasSubstr("no/out.json: cannot be written: No such file"));
}

TEST_F(Align, RecordingsOfTheWireAreAlignedAsTheServiceDoes) {
  const fs::path demo = fs::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml";
  const auto files = simulator::write_drive(simulator::scenario("demo_drive"), config::read_vehicle_file(demo), 1, 10.0,
                                            folder_ / "wire", [](double) {});
  ASSERT_EQ(align("--recording " + files.radars.string() + " --recording " + files.ego.string() + " --vehicle " +
                  demo.string() + " --method azimuth_1d --json out.json"),
            0)
      << errors();
  EXPECT_TRUE(json::Value::accept(json()));
  EXPECT_THAT(json(), HasSubstr("\"scans\":" + std::to_string(files.scans)));
  EXPECT_THAT(json(), HasSubstr("CONVERG"));
  EXPECT_THAT(json(), HasSubstr("\"scans_without_ego_motion\":0"));
  EXPECT_EQ(align("--recording a --drive drive.csv --ego ego.csv --vehicle vehicle.toml"), 2);
  EXPECT_EQ(align("--recording nowhere.pcap --vehicle " + demo.string() + " --method azimuth_1d"), 3);
  EXPECT_EQ(align("--recording " + files.radars.string() + " --vehicle vehicle.toml --method azimuth_1d"), 2)
      << "this vehicle has no links";
}

TEST_F(Align, SettingsAreTakenFromTheConfigurationFolder) {
  ASSERT_EQ(align(kInputs + "--method azimuth_1d"), 0) << errors();
  const double by_default = numbers_of(json(), "yaw_deg").back();
  const std::string shipped = BORESIGHT_SOURCE_DIR "/config";
  ASSERT_EQ(align(kInputs + "--method azimuth_1d --config " + shipped), 0) << errors();
  EXPECT_NEAR(numbers_of(json(), "yaw_deg").back(), by_default, 1e-4) << "what is shipped are the defaults";
  fs::create_directories(folder_ / "mine/services");
  testing::write_text(folder_ / "mine/services/alignment_estimator.toml", "publish_period_s = -1.0\n");
  EXPECT_EQ(align(kInputs + "--method azimuth_1d --config mine"), 2);
  EXPECT_THAT(errors(), HasSubstr("mine/services/alignment_estimator.toml:1: publish_period_s"));
  EXPECT_THAT(errors(), HasSubstr("configuration: mine"));
}

}  // namespace
}  // namespace boresight::align
