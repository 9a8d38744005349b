#include "services/simulator/radar/returns/stationary_field.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::simulator::radar {

namespace {

constexpr double kReferenceView_rad = 140.0 / 180.0 * M_PI;  // view of the radars that were measured
constexpr double kHighest_m = 1.5;                           // of a point (choice: kerbs, posts, hedges, wall bases)
constexpr double kCellsPerReach = 3.0;                       // size of a cell: the layer's reach / this

constexpr double kHalfDiagonal = 0.7071067811865476;  // of a cell of size 1

std::uint64_t bits(std::int64_t value) {
  return static_cast<std::uint64_t>(value);
}

/// Whether a part of a circle may be within reach and within the azimuths in view; a quick test.
bool may_be_in_view(const Eigen::Vector2d& centre_m, double radius_m, double reach_m,
                    const Eigen::Matrix3d& world_to_sensor, const FieldOfView& fov) {
  const double range = centre_m.norm();
  if (range <= radius_m) return true;
  if (range - radius_m > reach_m) return false;
  const Eigen::Vector3d direction = world_to_sensor * Eigen::Vector3d(centre_m.x(), centre_m.y(), 0.0);
  // A mounting that is pitched or rolled shows azimuths a little otherwise, hence the margin.
  constexpr double kMargin_rad = 0.1;
  const double azimuth = std::atan2(direction.y(), direction.x());
  const double half = std::asin(radius_m / range) + kMargin_rad;
  if (M_PI - std::abs(azimuth) < half) return true;
  return azimuth + half >= fov.azimuth_min_rad && azimuth - half <= fov.azimuth_max_rad;
}

}  // namespace

StationaryField::StationaryField(const StationaryWorldSpec& spec) : spec_(spec) {
  // Density of detections in a ring = sum over the layers that reach it.
  const auto density = [&](std::size_t ring) {
    if (ring >= kRings) return 0.0;
    const double area = 0.5 * kReferenceView_rad * kRing_m * kRing_m * (2.0 * static_cast<double>(ring) + 1.0);
    return spec.per_ring[ring] / area;
  };
  const double per_patch = std::max(1e-3, spec.bright_share) * (1.0 + spec.neighbours);
  for (std::size_t k = 0; k < kRings; ++k) {
    density_per_m2_[k] = std::max(0.0, density(k) - density(k + 1)) / per_patch;
  }
}

void StationaryField::show(const Eigen::Vector2d& patch_m, std::uint64_t key, Stream& stream,
                           std::vector<FieldPoint>& points) const {
  const unsigned count = 1 + stream.poisson(spec_.neighbours);
  for (unsigned i = 0; i < count; ++i) {
    const double x = patch_m.x() + spec_.patch_std_m * stream.gaussian();
    const double y = patch_m.y() + spec_.patch_std_m * stream.gaussian();
    const double z = stream.uniform(0.0, kHighest_m);
    const double strength = stream.gaussian();
    points.push_back({{x, y, z}, strength, key_of(key, i)});
  }
}

void StationaryField::look(const Viewpoint& view, const Antenna& antenna, const EgoPose& ego, const Draws& draws,
                           std::vector<FieldPoint>& points) const {
  points.clear();
  const Eigen::Vector2d here = view.position_m.head<2>();
  const Eigen::Vector2d ahead(std::cos(ego.heading_rad), std::sin(ego.heading_rad));
  const FieldOfView& fov = antenna.view();
  const Eigen::Matrix3d world_to_sensor = view.sensor_to_world.transpose();
  const StreamSeed patches_of = draws.of("field"), bright = draws.of("bright");
  for (std::size_t layer = 0; layer < kRings; ++layer) {
    if (!(density_per_m2_[layer] > 0.0)) continue;
    const double reach = std::min(fov.range_max_m, kRing_m * static_cast<double>(layer + 1));
    const double cell = kRing_m * static_cast<double>(layer + 1) / kCellsPerReach;
    const double mean = density_per_m2_[layer] * cell * cell;
    const auto first = [&](double at) { return static_cast<std::int64_t>(std::floor((at - reach) / cell)); };
    const auto last = [&](double at) { return static_cast<std::int64_t>(std::floor((at + reach) / cell)); };
    for (std::int64_t ix = first(here.x()); ix <= last(here.x()); ++ix) {
      for (std::int64_t iy = first(here.y()); iy <= last(here.y()); ++iy) {
        const std::uint64_t key = key_of(key_of(layer, bits(ix)), bits(iy));
        if (!may_be_in_view(Eigen::Vector2d(static_cast<double>(ix) + 0.5, static_cast<double>(iy) + 0.5) * cell - here,
                            kHalfDiagonal * cell, reach, world_to_sensor, fov)) {
          continue;
        }
        Stream stream(patches_of, key, 0);
        const unsigned patches = stream.poisson(mean);
        for (unsigned n = 0; n < patches; ++n) {
          const Eigen::Vector2d patch((static_cast<double>(ix) + stream.uniform()) * cell,
                                      (static_cast<double>(iy) + stream.uniform()) * cell);
          const Eigen::Vector2d sight = patch - here;
          if (sight.squaredNorm() > reach * reach) continue;
          const Eigen::Vector2d from_ego = patch - ego.position_m;
          const double aside = ahead.x() * from_ego.y() - ahead.y() * from_ego.x();
          if (std::abs(aside) < spec_.path_half_width_m) continue;
          // Most patches are dark, and this test costs less than the next.
          Stream shown = draws.held(bright, key_of(key, n), spec_.seen_again);
          if (shown.uniform() >= spec_.bright_share) continue;
          const Eigen::Vector3d direction = world_to_sensor * Eigen::Vector3d(sight.x(), sight.y(), 0.0);
          const double azimuth = std::atan2(direction.y(), direction.x());
          if (azimuth < fov.azimuth_min_rad || azimuth > fov.azimuth_max_rad) continue;
          show(patch, key_of(key, n), shown, points);
        }
      }
    }
  }
}

}  // namespace boresight::simulator::radar
