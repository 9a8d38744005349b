// The shipped file: every key, with the value of the default.
#include "services/alignment_estimator/config.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/unit/shipped_config.hpp"

namespace boresight::alignment {
namespace {

const std::filesystem::path kShipped =
    std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/alignment_estimator.toml";

/// All numbers of both configurations, in one order.
std::vector<double> numbers(const Settings& s) {
  const FilterConfig& f = s.estimator.filter;
  const published::PublishedConfig& p = s.estimator.published;
  const windows::Priors& w = s.estimator.windows.priors;
  const windows::RestoreConfig& r = s.estimator.windows.restore;
  const windows::ChangeConfig& c = s.estimator.windows.change;
  const windows::SumsConfig& u = s.estimator.windows.sums;
  std::vector<double> all = {
      s.estimator.publish_period_s,
      s.estimator.kpi_window_s,
      s.estimator.residual_gate_sigma,
      s.memory.period_s,
      f.min_speed_mps,
      f.outlier_gate_sigma,
      f.azimuth_std_edge,
      f.prior_angle_noise_log_std,
      f.speed_std_mps,
      f.yaw_rate_std_radps,
      f.start_seconds,
      f.start_detections,
      static_cast<double>(f.start_passes),
      f.start_scale_mps,
      f.start_shrink,
      f.converged_yaw_std_rad,
      f.min_seconds_to_converge,
      f.min_inlier_share,
      f.max_noise_scale,
      f.inlier_memory_s,
      u.noise_memory_s,
      u.spread_memory_s,
      u.gate_scale,
      u.start_gate_scale,
      u.gate_yaw_rad,
      u.wide_share,
      u.clear_acceleration_mps2,
      u.clear_yaw_acceleration_radps2,
      u.known_share,
      w.speed_scale_std,
      w.rate_scale_std,
      w.rotation_std_rad,
      w.turned_std_rad,
      w.yaw_rate_bias_std_radps,
      w.yaw_rate_gain_std,
      w.slip_std_radps2pm,
      w.pitch_per_acceleration_std_radps2pm,
      w.common_stamp_std_s,
      w.stamp_std_s,
      w.position_std_m,
      w.curve_std_rad,
      w.curve_length_rad,
      w.height_excess_std,
      w.mirror_share_std,
      w.mirror_share_tolerance,
      w.load_std_rad,
      w.roll_per_pitch,
      w.lasting_pitch,
      w.log_fluctuation_std,
      w.common_correlation_s,
      w.log_correlation_std,
      w.drift_std_radps,
      w.drift_span_s,
      w.body_pitch_std_rad,
      w.side_slip_std_rad,
      r.doubt_s,
      r.stop_s,
      r.rotation_std_rad,
      r.rate_scale_std,
      r.speed_scale_std,
      r.vehicle_share,
      c.yaw_rad,
      c.pitch_rad,
      c.scatter_factor,
      c.common_factor,
      c.yaw_scatter_rad,
      c.pitch_scatter_rad,
      c.least_detections,
      c.wait_s,
      c.settled_yaw_rad,
      c.prior_blocks,
      static_cast<double>(c.settled_blocks),
      c.unsure_s,
      c.load_after_restart_stds,
      c.load_wait_s,
      c.suspect_scale,
      c.watch_s,
      c.drift_rad,
      c.drift_stds,
      c.load.least,
      c.load.scatter,
      c.load.stds,
      static_cast<double>(c.load.after),
      c.load.prior_blocks,
      c.load.between_radars,
      c.load.later_share,
      c.speed.least,
      c.speed.scatter,
      c.speed.stds,
      static_cast<double>(c.speed.after),
      c.speed.prior_blocks,
      c.speed.between_radars,
      c.speed.later_share,
      static_cast<double>(p.road_model),
      p.straight_yaw_rate_radps,
      p.min_speed_mps,
      p.least_squares_damping,
      p.total_least_squares_rate,
      static_cast<double>(p.nelder_mead_detections),
      static_cast<double>(p.nelder_mead_iterations),
      p.nelder_mead_filter_scans,
      p.gate ? 1.0 : 0.0,
      p.gate_sigma,
      p.gate_floor_mps,
      static_cast<double>(p.min_detections),
      p.max_speed_scale_error,
      p.max_angle_rad,
      p.prior_speed_scale_std,
      p.prior_angle_std_rad,
      p.window_s,
      p.converged_angle_rad,
      p.converged_speed_scale,
      static_cast<double>(p.seed),
      s.estimator.plausibility.window_s,
      s.estimator.plausibility.least_share,
      s.estimator.plausibility.yaw_limit_rad,
      s.estimator.plausibility.prior_log_odds,
      s.estimator.plausibility.margin_log,
      s.estimator.plausibility.least_s,
  };
  for (const auto& list : {p.steepest_descent_rate, p.least_squares_rate, p.nelder_mead_edge}) {
    all.insert(all.end(), list.begin(), list.end());
  }
  for (const auto& list : {w.own_std, w.common_std}) all.insert(all.end(), list.begin(), list.end());
  return all;
}

TEST(Config, TheShippedFileHasTheDefaults) {
  const Settings shipped = read_settings(config::Reader::open(kShipped));
  const std::vector<double> read = numbers(shipped), expected = numbers(Settings{});
  ASSERT_EQ(read.size(), expected.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    // Angles are written in degrees, with at least two digits.
    EXPECT_NEAR(read[i], expected[i], 0.02 * std::abs(expected[i]) + 1e-12) << "number " << i;
  }
  EXPECT_EQ(shipped.estimator.method, MethodName::kBoresight);
  EXPECT_FALSE(shipped.estimator.truth.has_value());
  EXPECT_TRUE(shipped.memory.enabled);
  EXPECT_TRUE(shipped.memory.path.empty());
}

TEST(Config, EveryKeyOfTheShippedFileIsReadIntoItsPlace) {
  const auto read = [](const std::string& text) {
    return numbers(read_settings(config::Reader::parse(text, "x.toml")));
  };
  // station/settings_test.cpp tests the station's settings.
  EXPECT_GT(test::expect_each_number_is_read(kShipped, read, "station"), 80u);
}

TEST(Config, ErrorsAreNamed) {
  const auto problem = [](const char* text) -> std::string {
    try {
      static_cast<void>(read_settings(config::Reader::parse(text, "test.toml")));
    } catch (const config::Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(problem(""), "");
  EXPECT_NE(problem("method = \"best\"\n").find("method"), std::string::npos);
  EXPECT_NE(problem("[filter]\nmin_sped_mps = 5.0\n").find("min_sped_mps"), std::string::npos);
  EXPECT_NE(problem("[filter.step_change]\nyaw_deg = -1.0\n").find("yaw_deg"), std::string::npos);
  EXPECT_NE(problem("[published]\nnls_rate = [1.0, 2.0]\n").find("nls_rate"), std::string::npos);
  EXPECT_NE(problem("truth_file = \"/nowhere/truth.csv\"\n")
                .find("truth_file: no truth of a simulated drive in /nowhere/truth.csv"),
            std::string::npos);
}

TEST(Config, TheTruthOfASimulatedDrive) {
  const auto write = [](const std::string& name, const char* text) {
    const std::string file = testing::TempDir() + name + std::to_string(getpid());
    std::ofstream(file) << text;
    return file;
  };
  const std::string file = write("truth", "speed_scale,,1.01,1\nalignment_pitch,3,-1.0,deg\n");
  const std::string other = write("other", "speed_scale,,1.02,1\nalignment_pitch,3,-1.0,deg\n");
  const std::string incomplete = write("incomplete", "alignment_pitch,3,-1.0,deg\n");
  const std::string text = "truth_file = \"" + file + "\"\n";
  const auto read = [&] { return read_settings(config::Reader::parse(text, "test.toml")).estimator.truth; };
  const auto truth = read();
  ASSERT_TRUE(truth.has_value());
  EXPECT_EQ(truth->speed_scale, 1.01);
  ASSERT_EQ(truth->radars.size(), 1u);
  EXPECT_NEAR(truth->radars.at(3).pitch_rad, -M_PI / 180.0, 1e-12);
  ASSERT_EQ(setenv("BORESIGHT_TRUTH", other.c_str(), 1), 0);
  EXPECT_EQ(read()->speed_scale, 1.02);
  ASSERT_EQ(setenv("BORESIGHT_TRUTH", incomplete.c_str(), 1), 0);
  EXPECT_THROW(static_cast<void>(read()), config::Error);
  unsetenv("BORESIGHT_TRUTH");
  for (const std::string& f : {file, other, incomplete}) std::remove(f.c_str());
}

}  // namespace
}  // namespace boresight::alignment
