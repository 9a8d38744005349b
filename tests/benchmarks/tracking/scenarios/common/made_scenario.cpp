#include "tests/benchmarks/tracking/scenarios/common/made_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "services/simulator/random.hpp"

namespace boresight::bench::scenarios {

namespace {

constexpr double kHalfArea_m = 150.0, kHalfStart_m = 110.0;
constexpr double kDetectionsPerScan = 8.0;
constexpr double kApart_m = 12.0;  // at the start

tracking::LinearScenario model_of(double clutter_per_scan) {
  tracking::LinearScenario model;
  model.step_s = 0.1;
  model.acceleration_density = 2.0;
  model.detection_probability = 0.9;
  model.spread = 0.25;
  model.noise_variance_m2 = 0.09;
  model.clutter_per_scan = clutter_per_scan;
  model.area_min_m = {-kHalfArea_m, -kHalfArea_m};
  model.area_max_m = {kHalfArea_m, kHalfArea_m};
  constexpr double kGrid_m = 80.0;
  for (const double x_m : {-kGrid_m, 0.0, kGrid_m}) {
    for (const double y_m : {-kGrid_m, 0.0, kGrid_m}) {
      tracking::ScenarioBirth birth;
      birth.mean = {x_m, y_m, 0.0, 0.0};
      birth.std = {50.0, 50.0, 6.0, 6.0};
      birth.extent_scale = 42.0 * Eigen::Matrix2d::Identity();  // E[X] = 3 m² · I
      model.births.push_back(birth);
    }
  }
  return model;
}

/// A car of 4.6 m × 1.8 m that drives straight on.
struct Car {
  Eigen::Vector2d start_m, velocity_mps;
  [[nodiscard]] track::ExtendedObject at(double time_s, std::uint32_t id) const {
    constexpr double kLength_m = 4.6, kWidth_m = 1.8;
    const double heading_rad = std::atan2(velocity_mps.y(), velocity_mps.x());
    return {judge::ellipse_in_box(start_m + time_s * velocity_mps, heading_rad, kLength_m, kWidth_m), velocity_mps, id};
  }
};

std::vector<Car> draw_cars(std::size_t number, std::uint64_t seed) {
  constexpr double kSlowest_mps = 1.0, kFastest_mps = 8.0;
  constexpr std::size_t kMostDraws = 100'000;
  simulator::Stream random(seed, "cars");
  std::vector<Car> cars;
  for (std::size_t draw = 0; cars.size() < number; ++draw) {
    if (draw == kMostDraws) throw std::invalid_argument("there is no room for so many cars");
    Car car;
    car.start_m.x() = random.uniform(-kHalfStart_m, kHalfStart_m);
    car.start_m.y() = random.uniform(-kHalfStart_m, kHalfStart_m);
    const double heading_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    car.velocity_mps =
        random.uniform(kSlowest_mps, kFastest_mps) * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
    if (std::all_of(cars.begin(), cars.end(),
                    [&](const Car& other) { return (other.start_m - car.start_m).norm() > kApart_m; })) {
      cars.push_back(car);
    }
  }
  return cars;
}

}  // namespace

Scenario make_scenario(std::size_t targets, std::size_t measurements, std::size_t scans, std::uint64_t seed) {
  Scenario scenario;
  scenario.name = std::to_string(targets) + " targets, " + std::to_string(measurements) + " measurements";
  scenario.model = model_of(1.0);
  const double of_targets = static_cast<double>(targets) * kDetectionsPerScan * scenario.model.detection_probability;
  scenario.model.clutter_per_scan = static_cast<double>(measurements) - of_targets;
  if (scenario.model.clutter_per_scan <= 0.0) throw std::invalid_argument("the targets have more measurements");
  const std::vector<Car> cars = draw_cars(targets, seed);
  for (std::size_t step = 1; step <= scans; ++step) {
    std::vector<track::ExtendedObject>& objects = scenario.truth.emplace_back();
    for (std::uint32_t id = 1; id <= cars.size(); ++id) {
      objects.push_back(cars[id - 1].at(static_cast<double>(step) * scenario.model.step_s, id));
      scenario.detections_per_scan[id] = kDetectionsPerScan;
    }
  }
  return scenario;
}

}  // namespace boresight::bench::scenarios
