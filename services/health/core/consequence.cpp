#include "services/health/core/consequence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::health {

namespace {

// Cells of the grid on the field of view. Cells at the edge count by their covered part, so few suffice.
constexpr int kAzimuthCells = 64;
constexpr int kElevationCells = 16;
/// Share of a cell: without a mounting error, cells at the edge are covered despite rounding.
constexpr double kRounding = 1e-9;

double azimuth_of(const Eigen::Vector3d& direction) {
  return std::atan2(direction.y(), direction.x());
}
double elevation_of(const Eigen::Vector3d& direction) {
  return std::asin(std::clamp(direction.z(), -1.0, 1.0));
}

/// An interval of angles by its middle and its half width.
struct Span {
  double middle_rad;
  double half_rad;

  Span(double min_rad, double max_rad) : middle_rad(0.5 * (min_rad + max_rad)), half_rad(0.5 * (max_rad - min_rad)) {}
  /// Distance of the angle from the middle, on the circle.
  [[nodiscard]] double distance(double angle_rad) const {
    return std::abs(geometry::wrap_angle(angle_rad - middle_rad));
  }
  [[nodiscard]] bool contains(double angle_rad) const { return distance(angle_rad) <= half_rad; }
  /// Share of a cell of that width around the angle that is inside; a whole circle has no edge.
  [[nodiscard]] double covered(double angle_rad, double width_rad) const {
    if (half_rad > std::numbers::pi - 1e-6) return 1.0;
    return std::clamp(0.5 + (half_rad - distance(angle_rad)) / width_rad + kRounding, 0.0, 1.0);
  }
};

/// Two-way attenuation (dB) of the antenna's main lobe relative to boresight (D6).
double two_way_loss_db(const AntennaLobe& lobe, const Eigen::Vector3d& direction) {
  const double half_power_db = 10.0 * std::log10(2.0);  // one way, at half the width
  const double azimuth = 2.0 * azimuth_of(direction) / lobe.azimuth_width_rad;
  const double elevation = 2.0 * elevation_of(direction) / lobe.elevation_width_rad;
  return 2.0 * half_power_db * (azimuth * azimuth + elevation * elevation);
}

}  // namespace

double lateral_displacement_m(double range_m, double yaw_error_rad) {
  return range_m * std::sin(yaw_error_rad);
}

SightLoss sight_loss(const Sight& sight, const Eigen::Matrix3d& actual) {
  const MountingPose& pose = sight.mounting_pose;
  const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(pose, 0.0, 0.0, 0.0);
  const Eigen::Matrix3d turn = actual.transpose() * nominal;  // nominal → actual sensor axes
  const FieldOfView& view = sight.field_of_view;
  const RegionOfInterest& region = sight.region_of_interest;
  const Span azimuths(view.azimuth_min_rad, view.azimuth_max_rad);
  const Span elevations(view.elevation_min_rad, view.elevation_max_rad);
  const Span region_azimuths(region.azimuth_min_rad, region.azimuth_max_rad);
  const Span region_elevations(region.elevation_min_rad, region.elevation_max_rad);
  const double azimuth_step = 2.0 * azimuths.half_rad / kAzimuthCells;
  const double elevation_step = 2.0 * elevations.half_rad / kElevationCells;
  double needed = 0.0, covered = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (int row = 0; row < kElevationCells; ++row) {
    const double elevation = view.elevation_min_rad + (row + 0.5) * elevation_step;
    const double solid_angle = std::cos(elevation);  // relative to that of a cell at the horizon
    for (int column = 0; column < kAzimuthCells; ++column) {
      const Eigen::Vector3d seen = geometry::direction(view.azimuth_min_rad + (column + 0.5) * azimuth_step, elevation);
      const Eigen::Vector3d in_vehicle = nominal * seen;
      if (!region_azimuths.contains(azimuth_of(in_vehicle)) || !region_elevations.contains(elevation_of(in_vehicle))) {
        continue;
      }
      const Eigen::Vector3d turned = turn * seen;
      needed += solid_angle;
      covered += solid_angle * azimuths.covered(azimuth_of(turned), azimuth_step) *
                 elevations.covered(elevation_of(turned), elevation_step);
      middle += solid_angle * seen;
    }
  }
  if (!(needed > 0.0)) return {};
  SightLoss loss;
  loss.coverage_ratio = std::max(0.0, 1.0 - covered / needed);
  // A region all around has no middle: boresight stands in.
  const Eigen::Vector3d axis = middle.norm() > 1e-3 * needed ? middle.normalized() : Eigen::Vector3d::UnitX();
  const double loss_db = two_way_loss_db(sight.antenna, turn * axis) - two_way_loss_db(sight.antenna, axis);
  loss.range_ratio = 1.0 - std::pow(10.0, -loss_db / 40.0);
  return loss;
}

double velocity_error_mps(double speed_mps, double yaw_error_rad) {
  return 2.0 * std::abs(speed_mps * std::sin(0.5 * yaw_error_rad));
}

Eigen::Matrix3d actual_mounting(const MountingPose& nominal, const AlignmentEstimate& estimate) {
  const auto value = [&estimate](std::uint32_t axis, float angle_rad) {
    return estimate.is_observable(axis) && std::isfinite(angle_rad) ? static_cast<double>(angle_rad) : 0.0;
  };
  using namespace alignment_axis;
  const auto observable = [&estimate](std::uint32_t axis) { return estimate.is_observable(axis) ? 1 : 0; };
  const int by_sensor = observable(kYaw) + observable(kPitch) + observable(kRoll);
  const int by_vehicle = observable(kVehicleYaw) + observable(kVehiclePitch) + observable(kVehicleRoll);
  if (by_sensor >= by_vehicle) {
    return geometry::sensor_to_vehicle(nominal, value(kYaw, estimate.alignment_yaw_rad),
                                       value(kPitch, estimate.alignment_pitch_rad),
                                       value(kRoll, estimate.alignment_roll_rad));
  }
  return geometry::fixed_axes_rotation(value(kVehicleYaw, estimate.vehicle_yaw_rad),
                                       value(kVehiclePitch, estimate.vehicle_pitch_rad),
                                       value(kVehicleRoll, estimate.vehicle_roll_rad)) *
         geometry::sensor_to_vehicle(nominal, 0.0, 0.0, 0.0);
}

}  // namespace boresight::health
