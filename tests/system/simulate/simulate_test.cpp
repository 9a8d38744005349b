// `boresight simulate`: what was asked for is in the files, and what cannot be asked for is refused.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <sys/wait.h>

namespace boresight {
namespace {

using testing::HasSubstr;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Runs the command in a shell; returns its exit code.
int simulate(const std::string& arguments) {
  const std::string command =
      BORESIGHT_BINARY_DIR "/boresight simulate " + arguments + " > /tmp/simulate.out 2> /tmp/simulate.err";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
std::string errors() {
  return text_of("/tmp/simulate.err");
}

TEST(Simulate, AnAlignmentDriveHasWhatWasAskedFor) {
  const std::string asked =
      "--alignment-drive city --seed 5 --duration 12 --yaw-rate-bias 0.1 --slip 0.003 --body-pitch 0.3 "
      "--step-change 2,3,0,2,0 --step-change 4,1,0,0,1 --no-elevation 2 --stds --ambiguity 40";
  ASSERT_EQ(simulate(asked + " --out /tmp/a"), 0) << errors();
  const std::string truth = text_of("/tmp/a/truth.txt");
  for (const char* part : {"kind=city duration_s=12", "yaw_rate_bias 0.001745 ", "rear_slip_coeff 0.0030 ",
                           "pitch_std 0.300 ", "step_change t 2.0000 radar 3 turn_x_deg 0.0000 turn_y_deg 2.0000",
                           "step_change t 4.0000 radar 1 ", "crlb_sd kv "}) {
    EXPECT_THAT(truth, HasSubstr(part));
  }
  EXPECT_THAT(text_of("/tmp/a/drive.csv"),
              testing::StartsWith("t,radar,range,az,el,vr,is_stationary,az_std,el_std,vr_std,vr_min,vr_max\n"));
  ASSERT_EQ(simulate(asked + " --out /tmp/b"), 0);
  for (const char* file : {"drive.csv", "ego.csv", "vehicle.toml", "truth.txt"}) {
    EXPECT_TRUE(text_of(std::filesystem::path("/tmp/a") / file) == text_of(std::filesystem::path("/tmp/b") / file))
        << file << ": the same command gives the same bytes";
  }
}

TEST(Simulate, AnAlignmentDriveOfAVehicleFileHasItsRadars) {
  ASSERT_EQ(simulate("--alignment-drive mixed --random-truth --duration 2 --out /tmp/a --vehicle " BORESIGHT_SOURCE_DIR
                     "/config/vehicle/ars548_single.toml"),
            0)
      << errors();
  const std::string truth = text_of("/tmp/a/truth.txt");
  EXPECT_THAT(truth, HasSubstr("radar 1 mount_az_deg 0 x 3.87"));
  EXPECT_THAT(truth, testing::Not(HasSubstr("radar 2")));
  EXPECT_THAT(truth, testing::Not(HasSubstr("k_v 1.010000")));
}

TEST(Simulate, AScenarioLeavesRecordingsAndTruth) {
  const std::string demo = " --config " BORESIGHT_SOURCE_DIR "/config";
  ASSERT_EQ(simulate("--scenario tunnel --seed 3 --duration 1 --out /tmp/s/deep/er" + demo), 0) << errors();
  EXPECT_THAT(text_of("/tmp/simulate.out"), HasSubstr("simulated 1.0 s in "));
  EXPECT_THAT(text_of("/tmp/simulate.out"), HasSubstr(" times real time): 79 scans, "));
  for (const char* file : {"radars.pcap", "ego.candump.log", "truth.csv", "truth_detections.csv", "truth_objects.csv",
                           "truth_sensors.csv", "truth_visibility.csv"}) {
    EXPECT_THAT(text_of("/tmp/simulate.out"), HasSubstr(std::string("  /tmp/s/deep/er/") + file + "\n"));
    EXPECT_FALSE(text_of(std::filesystem::path("/tmp/s/deep/er") / file).empty()) << file;
  }
  // Every column is explained where the table is.
  const std::string readme = text_of(BORESIGHT_SOURCE_DIR "/services/simulator/README.md");
  for (const std::string table : {"detections", "objects", "sensors", "visibility"}) {
    const std::size_t begin = readme.find("\nColumns of `truth_" + table + ".csv`:\n\n");
    ASSERT_NE(begin, std::string::npos) << table;
    const std::size_t rows = readme.find("\n|", begin);
    const std::string explained = readme.substr(rows, readme.find("\n\n", rows) - rows);
    std::ifstream file("/tmp/s/deep/er/truth_" + table + ".csv");
    std::string header;
    std::getline(file, header);
    std::istringstream columns(header);
    for (std::string column; std::getline(columns, column, ',');) {
      EXPECT_THAT(explained, HasSubstr("`" + column + "`")) << table;
    }
  }
  // A file of one's own, with the vehicle it names, over what an earlier run left.
  std::ofstream("/tmp/own.toml") << "name = \"own\"\nvehicle = \"demo\"\nduration_s = 0.5\n";
  ASSERT_EQ(simulate("--scenario /tmp/own.toml --out /tmp/s/deep/er" + demo), 0) << errors();
  EXPECT_THAT(text_of("/tmp/simulate.out"), HasSubstr("simulated 0.5 s in "));
  EXPECT_EQ(simulate("--list"), 0);
  EXPECT_THAT(text_of("/tmp/simulate.out"), HasSubstr("\ntunnel "));
  EXPECT_THAT(text_of("/tmp/simulate.out"), HasSubstr("a tube of two lanes"));
}

TEST(Simulate, AWrongScenarioIsNamedWithItsLine) {
  const std::string demo = " --out /tmp/wrong --config " BORESIGHT_SOURCE_DIR "/config";
  EXPECT_EQ(simulate("--scenario nowhere" + demo), 2);
  EXPECT_THAT(errors(), HasSubstr("known: aligned_drive, "));
  EXPECT_EQ(simulate("--scenario ./nowhere.toml" + demo), 2);
  EXPECT_THAT(errors(), HasSubstr("./nowhere.toml: cannot be read"));
  std::ofstream("/tmp/own.toml") << "name = \"own\"\nvehicle = \"demo\"\n[ego]\nspeed_mps = 200.0\ncolour = 1\n";
  EXPECT_EQ(simulate("--scenario /tmp/own.toml" + demo), 2);
  EXPECT_THAT(errors(), HasSubstr("/tmp/own.toml:4: ego.speed_mps: 200 is out of range; allowed: -80 … 80"));
  EXPECT_THAT(errors(), HasSubstr("/tmp/own.toml:5: ego.colour: unknown key"));
  std::ofstream("/tmp/own.toml")
      << "name = \"own\"\nvehicle = \"demo\"\n[radars]\nstep_change = [{radar = 2},\n  {radar = 9}]\n";
  EXPECT_EQ(simulate("--scenario /tmp/own.toml" + demo), 2);
  EXPECT_THAT(
      errors(),
      HasSubstr(
          "/tmp/own.toml:5: radars.step_change[1].radar: 9 is no radar of the vehicle demo; allowed: 1, 2, 3, 4"));
  std::ofstream("/tmp/own.toml") << "name = \"own\"\nvehicle = \"demo\"\n[radars]\nstep_change = [{time_s = 1.0}]\n";
  EXPECT_EQ(simulate("--scenario /tmp/own.toml" + demo), 2);
  EXPECT_THAT(errors(), HasSubstr("/tmp/own.toml:4: radars.step_change[0].radar: is missing; allowed: 1 … 16"));
  std::ofstream("/tmp/own.toml") << "name = \"own\"\nvehicle = \"submarine\"\n";
  EXPECT_EQ(simulate("--scenario /tmp/own.toml" + demo), 2);
  EXPECT_THAT(errors(), HasSubstr("no vehicle 'submarine' in " BORESIGHT_SOURCE_DIR "/config/vehicle"));
  EXPECT_FALSE(std::filesystem::exists("/tmp/wrong"));
}

TEST(Simulate, WhatMakesNoSenseIsRefused) {
  EXPECT_EQ(simulate(""), 2);
  EXPECT_THAT(errors(), HasSubstr("--out is required"));
  for (const char* arguments :
       {"--out /tmp/a --duration 0", "--out /tmp/a --duration -1", "--out /tmp/a --duration nan",
        "--out /tmp/a --duration inf", "--out /tmp/a --seed -1", "--out /tmp/a --seed 1.5", "--list --scenario tunnel",
        "--list --out /tmp/a", "--out /tmp/a --fast"}) {
    EXPECT_EQ(simulate(arguments), 2) << arguments;
    EXPECT_FALSE(errors().empty()) << arguments;
  }
  EXPECT_EQ(simulate("--out /tmp/a --config /nowhere"), 2);
  EXPECT_THAT(errors(), HasSubstr("configuration: /nowhere"));
  EXPECT_EQ(simulate("--alignment-drive moon --out /tmp/a"), 2);
  EXPECT_EQ(simulate("--alignment-drive city --scenario demo_drive --out /tmp/a"), 2);
  EXPECT_EQ(simulate("--slip 0.003 --vehicle v.toml --out /tmp/a"), 2) << "without --alignment-drive it means nothing";
  EXPECT_EQ(simulate("--alignment-drive city --out /tmp/a --step-change 1,2,3"), 2);
  EXPECT_THAT(errors(), HasSubstr("--step-change 1,2,3: "));
  EXPECT_EQ(simulate("--alignment-drive city --out /tmp/a --step-change 1,9,0,0,1"), 2);
  EXPECT_THAT(errors(), HasSubstr("no radar 9"));
  EXPECT_EQ(simulate("--alignment-drive city --out /tmp/a --no-elevation 5"), 2);
  EXPECT_EQ(simulate("--alignment-drive city --duration 1 --out /proc/nowhere"), 3);
}

}  // namespace
}  // namespace boresight
