#include "services/simulator/alignment/moving_objects.hpp"

#include <algorithm>
#include <array>

namespace boresight::simulator {

namespace {

constexpr std::size_t kObjectsOfAKind = 2;

}  // namespace

std::vector<MovingObject> make_moving_objects(const View& view, double period_s, Stream& stream) {
  std::vector<MovingObject> objects;
  const double view_rad = 0.5 * (view.azimuth_max_rad - view.azimuth_min_rad);
  const auto add = [&](MovingObject::Kind kind, double along_mps, double across_mps, double correlation_s) {
    for (std::size_t i = 0; i < kObjectsOfAKind; ++i) {
      objects.push_back({kind, Wander(along_mps, correlation_s, period_s, stream),
                         Wander(across_mps, correlation_s, period_s, stream),
                         Wander(0.5 * view_rad, 5.0, period_s, stream), Wander(0.6, 5.0, period_s, stream)});
    }
  };
  add(MovingObject::Kind::kWithTraffic, 3.0, 0.0, 4.0);
  add(MovingObject::Kind::kAgainstTraffic, 4.0, 0.0, 4.0);
  add(MovingObject::Kind::kWalker, 1.0, 1.2, 3.0);
  return objects;
}

std::size_t object_of(double sort) {
  constexpr std::array<double, 4> kEdges{0.0, 0.40, 0.65, kMovingShare};
  std::size_t kind = 0;
  while (kind < 2 && sort >= kEdges[kind + 1]) ++kind;
  const double within = (sort - kEdges[kind]) / (kEdges[kind + 1] - kEdges[kind]);
  return kind * kObjectsOfAKind + std::min(static_cast<std::size_t>(within * kObjectsOfAKind), kObjectsOfAKind - 1);
}

}  // namespace boresight::simulator
