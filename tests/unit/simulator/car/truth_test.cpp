// Keys, preset and truth of the effects of a real car.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/simulator/alignment/csv_writer.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/car/radar_of_car.hpp"
#include "services/simulator/drive_writer.hpp"
#include "services/simulator/scenario/read_real_car.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::simulator {
namespace {

car::RealCar read(const std::string& text) {
  config::Reader reader = config::Reader::parse(text, "x.toml");
  const car::RealCar car = read_real_car(reader);
  reader.finish();
  return car;
}

void expect_alike(const car::RealCar& a, const car::RealCar& b) {
  EXPECT_DOUBLE_EQ(a.range_rate_scale, b.range_rate_scale);
  EXPECT_DOUBLE_EQ(a.azimuth_curve_rms_rad, b.azimuth_curve_rms_rad);
  EXPECT_DOUBLE_EQ(a.position_error_m, b.position_error_m);
  EXPECT_DOUBLE_EQ(a.stamp_offset_s, b.stamp_offset_s);
  EXPECT_DOUBLE_EQ(a.side_slip_std_rad, b.side_slip_std_rad);
  EXPECT_DOUBLE_EQ(a.side_slip_correlation_s, b.side_slip_correlation_s);
  EXPECT_DOUBLE_EQ(a.slip_coefficient_radps2pm, b.slip_coefficient_radps2pm);
  EXPECT_DOUBLE_EQ(a.load_pitch_rad, b.load_pitch_rad);
  EXPECT_DOUBLE_EQ(a.load_time_s, b.load_time_s);
  EXPECT_DOUBLE_EQ(a.yaw_rate_gain, b.yaw_rate_gain);
  EXPECT_DOUBLE_EQ(a.yaw_rate_bias_radps, b.yaw_rate_bias_radps);
  EXPECT_DOUBLE_EQ(a.speed_step_mps, b.speed_step_mps);
  EXPECT_DOUBLE_EQ(a.road_mirror_share, b.road_mirror_share);
}

TEST(RealCarKeys, PresetHasTheSizesOfItsPage) {
  const std::string page = schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/schema/scenario.md");
  std::string text;
  std::size_t keys = 0;
  const auto sections = schema_page::sections(page);
  for (const schema_page::Cells& row : sections.at("preset real_car")) {
    if (schema_page::code(row[0]).empty()) continue;
    text += schema_page::code(row[0]) + " = " + schema_page::code(row[1]) + "\n";
    ++keys;
    EXPECT_TRUE(row[3] == "measured" || row[3] == "plausible") << row[0];
  }
  EXPECT_EQ(keys, 11U);
  expect_alike(read(text), car::real_car_preset());
  expect_alike(read("preset = \"real_car\""), car::real_car_preset());
}

TEST(RealCarKeys, AKeyOverridesThePreset) {
  const car::RealCar car = read("preset = \"real_car\"\nrange_rate_scale = 0.0\nload_time_s = 3.0");
  EXPECT_EQ(car.range_rate_scale, 0.0);
  EXPECT_EQ(car.load_time_s, 3.0);
  EXPECT_EQ(car.position_error_m, car::real_car_preset().position_error_m);
  EXPECT_EQ(read("preset = \"none\""), car::RealCar{});
}

class Folder {
 public:
  Folder() : path_(std::filesystem::path(testing::TempDir()) / ("boresight_real_car_" + std::to_string(getpid()))) {}
  ~Folder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

using Rows = std::map<std::pair<std::string, std::string>, double>;  // by quantity and radar

Rows rows_of_world(const std::filesystem::path& file) {
  Rows rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string quantity, radar, value;
    std::getline(cells, quantity, ',');
    std::getline(cells, radar, ',');
    std::getline(cells, value, ',');
    rows[{quantity, radar}] = std::stod(value);
  }
  return rows;
}

Rows rows_of_tables(const std::filesystem::path& file) {
  Rows rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind, quantity, unit, word, radar;
    double value = 0.0;
    words >> kind >> quantity >> value >> unit >> word >> radar;
    if (kind == "real_car") rows[{quantity, radar}] = value;
  }
  return rows;
}

TEST(RealCarTruth, BothSimulatorsStateTheSameEffects) {
  const Folder folder;
  AlignmentSpec spec = four_corner_radars();
  spec.seed = 4;
  spec.duration_s = 0.3;
  spec.real_car = car::real_car_preset();
  const VehicleConfig vehicle = AlignmentDrive(spec).vehicle();
  Scenario s = scenario("truck_overtaking");
  s.effects.real_car = spec.real_car;
  const auto silent = [](double) {};
  const Rows of_world = rows_of_world(write_drive(s, vehicle, 4, 0.3, folder / "world", silent).truth);
  const Rows of_tables = rows_of_tables(write_alignment_drive(spec, folder / "tables", silent).truth);
  ASSERT_EQ(of_tables.size(), 9U + 4U * 11U);
  for (const auto& [name, value] : of_tables) {
    ASSERT_TRUE(of_world.contains(name)) << name.first << " " << name.second;
    EXPECT_EQ(of_world.at(name), value) << name.first << " " << name.second;
  }
  const car::RadarOfCar third = car::radar_of_car(spec.real_car, 4, 3, vehicle.radar(3)->field_of_view);
  EXPECT_NEAR(of_world.at({"range_rate_scale", "3"}), third.range_rate_scale, 1e-8);
  EXPECT_NEAR(of_world.at({"position_error_x", "3"}), third.position_error_m[0], 1e-8);
  EXPECT_NEAR(of_world.at({"stamp_offset", "3"}), third.stamp_offset_s, 1e-8);
  EXPECT_NEAR(of_world.at({"load_pitch", ""}), 0.5, 1e-8);
  EXPECT_EQ(of_world.at({"alignment_pitch", "3"}), 0.0) << "load is no mounting error";
}

TEST(RealCarTruth, EffectsThatAreOffHaveNoRow) {
  const Folder folder;
  AlignmentSpec spec = four_corner_radars();
  spec.duration_s = 0.3;
  const auto silent = [](double) {};
  EXPECT_TRUE(rows_of_tables(write_alignment_drive(spec, folder / "tables", silent).truth).empty());
  const VehicleConfig vehicle = AlignmentDrive(spec).vehicle();
  const Rows rows =
      rows_of_world(write_drive(scenario("truck_overtaking"), vehicle, 4, 0.3, folder / "world", silent).truth);
  EXPECT_EQ(rows.size(), 2U + 4U * 4U) << "seed, speed scale; alignment and scans of each radar";
}

}  // namespace
}  // namespace boresight::simulator
