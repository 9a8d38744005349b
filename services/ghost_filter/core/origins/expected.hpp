// What is expected at the places and range rates of a scan's detections: of known objects, and of their mirror images.
#pragma once

#include <span>

#include <Eigen/Core>

#include "services/ghost_filter/core/evidence/config.hpp"
#include "services/ghost_filter/core/origins/known_objects.hpp"
#include "services/ghost_filter/core/origins/mirror_images.hpp"

namespace boresight::ghosts {

/// Intensities per m² and m/s at one detection; each object's weighted with its existence.
struct Expected {
  double objects = 0.0;          ///< of all objects
  double strongest = 0.0;        ///< of the object with the largest intensity, and
  double existence = 0.0;        ///< its existence
  double images_type1 = 0.0, images_type2 = 0.0;
};

/// `expected` has the size of `detections`.
void expect(std::span<const SeenDetection> detections, const Eigen::Vector2d& sensor_m,
            std::span<const KnownObject> objects, std::span<const MirrorImage> images, const EvidenceConfig& config,
            std::span<Expected> expected);

}  // namespace boresight::ghosts
