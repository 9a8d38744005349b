// Scans made by hand: the sensor at the origin looks along x.
#pragma once

#include <cmath>
#include <cstdint>

#include "tests/benchmarks/realism/common/observed_scan.hpp"

namespace boresight::bench::realism {

inline constexpr double kCycle_s = 0.08;

[[nodiscard]] inline ObservedScan scan_of(std::uint64_t number) {
  ObservedScan scan;
  scan.t_s = static_cast<double>(number) * kCycle_s;
  scan.radar = 1;
  scan.number = number;
  scan.view_rad = 2.0;
  scan.range_max_m = 100.0;
  return scan;
}

[[nodiscard]] inline ObservedObject car_at(std::uint32_t id, double range_m) {
  ObservedObject car;
  car.id = id;
  car.length_m = 4.0;
  car.width_m = 2.0;
  car.position_m = {range_m + 2.0, 0.0};
  car.range_m = range_m;
  return car;
}

/// A stationary detection at a place.
[[nodiscard]] inline ObservedDetection at(double x_m, double y_m) {
  ObservedDetection d;
  d.position_m = {x_m, y_m};
  d.range_m = std::hypot(x_m, y_m);
  d.azimuth_rad = std::atan2(y_m, x_m);
  return d;
}

[[nodiscard]] inline ObservedDetection of_car(std::uint32_t id, double x_m, double y_m) {
  ObservedDetection d = at(x_m, y_m);
  d.provenance = Provenance::kMoving;
  d.object = id;
  d.deviation_mps = 5.0;
  d.rigid_deviation_mps = 0.0;
  d.body_radial_mps = 5.0;
  return d;
}

[[nodiscard]] inline ObservedDetection false_mover_at(double x_m, double y_m, double deviation_mps) {
  ObservedDetection d = at(x_m, y_m);
  d.provenance = Provenance::kClutter;
  d.deviation_mps = deviation_mps;
  d.range_rate_mps = deviation_mps;
  return d;
}

}  // namespace boresight::bench::realism
