// What is expected at the places and range rates of a scan's detections: of known objects, and of their mirror images.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/evidence/config.hpp"
#include "services/ghost_filter/core/origins/known_objects.hpp"
#include "services/ghost_filter/core/origins/mirror_images.hpp"

namespace boresight::ghosts {

/// Intensities per m² and m/s at one detection; each object's weighted with its existence.
struct Expected {
  double objects = 0.0;    ///< of all objects
  double strongest = 0.0;  ///< of the object with the largest intensity, and
  double existence = 0.0;  ///< its existence
  double images_type1 = 0.0, images_type2 = 0.0;
};

class ExpectedDetections {
 public:
  /// Both must outlive it. Allocates nothing later.
  ExpectedDetections(const extended_object::ObjectClassTable& classes, const IntensityConfig& config);
  /// `expected` has the size of `detections`.
  void find(std::span<const SeenDetection> detections, const Eigen::Vector2d& sensor_m,
            std::span<const KnownObject> objects, std::span<const MirrorImage> images, std::span<Expected> expected);

 private:
  const extended_object::ObjectClassTable* classes_;
  const IntensityConfig* config_;
  std::vector<std::uint32_t> order_;
};

}  // namespace boresight::ghosts
