// A drive with a radar name that no program may stumble over, from the simulator to tables, score, report and
// alignment.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/json/documented.hpp"
#include "tests/unit/json/samples.hpp"

namespace boresight::json {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;

class NameOfARadar : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    std::string vehicle = schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/vehicle/demo.toml");
    const std::string name = "\"front_left\"";
    ASSERT_NE(vehicle.find(name), std::string::npos);
    vehicle.replace(vehicle.find(name), name.size(), "'" + testing::kName + "'");
    std::ofstream(folder_ / "my car.toml") << vehicle;
    EXPECT_THAT(run("simulate --duration 12 --out drive" + kVehicle), HasSubstr("959 scans"));
    EXPECT_THAT(run("run " + kDrive + " --out run" + kVehicle), HasSubstr("959 scans"));
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs `boresight ARGUMENTS` in the folder and expects exit code 0; returns what it prints on standard output.
  [[nodiscard]] std::string run(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && " BORESIGHT_BINARY_DIR "/boresight " + arguments +
                                " > stdout.txt 2> stderr.txt";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 0) << arguments << "\n" << text("stderr.txt");
    return text("stdout.txt");
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    return schema_page::text_of((folder_ / name).string());
  }
  [[nodiscard]] Value json(const std::string& name) const { return Value::parse(text(name)); }

  static void expect_equal_columns(const std::string& csv, const std::string& name) {
    std::istringstream lines(csv);
    std::set<std::ptrdiff_t> commas;
    std::size_t rows = 0;
    for (std::string line; std::getline(lines, line); ++rows) commas.insert(std::count(line.begin(), line.end(), ','));
    EXPECT_EQ(commas.size(), 1u) << name;
    EXPECT_GT(rows, 2u) << name;
  }
  [[nodiscard]] std::string score() const { return run("score run --truth drive --json score.json"); }
  [[nodiscard]] std::string align() const {
    return run(
        "align --recording drive/radars.pcap --recording drive/ego.candump.log --truth drive --json align.json "
        "--plot align.svg" +
        kVehicle);
  }

  inline static const std::string kVehicle = " --vehicle 'my car.toml'";
  inline static const std::string kDrive = "drive/radars.pcap drive/ego.candump.log";
  const fs::path folder_ = fs::path(::testing::TempDir()) / ("unit_json." + std::to_string(getpid()) + " ü");
};

TEST_F(NameOfARadar, LeavesTheTablesOfARunAndTheirScoreInOrder) {
  EXPECT_EQ(json("run/run.json").at("radars").at(0).at("name").get<std::string>(), testing::kName);
  for (const char* const table : {"scans", "detections", "reflectors", "tracks", "alignment"}) {
    const std::string name = "run/" + std::string(table) + ".csv";
    expect_equal_columns(text(name), name);
  }
  EXPECT_THAT(score(), HasSubstr("Health: seconds"));
  EXPECT_TRUE(json("score.json").at("runs").at(0).at("figures").contains("health.radar_1.judged_s"));
}

TEST_F(NameOfARadar, IsWholeInTableJsonAndPlotOfTheAlignment) {
  EXPECT_THAT(align(), HasSubstr("1 " + testing::kName + " "));
  EXPECT_EQ(json("align.json").at("radars").at(0).at("name").get<std::string>(), testing::kName);
  EXPECT_NE(text("align.svg").find("1 front &quot;long&quot;, größte"), std::string::npos);
}

TEST_F(NameOfARadar, IsWholeInSummaryAndPageOfTheReport) {
  EXPECT_THAT(run("report run --truth drive/truth.csv --out page.html" + kVehicle), HasSubstr(testing::kName));
  EXPECT_NE(text("page.html").find("<td>front &quot;long&quot;, größte</td>"), std::string::npos);
}

TEST_F(NameOfARadar, LeavesTheRowsOfDecodeInOrder) {
  expect_equal_columns(run("decode --csv drive/radars.pcap" + kVehicle), "decode --csv");
  EXPECT_THAT(run("decode --check " + kDrive + kVehicle), HasSubstr("radar 1 " + testing::kName + ": SOUND"));
}

TEST_F(NameOfARadar, LeavesNoKeyOfARealDriveUndocumented) {
  EXPECT_NE(score() + align(), "");
  const auto sections = testing::documented_sections();
  const auto expect_documented = [&](const std::string& section, const std::vector<Value>& values) {
    ASSERT_FALSE(values.empty()) << section;
    EXPECT_GT(testing::expect_documented(values, testing::rows_of(sections.at(section)), section).size(), 5u);
  };
  std::vector<Value> verdicts;
  std::istringstream lines(text("run/health.jsonl"));
  for (std::string line; std::getline(lines, line);) verdicts.push_back(Value::parse(line));
  expect_documented("Run folder: health.jsonl", verdicts);
  expect_documented("Run folder: run.json", {json("run/run.json")});
  expect_documented("boresight score", {json("score.json")});
  expect_documented("boresight align", {json("align.json")});
}

}  // namespace
}  // namespace boresight::json
