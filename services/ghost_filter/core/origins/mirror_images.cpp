#include "services/ghost_filter/core/origins/mirror_images.hpp"

#include <cmath>

#include "services/ghost_filter/core/mirror/image.hpp"

namespace boresight::ghosts {

namespace {

/// Images of one object in one mirror.
void add_images(const KnownObject& o, const Mirror& mirror, const Image& path, const Eigen::Vector2d& sensor_m,
                const Eigen::Vector2d& sensor_velocity_mps, std::vector<MirrorImage>& images) {
  const extended_object::OrientedBox& box = o.observed.box;
  const Eigen::Vector2d direct = box.centre_m - sensor_m;
  const double direct_m = direct.norm(), mirrored_m = path.first_m + path.second_m;
  if (!(direct_m > 0.0)) return;
  const Eigen::Vector2d e = direct / direct_m;
  // The reflection turns the arriving wave into the departing one: about the mirror's tangent at W.
  const Eigen::Vector2d tangent = mirror.curve.tangent_at(path.arc_m);
  Eigen::Matrix2d reflection;
  reflection << 2.0 * tangent.x() * tangent.x() - 1.0, 2.0 * tangent.x() * tangent.y(), 2.0 * tangent.x() * tangent.y(),
      2.0 * tangent.y() * tangent.y() - 1.0;
  const double shift = mirror.offset_variance_m2(path.arc_m), turn = mirror.covariance(1, 1);
  const Eigen::Matrix2d of_mirror =
      (4.0 * shift + 4.0 * path.second_m * path.second_m * turn) * Eigen::Matrix2d::Identity();
  const double bent_mps = path.arrival.dot(o.observed.velocity_mps), direct_mps = e.dot(o.observed.velocity_mps);
  const double carried_mps = 0.5 * (path.departure - e).dot(sensor_velocity_mps);

  MirrorImage three{o, false};
  three.object.existence = o.existence * mirror.probability_at(path.arc_m);
  KnownObject& image = three.object;
  image.observed.box.centre_m = sensor_m + mirrored_m * path.departure;
  image.observed.box.heading_rad = 2.0 * std::atan2(tangent.y(), tangent.x()) - box.heading_rad;
  image.observed.velocity_mps = reflection * o.observed.velocity_mps;
  image.position_covariance_m2 = reflection * o.position_covariance_m2 * reflection.transpose() + of_mirror;
  image.velocity_covariance_m2ps2 = reflection * o.velocity_covariance_m2ps2 * reflection.transpose();
  MirrorImage two = three;
  two.object.observed.box.centre_m = sensor_m + 0.5 * (mirrored_m + direct_m) * path.departure;
  two.object.range_rate_offset_mps = 0.5 * (direct_mps - bent_mps) + carried_mps;
  MirrorImage type1{o, true};
  type1.object.existence = three.object.existence;
  type1.object.observed.box.centre_m = sensor_m + 0.5 * (mirrored_m + direct_m) * e;
  type1.object.range_rate_offset_mps = 0.5 * (bent_mps - direct_mps) - carried_mps;
  type1.object.position_covariance_m2 = o.position_covariance_m2 + of_mirror;
  for (const MirrorImage& each : {three, two, type1}) {
    if (images.size() < images.capacity()) images.push_back(each);
  }
}

}  // namespace

void place_images(std::span<const KnownObject> objects, std::span<const Mirror> mirrors,
                  const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& sensor_velocity_mps, double least_existence,
                  std::vector<MirrorImage>& images) {
  images.clear();
  for (const Mirror& mirror : mirrors) {
    for (const KnownObject& o : objects) {
      if (o.existence < least_existence) continue;
      const auto path = image_of(mirror, sensor_m, o.observed.box.centre_m);
      if (path) add_images(o, mirror, *path, sensor_m, sensor_velocity_mps, images);
    }
  }
}

}  // namespace boresight::ghosts
