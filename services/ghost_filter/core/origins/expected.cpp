#include "services/ghost_filter/core/origins/expected.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

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

  /// Calls `visit(index)` for the detections within `radius_m`, and their own reach, of a place.
  template <typename Visit>
  void visit(const Eigen::Vector2d& place_m, double range_m, double radius_m, const Visit& visit) const {
    const double farthest_m = radius_m + M_SQRT2 * reach_m_;
    auto at = std::lower_bound(order_.begin(), order_.end(), range_m - farthest_m,
                               [&](std::uint32_t i, double range) { return detections_[i].range_m < range; });
    for (; at != order_.end() && detections_[*at].range_m <= range_m + farthest_m; ++at) {
      if ((detections_[*at].position_m - place_m).squaredNorm() <= farthest_m * farthest_m) visit(*at);
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
  // Calls `add(expected, intensity)`. What an object needs is prepared with its first detection: many have none.
  const auto visit = [&](const KnownObject& object, bool is_image, const auto& add) {
    const extended_object::OrientedBox& box = object.observed.box;
    const double radius_m = box.half_size_m().norm() + M_SQRT2 * reach_m(object, *config_);
    std::optional<ObjectIntensity> intensity;
    by_range.visit(box.centre_m, (box.centre_m - sensor_m).norm(), radius_m, [&](std::uint32_t i) {
      if (!intensity) intensity.emplace(object, is_image, sensor_m, *classes_, *config_);
      if (intensity->reaches(detections[i])) add(expected[i], intensity->at(detections[i]));
    });
  };
  for (const KnownObject& object : objects) {
    visit(object, false, [&](Expected& e, double value) {
      e.objects += value;
      if (value <= e.strongest) return;
      e.strongest = value;
      e.existence = object.existence;
    });
  }
  for (const MirrorImage& image : images) {
    visit(image.object, true,
          [&](Expected& e, double value) { (image.is_type1 ? e.images_type1 : e.images_type2) += value; });
  }
}

}  // namespace boresight::ghosts
