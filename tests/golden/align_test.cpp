// Runs the command line on the recorded drive, from compressed tables to JSON, and compares the result with the truth.
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/golden/support/decoded.hpp"

namespace boresight::golden {
namespace {

const std::filesystem::path kAlignCases = shared_data() / "alignment_drive";

/// The numbers of all `"key":number` in the text.
std::vector<double> all_of(const std::string& json, const std::string& key) {
  std::vector<double> values;
  const std::string name = "\"" + key + "\":";
  for (std::size_t at = json.find(name); at != std::string::npos; at = json.find(name, at + 1)) {
    values.push_back(std::strtod(json.c_str() + at + name.size(), nullptr));
  }
  return values;
}

/// Runs the command, sets `exit_code` and returns its output.
std::string align(const std::string& method, int& exit_code) {
  const std::string command = "xz -dc '" + (kAlignCases / "drive_1.csv.xz").string() +
                              "' | " BORESIGHT_BINARY_DIR "/boresight align --drive - --ego '" +
                              (kAlignCases / "ego_1.csv").string() +
                              "' --vehicle " BORESIGHT_SOURCE_DIR "/config/vehicle/alignment_drive.toml --truth '" +
                              (kAlignCases / "truth_1.txt").string() + "' --json - --method " + method;
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 65536> buffer;
  for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    text.append(buffer.data(), got);
  }
  const int status = pclose(pipe);
  exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return text;
}

TEST(Align, FindsTheTruthOfTheRecordedDrive) {
  REQUIRE_RECORDING(kAlignCases);
  if (std::system("xz --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no xz";
  int exit_code = -1;
  const std::string json = align("boresight", exit_code);
  ASSERT_EQ(exit_code, 0);
  EXPECT_NE(json.find("\"detections\":864609"), std::string::npos) << "no line is lost";
  // The first k_v_error is that of the vehicle; the other errors are those of the radars in their order.
  EXPECT_LT(std::abs(all_of(json, "k_v_error").at(0)), 1e-4);
  const auto yaw = all_of(json, "yaw_error_deg"), pitch = all_of(json, "pitch_error_deg");
  const auto roll = all_of(json, "roll_error_deg");
  ASSERT_EQ(yaw.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(std::abs(yaw[i]), 0.01) << i + 1;
    EXPECT_LT(std::abs(pitch.at(i)), 0.05) << i + 1;
    EXPECT_LT(std::abs(roll.at(i)), i < 2 ? 0.6 : 2.2) << i + 1 << ": three minutes; the bound is 0.18 and 0.73";
    // The truth file has: 0.4504 uncorrected in the mean of the radars, 0.0989 at the truth.
    EXPECT_NEAR(all_of(json, "rmse_mps").at(2 * i), 0.0989, 0.003) << i + 1;
  }
  EXPECT_EQ(json.find("nan"), std::string::npos);
}

TEST(Align, TheReferenceMethodFindsYawAndLeavesTheRestOpen) {
  REQUIRE_RECORDING(kAlignCases);
  if (std::system("xz --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "skipped: no xz";
  int exit_code = -1;
  const std::string json = align("azimuth_1d", exit_code);
  ASSERT_EQ(exit_code, 0);
  const auto yaw = all_of(json, "yaw_error_deg");
  ASSERT_EQ(yaw.size(), 4u);
  for (const double error : yaw) EXPECT_LT(std::abs(error), 0.05);
  EXPECT_NE(json.find("\"pitch\":\"NOT_OBSERVABLE\",\"roll\":\"NOT_OBSERVABLE\""), std::string::npos);
}

}  // namespace
}  // namespace boresight::golden
