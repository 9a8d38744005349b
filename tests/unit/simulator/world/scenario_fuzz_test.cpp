// Any text as a scenario file is refused with file and line, or gives a drive with finite numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/random.hpp"
#include "services/simulator/scenario/shipped.hpp"
#include "services/simulator/scenario_file.hpp"

namespace boresight::simulator {
namespace {

constexpr double kBrief_s = 0.1;

enum class Outcome { kRefused, kDriven };

/// Reads the text, and simulates a short drive if it is a scenario.
Outcome attempt(const std::string& text) {
  static const VehicleConfig vehicle =
      config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
  std::optional<Scenario> scenario;
  try {
    scenario = read_scenario(config::Reader::parse(text, "mutant.toml"));
  } catch (const config::Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("mutant.toml:")) << error.what();
    return Outcome::kRefused;
  }
  std::optional<Drive> drive;
  try {
    drive.emplace(*scenario, vehicle, 1, kBrief_s);
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("are allowed"), std::string::npos) << error.what();
    return Outcome::kRefused;
  }
  std::size_t scans = 0;
  while (const Event* event = drive->next()) {
    if (event->scan == nullptr) {
      EXPECT_TRUE(std::isfinite(event->ego.speed_mps) && std::isfinite(event->ego.yaw_rate_radps) &&
                  std::isfinite(event->ego.steering_angle_rad))
          << text;
      continue;
    }
    ++scans;
    const RadarScan& s = *event->scan;
    for (std::size_t i = 0; i < s.number_of_valid_detections; ++i) {
      const bool sound = std::isfinite(s.range_m[i]) && std::isfinite(s.azimuth_rad[i]) &&
                         std::isfinite(s.elevation_rad[i]) && std::isfinite(s.range_rate_mps[i]) &&
                         std::isfinite(s.rcs_dbsm[i]) && std::isfinite(s.range_rate_std_mps[i]);
      EXPECT_TRUE(sound) << i << "\n" << text;
      if (!sound) return Outcome::kDriven;
    }
  }
  EXPECT_EQ(scans, 7u) << text;
  return Outcome::kDriven;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// One random mutation of the text.
std::string mutated(std::string_view original, Stream& draw) {
  constexpr std::array<const char*, 26> kValues = {
      "nan",   "inf",   "-inf", "1e308", "-1e308", "1e-308", "0",     "0.0",       "-0.0",
      "-1",    "1",     "1e5",  "-1e5",  "89.9",   "-80.0",  "0.5",   "-0.5",      "9223372036854775807",
      "99999", "\"a\"", "true", "[]",    "{}",     "[[]]",   "1_000", "1979-05-27"};
  constexpr std::array<const char*, 12> kKeys = {"speed_mps",   "speed",  "lateral_m", "lateral",
                                                 "heading_deg", "per_m",  "spacing_m", "length_m",
                                                 "parked",      "repeat", "gaps",      "from_m"};
  const auto pick = [&](std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(draw.uniform() * static_cast<double>(n)));
  };
  std::vector<std::string> lines = lines_of(original);
  const std::size_t at = pick(lines.size());
  switch (pick(8)) {
    case 0:
    case 1:
    case 2: {  // another value at some number
      std::string text = joined(lines);
      const std::size_t from = text.find_first_of("0123456789", pick(text.size()));
      if (from == std::string::npos) return text;
      const std::size_t to = text.find_first_not_of("0123456789.e-", from);
      return text.replace(from, to - from, kValues.at(pick(kValues.size())));
    }
    case 3:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 4:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[pick(lines.size())]);
      break;
    case 5: {  // any byte
      std::string text = joined(lines);
      text[pick(text.size())] = static_cast<char>(pick(256));
      return text;
    }
    case 6:
      return joined(lines).substr(0, pick(original.size()));
    default:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at),
                   std::string(kKeys.at(pick(kKeys.size()))) + " = " + kValues.at(pick(kValues.size())));
  }
  return joined(lines);
}

TEST(ScenarioFuzz, AThousandMutantsAreRefusedOrDriven) {
  Stream draw(5, "mutants");
  std::size_t refused = 0, driven = 0;
  constexpr std::size_t kMutants = 1200;
  for (std::size_t i = 0; i < kMutants; ++i) {
    const ShippedFile& shipped = shipped_scenarios()[i % shipped_scenarios().size()];
    std::string text = mutated(shipped.text, draw);
    if (i % 3 == 0) text = mutated(text, draw);  // twice
    (attempt(text) == Outcome::kRefused ? refused : driven) += 1;
    if (HasFailure()) FAIL() << "mutant " << i << " of " << shipped.name << ":\n" << text;
  }
  std::printf("%zu refused, %zu driven\n", refused, driven);
  EXPECT_GT(refused, kMutants / 10);
  EXPECT_GT(driven, kMutants / 10);
}

TEST(ScenarioFuzz, ExtremesWithinTheBoundsAreDriven) {
  const std::string head = "name = \"x\"\n";
  for (const char* text : {
           "[ego]\nspeed_mps = 80.0\n[road]\nsegments = [{length_m = 0.1, curvature_per_m = 0.5}]\ntransition_m = "
           "0.1\n",
           "[ego]\nspeed_mps = -80.0\nstart_m = -100000.0\n",
           "[ego]\nlength_m = 0.5\nwidth_m = 0.3\nheight_m = 0.3\nrear_overhang_m = 10.0\n",
           "[ego]\nspeed_mps = 0.0\n",
           "[[body]]\nkind = \"truck\"\nstart_m = 0.0\n",  // in the ego vehicle
           "[[body]]\nkind = \"car\"\nstart_m = 5.0\nlength_m = 0.1\nwidth_m = 0.1\nheight_m = 0.1\n",
           "[road]\nsegments = [{length_m = 100.0, curvature_per_m = 0.1}]\n[[body]]\nkind = \"car\"\nstart_m = 50.0\n"
           "lateral_m = 10.0\nspeed_mps = 5.0\n",  // round the centre of the bend
           "[[structure]]\nkind = \"tunnel\"\nfrom_m = 0.0\nto_m = 100.0\nlateral_m = 0.0\nwidth_m = 0.0\n",
           "[[structure]]\nkind = \"pillars\"\nfrom_m = 0.0\nto_m = 100.0\nlateral_m = 3.0\nwidth_m = 0.0\n",
           "[[structure]]\nkind = \"wall\"\nfrom_m = 0.0\nto_m = 0.000001\nlateral_m = 3.0\n",
           "[[structure]]\nkind = \"wall\"\nfrom_m = -50.0\nto_m = 50.0\nlateral_m = 0.0\n",  // through the vehicle
           "[[scatter]]\nkind = \"columns\"\nfrom_m = -9.0\nto_m = 9.0\nlateral_min_m = 0.0\nlateral_max_m = "
           "0.0\nper_m = "
           "20.0\n",
           "[radars]\nunambiguous_mps = 0.000001\n",
           "[radars]\nclutter_per_scan = 200.0\ninterference = [{duration_s = 9.0, detections_per_scan = 200.0, "
           "noise_rise_db = 60.0}]\n",
           "[radars]\nsensitivity = {threshold_db = -120.0, max_detections = 800, rcs_fluctuation_db = 20.0}\n",
           "[radars]\nsensitivity = {threshold_db = 60.0, max_probability = 0.0}\n",
           "[radars]\nresolution = {range_m = 10.0, azimuth_deg = 30.0, range_rate_mps = 10.0}\n",
           "[radars]\nmultipath = {extra_loss_db = -30.0, bistatic_deg = 0.0, of_stationary = "
           "true}\n[[structure]]\nkind = "
           "\"wall\"\nfrom_m = -50.0\nto_m = 50.0\nlateral_m = 3.0\n[[structure]]\nkind = \"wall\"\nfrom_m = "
           "-50.0\nto_m = 50.0\nlateral_m = -3.0\n",
       }) {
    EXPECT_EQ(attempt(head + text), Outcome::kDriven) << text;
  }
}

TEST(ScenarioFuzz, ScenarioWithTooManyPointsIsRefused) {
  const std::string forest =
      "name = \"x\"\n[ego]\nstart_m = 50000.0\n[[scatter]]\nkind = \"columns\"\nfrom_m = 0.0\nto_m = 100000.0\n"
      "lateral_min_m = 1.0\nlateral_max_m = 200.0\nper_m = 20.0\ntop_max_m = 50.0\nspacing_m = 0.05\n";
  const Scenario s = read_scenario(config::Reader::parse(forest, "x.toml"));
  try {
    const World world(s, 1, 1000.0);
    ADD_FAILURE() << "built";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("scatter[0]"), std::string::npos) << error.what();
  }
  const std::string rail =
      "name = \"x\"\n[[structure]]\nkind = \"wall\"\nfrom_m = -100000.0\nto_m = 100000.0\nlateral_m = 3.0\nspacing_m = "
      "0.05\n[ego]\nspeed_mps = 80.0\n";
  EXPECT_NO_THROW(World(read_scenario(config::Reader::parse(rail, "x.toml")), 1, 10.0));
  EXPECT_NO_THROW(World(read_scenario(config::Reader::parse(rail, "x.toml")), 1, 36000.0));
}

}  // namespace
}  // namespace boresight::simulator
