#include "services/ghost_filter/core/origins/expected.hpp"

#include <algorithm>
#include <numeric>

namespace boresight::ghosts {

namespace {

/// The detections in the order of their range.
class ByRange {
 public:
  explicit ByRange(std::span<const SeenDetection> detections, std::vector<std::uint32_t>& order)
      : detections_(detections), order_(order) {
    order_.resize(detections.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return detections[a].range_m < detections[b].range_m; });
    for (const SeenDetection& d : detections) reach_m_ = std::max(reach_m_, d.reach_m);
  }

  /// Calls `visit(index)` for the detections that are near enough to the object.
  template <typename Visit>
  void visit(const ObjectIntensity& object, double range_m, const Visit& visit) const {
    const double radius = object.radius_m(reach_m_);
    auto at = std::lower_bound(order_.begin(), order_.end(), range_m - radius,
                               [&](std::uint32_t i, double range) { return detections_[i].range_m < range; });
    for (; at != order_.end() && detections_[*at].range_m <= range_m + radius; ++at) {
      if (object.reaches(detections_[*at])) visit(*at);
    }
  }

 private:
  std::span<const SeenDetection> detections_;
  std::vector<std::uint32_t>& order_;
  double reach_m_ = 0.0;
};

}  // namespace

ExpectedDetections::ExpectedDetections(const extended_object::ObjectClassTable& classes, const IntensityConfig& config)
    : classes_(&classes), config_(&config) {
  order_.reserve(kMaxDetections);
}

void ExpectedDetections::find(std::span<const SeenDetection> detections, const Eigen::Vector2d& sensor_m,
                              std::span<const KnownObject> objects, std::span<const MirrorImage> images,
                              std::span<Expected> expected) {
  std::fill(expected.begin(), expected.end(), Expected{});
  const ByRange by_range(detections, order_);
  const auto range_of = [&](const KnownObject& o) { return (o.observed.box.centre_m - sensor_m).norm(); };
  for (const KnownObject& object : objects) {
    ObjectIntensity intensity(object, sensor_m, *classes_, *config_);
    by_range.visit(intensity, range_of(object), [&](std::uint32_t i) {
      const double value = object.existence * intensity.at(detections[i]);
      Expected& e = expected[i];
      e.objects += value;
      if (value <= e.strongest) return;
      e.strongest = value;
      e.existence = object.existence;
    });
  }
  for (const MirrorImage& image : images) {
    ObjectIntensity intensity(image.object, sensor_m, *classes_, *config_);
    by_range.visit(intensity, range_of(image.object), [&](std::uint32_t i) {
      const double value = image.object.existence * intensity.at(detections[i]);
      (image.is_type1 ? expected[i].images_type1 : expected[i].images_type2) += value;
    });
  }
}

}  // namespace boresight::ghosts
