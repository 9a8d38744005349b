#include "services/alignment_estimator/station/settings.hpp"

#include <string>

#include <gtest/gtest.h>

namespace boresight::alignment::station {
namespace {

Settings read(const std::string& text) {
  config::Reader root = config::Reader::parse(text, "test");
  const Settings settings = read_settings(root.table("station"));
  root.finish();
  return settings;
}
/// The error in the table; empty if there is none.
std::string problem_of(const std::string& text) {
  try {
    static_cast<void>(read(text));
    return "";
  } catch (const config::Error& error) {
    return error.what();
  }
}

TEST(CalibrationSettings, WithoutATableTheServiceIsOff) {
  EXPECT_FALSE(read("").enabled);
}

TEST(CalibrationSettings, AreReadWithTheirUnits) {
  const Settings s = read(R"([station]
enabled = true
interface = "eth0"
address = "192.168.20.2"
azimuth_half_width_deg = 10.0
method = "published"
min_tilts = 7
tilt_tolerance_deg = 1.0
settle_s = 0.5
)");
  EXPECT_TRUE(s.enabled);
  EXPECT_EQ(recording::to_text(s.address), "192.168.20.2");
  EXPECT_EQ(recording::to_text(s.discovery_group.address), "224.244.224.245");
  EXPECT_EQ(s.discovery_group.port, 30490);
  EXPECT_EQ(s.port, wire::calibration_service::kDefaultPort);
  EXPECT_NEAR(s.plate.window.azimuth_half_width_rad, 0.1745, 1e-4);
  EXPECT_EQ(s.plate.fit.method, plate::FitMethod::kPublished);
  EXPECT_EQ(s.plate.fit.min_tilts, 7u);
  EXPECT_NEAR(s.plate.tilt_tolerance_rad, 0.01745, 1e-5);
  EXPECT_EQ(s.plate.settle_s, 0.5);
}

TEST(CalibrationSettings, ReportErrors) {
  const std::string on = "[station]\nenabled = true\ninterface = \"eth0\"\n";
  EXPECT_NE(problem_of("[station]\nenabled = true\n").find("interface"), std::string::npos);
  EXPECT_NE(problem_of(on).find("address"), std::string::npos);
  EXPECT_NE(problem_of(on + "address = \"224.0.0.1\"\n").find("address"), std::string::npos);
  EXPECT_NE(problem_of(on + "address = \"10.0.0.1\"\ndiscovery_group = \"ff14::1\"\n").find("discovery_group"),
            std::string::npos);
  EXPECT_NE(problem_of(on + "address = \"10.0.0.1\"\nport = 30490\n").find("port"), std::string::npos);
  EXPECT_NE(problem_of("[station]\nrange_min_m = 5.0\nrange_max_m = 4.0\n").find("range_max_m"), std::string::npos);
  EXPECT_NE(problem_of("[station]\nenable = true\n").find("enable"), std::string::npos) << "an unknown key";
}

TEST(CalibrationSettings, TheShippedFileHoldsTheDefaults) {
  config::Reader root =
      config::Reader::open(BORESIGHT_SOURCE_DIR "/config/services/alignment_estimator.toml").table("station");
  const Settings shipped = read_settings(root), defaults = read("");
  EXPECT_FALSE(shipped.enabled);
  EXPECT_EQ(shipped.port, defaults.port);
  EXPECT_EQ(shipped.instance, defaults.instance);
  EXPECT_EQ(shipped.max_speed_mps, defaults.max_speed_mps);
  EXPECT_EQ(shipped.plate.window.range_min_m, defaults.plate.window.range_min_m);
  EXPECT_EQ(shipped.plate.window.range_max_m, defaults.plate.window.range_max_m);
  EXPECT_NEAR(shipped.plate.window.azimuth_half_width_rad, defaults.plate.window.azimuth_half_width_rad, 1e-4);
  EXPECT_EQ(shipped.plate.fit.method, defaults.plate.fit.method);
  EXPECT_EQ(shipped.plate.fit.min_tilts, defaults.plate.fit.min_tilts);
  EXPECT_EQ(shipped.plate.fit.min_amplitude_db, defaults.plate.fit.min_amplitude_db);
  EXPECT_EQ(shipped.plate.positioning_timeout_s, defaults.plate.positioning_timeout_s);
  EXPECT_EQ(shipped.plate.measuring_timeout_s, defaults.plate.measuring_timeout_s);
  EXPECT_EQ(shipped.plate.silence_timeout_s, defaults.plate.silence_timeout_s);
  EXPECT_EQ(shipped.plate.decision_timeout_s, defaults.plate.decision_timeout_s);
  EXPECT_EQ(shipped.plate.settle_s, defaults.plate.settle_s);
  EXPECT_NEAR(shipped.plate.tilt_tolerance_rad, defaults.plate.tilt_tolerance_rad, 1e-4);
  EXPECT_NEAR(shipped.seed.placement_yaw_std_rad, defaults.seed.placement_yaw_std_rad, 1e-5);
  EXPECT_NEAR(shipped.seed.placement_pitch_std_rad, defaults.seed.placement_pitch_std_rad, 1e-5);
}

}  // namespace
}  // namespace boresight::alignment::station
