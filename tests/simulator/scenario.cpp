#include "tests/simulator/scenario.hpp"

#include <cmath>
#include <stdexcept>

namespace boresight::simulator {

namespace {

constexpr double kDegree = M_PI / 180.0;

std::vector<VehicleSpec> traffic() {
  std::vector<VehicleSpec> vehicles = {
      {35.0, 0.0, 15.5, 4.5, 1.9},    // ahead in the ego lane
      {-30.0, 0.0, 14.8, 4.7, 1.9},   // behind
      {-60.0, -3.5, 18.0, 4.4, 1.8},  // overtakes on the right lane
      {15.0, -3.5, 12.5, 8.0, 2.5},   // a truck that is overtaken
  };
  for (int i = 0; i < 12; ++i) vehicles.push_back({120.0 + 110.0 * i, 3.5, -14.0, 4.5, 1.9});  // oncoming
  return vehicles;
}

Scenario aligned_drive() {
  Scenario s;
  s.name = "aligned_drive";
  s.vehicles = traffic();
  return s;
}

Scenario demo_drive() {
  Scenario s = aligned_drive();
  s.name = "demo_drive";
  s.speed_scale = 1.012;
  s.misalignment[1] = {0.3 * kDegree, -0.2 * kDegree, 0.1 * kDegree};
  s.misalignment[2] = {2.5 * kDegree, 0.4 * kDegree, 0.0};
  s.misalignment[3] = {-0.25 * kDegree, 0.1 * kDegree, -0.2 * kDegree};
  s.misalignment[4] = {0.15 * kDegree, 0.3 * kDegree, 0.2 * kDegree};
  return s;
}

Scenario straight_rail() {
  Scenario s;
  s.name = "straight_rail";
  s.curvature = 0.0;
  s.speed_swing_mps = 0.0;
  s.vehicles = {{30.0, 0.0, 17.0, 4.5, 1.9}, {60.0, 3.5, -15.0, 4.5, 1.9}};
  return s;
}

}  // namespace

std::vector<std::string> scenario_names() {
  return {"demo_drive", "aligned_drive", "straight_rail"};
}

Scenario scenario(std::string_view name) {
  if (name == "demo_drive") return demo_drive();
  if (name == "aligned_drive") return aligned_drive();
  if (name == "straight_rail") return straight_rail();
  std::string known;
  for (const std::string& n : scenario_names()) known += (known.empty() ? "" : ", ") + n;
  throw std::invalid_argument("scenario \"" + std::string(name) + "\" is unknown; known: " + known);
}

}  // namespace boresight::simulator
