#include "services/ghost_filter/core/origins/expected.hpp"

#include <algorithm>

namespace boresight::ghosts {

void expect(std::span<const SeenDetection> detections, const Eigen::Vector2d& sensor_m,
            std::span<const KnownObject> objects, std::span<const MirrorImage> images, const EvidenceConfig& config,
            std::span<Expected> expected) {
  std::fill(expected.begin(), expected.end(), Expected{});
  for (const KnownObject& object : objects) {
    ObjectIntensity intensity(object, sensor_m, config.classes, config.intensity);
    for (std::size_t i = 0; i < detections.size(); ++i) {
      if (!intensity.reaches(detections[i])) continue;
      const double value = object.existence * intensity.at(detections[i]);
      Expected& e = expected[i];
      e.objects += value;
      if (value <= e.strongest) continue;
      e.strongest = value;
      e.existence = object.existence;
    }
  }
  for (const MirrorImage& image : images) {
    ObjectIntensity intensity(image.object, sensor_m, config.classes, config.intensity);
    for (std::size_t i = 0; i < detections.size(); ++i) {
      if (!intensity.reaches(detections[i])) continue;
      const double value = image.object.existence * intensity.at(detections[i]);
      (image.is_type1 ? expected[i].images_type1 : expected[i].images_type2) += value;
    }
  }
}

}  // namespace boresight::ghosts
