#include "services/simulator/car/radar_of_car.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/random.hpp"

namespace boresight::simulator::car {

namespace {

AzimuthCurve draw_curve(double rms_rad, std::uint64_t seed, std::uint32_t radar, const FieldOfView& view) {
  AzimuthCurve curve;
  curve.rms_rad = rms_rad;
  curve.middle_rad = 0.5 * (view.azimuth_min_rad + view.azimuth_max_rad);
  curve.half_width_rad = 0.5 * (view.azimuth_max_rad - view.azimuth_min_rad);
  if (rms_rad == 0.0) return curve;
  Stream stream(seed, "real car azimuth curve", radar);
  double square = 0.0;
  for (std::size_t i = 0; i < AzimuthCurve::kHarmonics; ++i) {
    const double size = 1.0 / static_cast<double>(i + 1);  // smooth: higher harmonics are smaller
    for (double* const amplitude : {&curve.cos_rad[i], &curve.sin_rad[i]}) {
      *amplitude = size * stream.gaussian();
      square += 0.5 * *amplitude * *amplitude;
    }
  }
  for (std::size_t i = 0; i < AzimuthCurve::kHarmonics; ++i) {
    for (double* const amplitude : {&curve.cos_rad[i], &curve.sin_rad[i]}) *amplitude *= rms_rad / std::sqrt(square);
  }
  return curve;
}

}  // namespace

double AzimuthCurve::error_rad(double azimuth_rad) const {
  if (rms_rad == 0.0) return 0.0;
  const double phase = M_PI * std::clamp((azimuth_rad - middle_rad) / half_width_rad, -1.0, 1.0);
  double error = 0.0;
  for (std::size_t i = 0; i < kHarmonics; ++i) {
    const double of_harmonic = static_cast<double>(i + 1) * phase;
    error += cos_rad[i] * std::cos(of_harmonic) + sin_rad[i] * std::sin(of_harmonic);
  }
  return error;
}

MountingPose RadarOfCar::true_position(MountingPose nominal) const {
  for (std::size_t i = 0; i < 3; ++i) nominal.position_m[i] += position_error_m[i];
  return nominal;
}

std::int64_t RadarOfCar::stamp_offset_ns() const {
  return std::llround(stamp_offset_s * 1e9);
}

RadarOfCar radar_of_car(const RealCar& car, std::uint64_t seed, std::uint32_t radar, const FieldOfView& view) {
  RadarOfCar out;
  if (car.range_rate_scale != 0.0) {
    out.range_rate_scale += car.range_rate_scale * Stream(seed, "real car range-rate scale", radar).uniform(-1.0, 1.0);
  }
  out.curve = draw_curve(car.azimuth_curve_rms_rad, seed, radar, view);
  if (car.position_error_m != 0.0) {
    const double direction_rad = Stream(seed, "real car position", radar).uniform(-M_PI, M_PI);
    out.position_error_m = {car.position_error_m * std::cos(direction_rad),
                            car.position_error_m * std::sin(direction_rad), 0.0};
  }
  constexpr double kTick_s = 1e-4;  // what the tables of an alignment drive resolve
  const double offset_s = car.stamp_offset_s * Stream(seed, "real car stamps", radar).uniform(0.5, 1.0);
  out.stamp_offset_s = kTick_s * std::round(offset_s / kTick_s);
  return out;
}

std::optional<Eigen::Vector3d> mirrored_by_road(const Eigen::Vector3d& direction, double range_m,
                                                double sensor_height_m) {
  const double height_m = sensor_height_m + range_m * direction.z();
  if (height_m < 0.0 || height_m > kLowReflector_m || sensor_height_m <= 0.0) return std::nullopt;
  const double z = -(height_m + sensor_height_m) / range_m;
  const double across = direction.head<2>().norm();
  if (z <= -1.0 || across <= 0.0) return std::nullopt;
  const Eigen::Vector2d horizontal = direction.head<2>() * (std::sqrt(1.0 - z * z) / across);
  return Eigen::Vector3d(horizontal.x(), horizontal.y(), z);
}

}  // namespace boresight::simulator::car
