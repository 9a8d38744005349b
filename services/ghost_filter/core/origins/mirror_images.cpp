#include "services/ghost_filter/core/origins/mirror_images.hpp"

#include <cmath>

namespace boresight::ghosts {

namespace {

/// Images of one object in one mirror.
void add_images(const KnownObject& o, const Mirror& mirror, const MirrorPath& path, const SightOfImages& sight,
                std::vector<MirrorImage>& images) {
  const extended_object::OrientedBox& box = o.observed.box;
  const Eigen::Vector2d direct = box.centre_m - sight.sensor_m;
  const double direct_m = direct.norm(), mirrored_m = path.first_m + path.second_m;
  if (!(direct_m > 0.0)) return;
  const Eigen::Vector2d e = direct / direct_m, of_image = mirrored_m * path.departure;
  const double bent_m = 0.5 * (mirrored_m + direct_m);
  const double shift = mirror.offset_variance_m2(path.arc_m), turn = mirror.turn_variance_rad2;
  const double of_mirror = 4.0 * shift + 4.0 * path.second_m * path.second_m * turn;
  const double half_width_m =
      box.half_size_m().norm() + kReachStds * std::sqrt(of_mirror + o.position_covariance_m2.trace()) + sight.reach_m;
  const auto is_seen = [&](const Eigen::Vector2d& from_sensor_m) {
    return sight.places.may_hold(sight.sensor_m + from_sensor_m, half_width_m);
  };
  const bool has_mirrored = is_seen(of_image), has_type2 = is_seen(bent_m * path.departure),
             has_type1 = is_seen(bent_m * e);
  const double existence = o.existence * mirror.probability;
  const double bent_mps = path.arrival.dot(o.observed.velocity_mps), direct_mps = e.dot(o.observed.velocity_mps);
  const double carried_mps = 0.5 * (path.departure - e).dot(sight.sensor_velocity_mps);
  const auto add = [&](const KnownObject& object, bool is_type1) {
    if (images.size() < images.capacity()) images.push_back({object, is_type1});
  };
  if (has_mirrored || has_type2) {
    // The reflection turns the arriving wave into the departing one: about the mirror's tangent.
    const Eigen::Vector2d& tangent = mirror.tangent;
    const Eigen::Matrix2d reflection = 2.0 * tangent * tangent.transpose() - Eigen::Matrix2d::Identity();
    KnownObject image = o;
    image.existence = existence;
    image.observed.box.centre_m = sight.sensor_m + of_image;
    image.observed.box.heading_rad = 2.0 * std::atan2(tangent.y(), tangent.x()) - box.heading_rad;
    image.observed.velocity_mps = reflection * o.observed.velocity_mps;
    image.position_covariance_m2 =
        reflection * o.position_covariance_m2 * reflection.transpose() + of_mirror * Eigen::Matrix2d::Identity();
    image.velocity_covariance_m2ps2 = reflection * o.velocity_covariance_m2ps2 * reflection.transpose();
    if (has_mirrored) add(image, false);
    image.observed.box.centre_m = sight.sensor_m + bent_m * path.departure;
    image.range_rate_offset_mps = 0.5 * (direct_mps - bent_mps) + carried_mps;
    if (has_type2) add(image, false);
  }
  if (has_type1) {
    KnownObject image = o;
    image.existence = existence;
    image.observed.box.centre_m = sight.sensor_m + bent_m * e;
    image.range_rate_offset_mps = 0.5 * (bent_mps - direct_mps) - carried_mps;
    image.position_covariance_m2 = o.position_covariance_m2 + of_mirror * Eigen::Matrix2d::Identity();
    add(image, true);
  }
}

}  // namespace

void place_images(std::span<const KnownObject> objects, std::span<const Mirror> mirrors, const SightOfImages& sight,
                  double least_existence, std::vector<MirrorImage>& images) {
  images.clear();
  for (const KnownObject& o : objects) {
    if (o.existence < least_existence) continue;
    for (const Mirror& mirror : mirrors) {
      const auto path = path_over(mirror, sight.sensor_m, o.observed.box.centre_m);
      if (path) add_images(o, mirror, *path, sight, images);
    }
  }
}

}  // namespace boresight::ghosts
