// Mirror images of known objects, as sources of detections.
//
// An object at T is seen over a mirror at W by three paths (G8): its mirror image by three bounces at range
// |W−S| + |T−W| in the direction of W; by two bounces, last on the mirror, in the same direction at half the sum of
// that range and the direct one (type 2); by two bounces, last on the object, in the object's own direction at that
// range (type 1). The box of an image is the object's box, mirrored or shifted.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/origins/known_objects.hpp"
#include "services/ghost_filter/core/origins/mirror.hpp"
#include "services/ghost_filter/core/origins/occupied_places.hpp"

namespace boresight::ghosts {

struct MirrorImage {
  KnownObject object;  ///< the image; its existence is that of the object times that of the mirror
  bool is_type1 = false;
};

/// What the sensor sees of images in a scan.
struct SightOfImages {
  Eigen::Vector2d sensor_m{0.0, 0.0};
  Eigen::Vector2d sensor_velocity_mps{0.0, 0.0};  ///< over ground
  OccupiedPlaces places;                          ///< of the detections
  double reach_m = 0.0;                           ///< largest reach of a detection
};

/// Images, in all mirrors, of all objects that exist with `least_existence`, where detections may be. `images` keeps
/// its capacity.
void place_images(std::span<const KnownObject> objects, std::span<const Mirror> mirrors, const SightOfImages& sight,
                  double least_existence, std::vector<MirrorImage>& images);

}  // namespace boresight::ghosts
