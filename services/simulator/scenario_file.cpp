#include "services/simulator/scenario_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "services/simulator/road.hpp"
#include "services/simulator/scenario/reading.hpp"
#include "services/simulator/scenario/shipped.hpp"

namespace boresight::simulator {

namespace {

/// A body beyond the centre of a bend would reverse its direction; such an offset is a mistake in the scenario.
bool passes_the_centre(const RoadSpec& road, const Knots& lateral_m, double from_m, double to_m) {
  constexpr double kStep_m = 1.0;
  constexpr double kLongest_m = 5000.0;
  double most_m = 0.0;
  for (const Knot& k : lateral_m) most_m = std::max(most_m, std::abs(k.value));
  to_m = std::min(to_m, from_m + kLongest_m);
  for (double at = from_m; at <= to_m; at += kStep_m) {
    if (std::abs(curvature_at(road, at)) * most_m > 0.9) return true;
  }
  return false;
}

bool is_file(std::string_view name) {
  return name.find('/') != std::string_view::npos || name.ends_with(".toml");
}

}  // namespace

Scenario read_scenario(config::Reader root) {
  Scenario s;
  root.require("name");
  s.name = root.text("name", "");
  s.about = root.text("about", "");
  s.vehicle = root.text("vehicle", "");
  s.duration_s = root.number("duration_s", {0.1, 36000.0}, s.duration_s);
  s.road = read_road(root.table("road"));
  config::Reader ego = root.table("ego");
  s.ego = read_ego(ego);
  for (config::Reader& r : root.tables("structure")) s.structures.push_back(read_structure(r));
  for (config::Reader& r : root.tables("scatter")) s.scatter.push_back(read_scatter(r));
  for (config::Reader& r : root.tables("body")) read_body(r, s.bodies);
  s.effects = read_effects(root.table("radars"));
  double length_m = 0.0;
  for (const RoadSegment& segment : s.road.segments) length_m += segment.length_m;
  if (passes_the_centre(s.road, s.ego.lateral_m, s.ego.start_m, s.ego.start_m + length_m)) {
    ego.reject("", "drives beyond the centre of a bend: its lateral offset is too large for the road");
  }
  root.finish();
  return s;
}

std::vector<std::string> scenario_names() {
  std::vector<std::string> names;
  for (const ShippedFile& shipped : shipped_scenarios()) names.emplace_back(shipped.name);
  return names;
}

Scenario scenario(std::string_view name_or_file) {
  if (is_file(name_or_file)) return read_scenario(config::Reader::open(std::filesystem::path(name_or_file)));
  std::string known;
  for (const ShippedFile& shipped : shipped_scenarios()) {
    if (shipped.name == name_or_file) {
      return read_scenario(
          config::Reader::parse(shipped.text, "config/scenarios/" + std::string(shipped.name) + ".toml"));
    }
    known += (known.empty() ? "" : ", ") + std::string(shipped.name);
  }
  throw std::invalid_argument("scenario \"" + std::string(name_or_file) + "\" is unknown; known: " + known +
                              "; name your own file by its path, such as ./my.toml");
}

}  // namespace boresight::simulator
