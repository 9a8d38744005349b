#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "services/boresight/align/json.hpp"
#include "services/boresight/align/plot.hpp"
#include "services/boresight/align/residuals.hpp"
#include "services/boresight/align/table.hpp"
#include "services/boresight/align/truth_file.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/geometry/frames.hpp"
#include "tests/unit/align/tables.hpp"

namespace boresight::align {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Moments, AreThoseOfTheDefinition) {
  const Moments m = moments({1.0, 1.0, 1.0, 5.0});
  EXPECT_DOUBLE_EQ(m.rmse_mps, std::sqrt(7.0));
  EXPECT_NEAR(m.skewness, 2.0 / std::sqrt(3.0), 1e-12);  // of a two-point distribution with p = 1/4
  EXPECT_NEAR(m.kurtosis, 7.0 / 3.0, 1e-12);
  EXPECT_TRUE(std::isnan(moments({}).rmse_mps));
  EXPECT_TRUE(std::isnan(moments({2.0, 2.0}).kurtosis));
}

TEST(TruthFile, ReadsTheFormatOfTheRecordedDrive) {
  std::istringstream text(
      "# kind=mixed\nk_v 1.0100\nradar 3 mount_az_deg 135.0 x -0.85 y 0.70 alpha_deg 1.00 beta_deg 2.00 gamma_deg "
      "-1.00\n"
      "disturbance yaw_rate_bias 0.001 rad/s (measured = true + bias) rear_slip_coeff 0.0030 rad/(m/s2)\n");
  const Truth truth = read_truth(text, "truth.txt");
  EXPECT_DOUBLE_EQ(truth.speed_scale.value(), 1.01);
  EXPECT_DOUBLE_EQ(truth.yaw_rate_bias_radps.value(), 0.001);
  EXPECT_DOUBLE_EQ(truth.slip_coefficient_radps2pm.value(), 0.003);
  const MountingPose nominal{.position_m = {}, .yaw_rad = 0.0, .pitch_rad = 0.0, .roll_rad = M_PI};
  const double degree = M_PI / 180.0;
  EXPECT_TRUE(true_mounting(truth.radars.at(3), nominal)
                  .isApprox(geometry::sensor_to_vehicle(136.0 * degree, 2.0 * degree, 179.0 * degree)));
}

TEST(TruthFile, StepChangesComeInTheOrderOfTime) {
  std::istringstream text(
      "k_v 1\nstep_change t 60 radar 2 alpha_deg 3 beta_deg 0 gamma_deg 0\nstep_change t 30 radar 1 turn_x_deg 9 "
      "alpha_deg 1 "
      "beta_deg 2 gamma_deg 3\n");
  const Truth truth = read_truth(text, "truth.txt");
  ASSERT_EQ(truth.step_changes.size(), 2u);
  EXPECT_EQ(truth.step_changes[0].radar, 1u);
  EXPECT_DOUBLE_EQ(truth.step_changes[0].time_s, 30.0);
  EXPECT_DOUBLE_EQ(truth.step_changes[0].sensor_rad[1], 2.0 * M_PI / 180.0);
}

TEST(TruthFile, RefusesWhatHoldsNone) {
  const auto error_of = [](const std::string& text) -> std::string {
    std::istringstream stream(text);
    try {
      static_cast<void>(read_truth(stream, "truth.txt"));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of("# nothing\n"), HasSubstr("holds no truth"));
  EXPECT_THAT(error_of("k_v 1\nradat 1 alpha_deg 1\n"), HasSubstr("truth.txt:2: unknown line \"radat\""));
  EXPECT_THAT(error_of("k_v fast\n"), HasSubstr("truth.txt:1: k_v"));
  EXPECT_THAT(error_of("radar 17 alpha_deg 1\n"), HasSubstr("1 … 16"));
  EXPECT_THAT(error_of("k_v 1\nradar 1 alpha_deg 1 beta_deg 2\n"),
              HasSubstr("truth.txt:2: radar 1: alpha_deg, beta_deg"));
  EXPECT_THAT(error_of("k_v 1\nstep_change t 30 radar 1\n"), HasSubstr("truth.txt:2: step_change"));
}

TEST(TruthFile, PassesOverLinesWithoutMountings) {
  std::istringstream text(
      "# comment\n\nk_v 1.02\nnoise sigma_vr 0.03 m/s\nstationary residual\ncrlb_sd kv 1\nprototype x\n");
  EXPECT_DOUBLE_EQ(read_truth(text, "truth.txt").speed_scale.value(), 1.02);
}

TEST(TruthFile, SpeedScaleIncludesTheOwnRangeRateScaleOfEachRadar) {
  std::istringstream text(
      "k_v 1.02\nreal_car load_time 3 s\nreal_car range_rate_scale 1.0025 1 radar 1\n"
      "radar 1 alpha_deg 1 beta_deg 0 gamma_deg 0\n");
  const Truth of_text = read_truth(text, "truth.txt");
  EXPECT_DOUBLE_EQ(of_text.speed_scale_seen_by(1).value(), 1.02 * 1.0025);
  EXPECT_DOUBLE_EQ(of_text.speed_scale_seen_by(2).value(), 1.02);
  const auto file = std::filesystem::path(::testing::TempDir()) / "align_scaled_truth.csv";
  testing::write_text(file, "quantity,radar,value,unit\nspeed_scale,,1.02,1\nrange_rate_scale,2,0.998,1\n");
  const Truth of_table = read_truth_at(file, 0.0);
  EXPECT_DOUBLE_EQ(of_table.speed_scale_seen_by(1).value(), 1.02);
  EXPECT_DOUBLE_EQ(of_table.speed_scale_seen_by(2).value(), 1.02 * 0.998);
  std::filesystem::remove(file);
  std::istringstream without_radar("k_v 1.02\nreal_car range_rate_scale 1.0025 1\n");
  EXPECT_THROW(static_cast<void>(read_truth(without_radar, "truth.txt")), std::runtime_error);
  std::istringstream of_no_radar("k_v 1.02\nreal_car range_rate_scale 1.0025 1 radar 99\n");
  EXPECT_THROW(static_cast<void>(read_truth(of_no_radar, "truth.txt")), std::runtime_error);
}

TEST(TruthFile, FolderOfASimulatedDriveIsReadWithItsStepChanges) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "align_truth_folder";
  std::filesystem::create_directories(folder);
  testing::write_text(folder / "truth.csv",
                      "quantity,radar,value,unit\nspeed_scale,,1.012000,1\nalignment_yaw,2,0.3,deg\n"
                      "alignment_pitch,2,-0.2,deg\nalignment_roll,2,0.1,deg\nscans,2,3,1\n");
  testing::write_text(folder / "truth_sensors.csv",
                      "t_s,radar,scan,alignment_yaw_deg,alignment_pitch_deg,alignment_roll_deg,step_changes,stated\n"
                      "0.0,2,1,0.3,-0.2,0.1,0,clear\n0.1,2,2,2.5,-0.2,0.1,1,clear\n0.2,2,3,2.5,-0.2,0.1,1,clear\n");
  const Truth truth = read_truth_at(folder, 1000.0);
  const double degree = M_PI / 180.0;
  EXPECT_DOUBLE_EQ(truth.speed_scale.value(), 1.012);
  EXPECT_NEAR(truth.radars.at(2).sensor_rad[0], 0.3 * degree, 1e-12);
  ASSERT_EQ(truth.step_changes.size(), 1u);
  EXPECT_DOUBLE_EQ(truth.step_changes[0].time_s, 1000.1);
  EXPECT_NEAR(truth.step_changes[0].sensor_rad[0], 2.5 * degree, 1e-12);
  const Truth alone = read_truth_at(folder / "truth.csv", 0.0);
  EXPECT_NEAR(alone.radars.at(2).sensor_rad[1], -0.2 * degree, 1e-12);
  std::filesystem::remove(folder / "truth.csv");
  std::filesystem::remove(folder / "truth_sensors.csv");
  EXPECT_THROW(static_cast<void>(read_truth_at(folder, 0.0)), std::runtime_error);
}

/// With nothing known: every figure NaN.
Result empty_result() {
  Result result;
  result.method = "boresight";
  result.vehicle = "<car & \"co\">";
  result.start_s = result.end_s = kNaN;
  RadarResult& radar = result.radars.emplace_back();
  radar.id = 1;
  radar.name = "front";
  radar.cpu_us_per_scan = kNaN;
  radar.residuals = {{kNaN, kNaN, kNaN}, {kNaN, kNaN, kNaN}, kNaN, 0, {}};
  return result;
}

TEST(Outputs, OfNothingAreWellFormed) {
  const Result result = empty_result();
  const std::string json = to_json(result, {});
  EXPECT_TRUE(json::Value::accept(json)) << json;
  EXPECT_THAT(json, HasSubstr("\"yaw\":\"NOT_OBSERVABLE\""));
  const std::string svg = to_svg(result);
  EXPECT_THAT(svg, HasSubstr("&lt;car &amp; &quot;co&quot;&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(to_table(result), HasSubstr("not observable"));
  EXPECT_THAT(to_table(result), HasSubstr("k_v not observable"));
}

TEST(Outputs, SayWhatIsNotObservable) {
  Result result = empty_result();
  result.start_s = 0.0;
  result.end_s = 1.0;
  AlignmentEstimate& message = result.radars[0].message;
  message.observable = alignment_axis::kVehicleYaw;
  message.vehicle_yaw_rad = 0.01F;
  result.radars[0].stds = {0.0, 1e-3, 1.0, 1.0};
  for (const double x : {0.0, 1.0}) {
    Sample& sample = result.series.emplace_back();
    sample.x = x;
    sample.radars.push_back(
        {AlignmentState::kConverged, message.observable, {1.0, 0.01, 0.0, 0.0}, {0.0, 1e-3, 1.0, 1.0}});
  }
  const std::string svg = to_svg(result);
  EXPECT_THAT(svg, HasSubstr("1 front, yaw: +0.573 ± 0.057°"));
  EXPECT_THAT(svg, HasSubstr("1 front, pitch: not observable"));
  const std::string json = to_json(result, {});
  EXPECT_TRUE(json::Value::accept(json));
  EXPECT_THAT(json, HasSubstr("\"yaw\":\"OBSERVABLE\",\"pitch\":\"NOT_OBSERVABLE\""));
  EXPECT_THAT(to_table(result), HasSubstr("+0.573 ± 0.057°"));
}

TEST(Outputs, NameFindingChangesAndTheOtherParameters) {
  Result result = empty_result();
  result.start_s = 0.0;
  result.end_s = 1.0;
  RadarResult& radar = result.radars[0];
  radar.reason = radar.finding = "speed signal in km/h";
  radar.message.finding = AlignmentFinding::kSpeedUnit;
  radar.message.finding_value = 3.6F;
  radar.message.nuisance.range_rate_scale = {0.0025F, 0.00012F};
  radar.message.nuisance.azimuth_curve_step_rad = 0.2F;
  radar.before_change = MountingBefore{{1.0, 0.01, 0.0, 0.0}, {0.0, 1e-3, 1.0, 1.0}};
  result.load_changes.push_back({0.5, 0.0138});
  const std::string table = to_table(result), json = to_json(result, {}), svg = to_svg(result);
  for (const std::string& text : {table, svg}) {
    EXPECT_THAT(text, HasSubstr("speed signal in km/h"));
    EXPECT_THAT(text, HasSubstr("0.5 s: "));
    EXPECT_THAT(text, HasSubstr("+0.250 ± 0.012 %"));
  }
  EXPECT_THAT(table, HasSubstr("before the change"));
  EXPECT_THAT(table, HasSubstr("+0.573 ± 0.057°"));
  EXPECT_THAT(json, HasSubstr("\"finding\":\"speed_unit\""));
  EXPECT_THAT(json, HasSubstr("\"finding_text\":\"speed signal in km/h\""));
  EXPECT_THAT(json, HasSubstr("\"load_changes\":[{\"t\":0.5,"));
}

}  // namespace
}  // namespace boresight::align
