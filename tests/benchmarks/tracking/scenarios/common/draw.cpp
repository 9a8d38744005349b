#include "tests/benchmarks/tracking/scenarios/common/draw.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/simulator/random.hpp"

namespace boresight::bench::scenarios {

namespace {

using simulator::Stream;
using track::ExtendedObject;
using track::MeasuredPoint;

Eigen::Matrix2d scatter_of(const ExtendedObject& object, const tracking::LinearScenario& model) {
  return model.spread * object.ellipse.extent_m2 + model.noise_variance_m2 * Eigen::Matrix2d::Identity();
}

Eigen::Vector2d uniform_in_area(const tracking::LinearScenario& model, Stream& random) {
  const double x_m = random.uniform(model.area_min_m.x(), model.area_max_m.x());
  return {x_m, random.uniform(model.area_min_m.y(), model.area_max_m.y())};
}

/// Fisher and Yates.
template <typename... Vectors>
void shuffle(Stream& random, std::size_t size, Vectors&... vectors) {
  for (std::size_t i = size; i > 1; --i) {
    const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
    (std::swap(vectors[i - 1], vectors[j]), ...);
  }
}

}  // namespace

Measurements draw_measurements(const Scenario& scenario, std::uint64_t seed) {
  const tracking::LinearScenario& model = scenario.model;
  Measurements drawn;
  for (std::size_t step = 0; step < scenario.truth.size(); ++step) {
    std::vector<MeasuredPoint>& points = drawn.scans.emplace_back();
    std::vector<std::uint32_t>& origins = drawn.origins.emplace_back();
    for (const ExtendedObject& object : scenario.truth[step]) {
      Stream random(seed, "detections", step, object.id);
      if (random.uniform() >= model.detection_probability) continue;
      const Eigen::Matrix2d root = scatter_of(object, model).llt().matrixL();
      for (unsigned n = random.poisson(scenario.detections_per_scan.at(object.id)); n > 0; --n) {
        const double first = random.gaussian(), second = random.gaussian();
        points.push_back({object.ellipse.centre_m + root * Eigen::Vector2d(first, second), kNaN});
        origins.push_back(object.id);
      }
    }
    Stream random(seed, "clutter", step);
    for (unsigned n = random.poisson(model.clutter_per_scan); n > 0; --n) {
      points.push_back({uniform_in_area(model, random), kNaN});
      origins.push_back(0);
    }
    shuffle(random, points.size(), points, origins);
  }
  if (model.range_rate_std_mps > 0.0) add_range_rates(scenario, seed, drawn);
  return drawn;
}

void add_range_rates(const Scenario& scenario, std::uint64_t seed, Measurements& measurements) {
  const double half_span_mps = 0.5 * scenario.model.clutter_range_rate_span_mps;
  for (std::size_t step = 0; step < measurements.scans.size(); ++step) {
    std::map<std::uint32_t, Eigen::Vector2d> velocity_mps;
    for (const ExtendedObject& object : scenario.truth[step]) velocity_mps[object.id] = object.velocity_mps;
    Stream random(seed, "range_rates", step);
    for (std::size_t i = 0; i < measurements.scans[step].size(); ++i) {
      MeasuredPoint& point = measurements.scans[step][i];
      const std::uint32_t origin = measurements.origins[step][i];
      point.range_rate_mps = origin == 0 ? random.uniform(-half_span_mps, half_span_mps)
                                         : point.position_m.normalized().dot(velocity_mps.at(origin)) +
                                               scenario.model.range_rate_std_mps * random.gaussian();
    }
  }
}

void draw_origins(const Scenario& scenario, std::uint64_t seed, Measurements& measurements) {
  const tracking::LinearScenario& model = scenario.model;
  const double clutter_per_m2 = model.clutter_per_scan / (model.area_max_m - model.area_min_m).prod();
  measurements.origins.assign(measurements.scans.size(), {});
  for (std::size_t step = 0; step < measurements.scans.size(); ++step) {
    Stream random(seed, "origins", step);
    for (const MeasuredPoint& point : measurements.scans[step]) {
      std::vector<std::pair<std::uint32_t, double>> densities = {{0, clutter_per_m2}};
      double sum = clutter_per_m2;
      for (const ExtendedObject& object : scenario.truth[step]) {
        const Eigen::Matrix2d scatter_m2 = scatter_of(object, model);
        const Eigen::Vector2d offset_m = point.position_m - object.ellipse.centre_m;
        const double squared = offset_m.dot(scatter_m2.inverse() * offset_m);
        const double expected = model.detection_probability * scenario.detections_per_scan.at(object.id);
        const double per_m2 =
            expected * std::exp(-0.5 * squared) / (2.0 * std::numbers::pi * std::sqrt(scatter_m2.determinant()));
        densities.emplace_back(object.id, per_m2);
        sum += per_m2;
      }
      double rest = random.uniform() * sum;
      std::size_t pick = 0;
      while (pick + 1 < densities.size() && rest >= densities[pick].second) rest -= densities[pick++].second;
      measurements.origins[step].push_back(densities[pick].first);
    }
  }
}

}  // namespace boresight::bench::scenarios
