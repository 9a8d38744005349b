// The shipped file has the defaults.
#include "services/detection_corrector/config.hpp"

#include <filesystem>

#include <gtest/gtest.h>

namespace boresight::corrector {
namespace {

TEST(CorrectorConfig, TheShippedFileHasTheDefaults) {
  const Config read = read_config(
      config::Reader::open(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/detection_corrector.toml"));
  const Config expected;
  EXPECT_EQ(read.region_min_m, expected.region_min_m);
  EXPECT_EQ(read.region_max_m, expected.region_max_m);
  EXPECT_EQ(read.rcs_near_dbsm, expected.rcs_near_dbsm);
  EXPECT_EQ(read.moving_sigma, expected.moving_sigma);
  EXPECT_EQ(read.body_motion_std_mps, expected.body_motion_std_mps);
  EXPECT_EQ(read.azimuth_std_edge, expected.azimuth_std_edge);
  EXPECT_NEAR(read.unknown_rotation_std_rad, expected.unknown_rotation_std_rad, 1e-5);
  EXPECT_EQ(read.unknown_speed_scale_std, expected.unknown_speed_scale_std);
  EXPECT_NEAR(read.unknown_yaw_rate_bias_std_radps, expected.unknown_yaw_rate_bias_std_radps, 1e-5);
  EXPECT_EQ(read.unknown_slip_std_radps2pm, expected.unknown_slip_std_radps2pm);
  const StatedNoiseConfig& noise = read.stated_noise;
  EXPECT_EQ(noise.prior_detections, expected.stated_noise.prior_detections);
  EXPECT_EQ(noise.time_constant_s, expected.stated_noise.time_constant_s);
  EXPECT_EQ(noise.other_share, expected.stated_noise.other_share);
  EXPECT_EQ(noise.other_width_mps, expected.stated_noise.other_width_mps);
  EXPECT_EQ(noise.least_scale, expected.stated_noise.least_scale);
  EXPECT_EQ(noise.most_scale, expected.stated_noise.most_scale);
  EXPECT_EQ(noise.least_speed_mps, expected.stated_noise.least_speed_mps);
}

}  // namespace
}  // namespace boresight::corrector
