#include "services/ghost_filter/core/classify/mirror_fan.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

void MirrorFan::enter(std::size_t mirror, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  // The shorter way round, and a sector more on either side: pieces of arcs are taken for straight.
  const bool left = from.x() * to.y() - from.y() * to.x() >= 0.0;
  const std::size_t first = sector_of<kSectors>(left ? from : to), last = sector_of<kSectors>(left ? to : from);
  const std::size_t number = (last + kSectors - first) % kSectors + 3;
  for (std::size_t k = 0; k < std::min(number, kSectors); ++k) {
    sectors_[(first + kSectors - 1 + k) % kSectors][mirror / 64] |= std::uint64_t{1} << (mirror % 64);
  }
}

void MirrorFan::build(std::span<const Mirror> mirrors, const Eigen::Vector2d& sensor_m) {
  constexpr double kSag_m = 0.1;  // of a piece of an arc at most, where it takes no more than 64 of them
  mirrors_ = mirrors.first(std::min(mirrors.size(), kMaxMirrors));
  sectors_.fill({});
  for (std::size_t i = 0; i < mirrors_.size(); ++i) {
    const Mirror& m = mirrors_[i];
    const double beyond_m = most_beyond_m(m);
    const double begin = m.begin_m - beyond_m, length = m.end_m - m.begin_m + 2.0 * beyond_m;
    const double turned = std::abs(m.curve.curvature_per_m) * length;
    const int pieces = std::clamp(static_cast<int>(std::ceil(std::sqrt(turned * length / (8.0 * kSag_m)))), 1, 64);
    // How far a piece of an arc leaves its chord; nearer to it than this the sides are not told apart.
    const double sag = turned * length / (8.0 * pieces * pieces);
    const double near_m = std::max(0.5, 20.0 * sag);
    const double arc = m.curve.arc(sensor_m);
    if (std::abs(m.curve.distance(sensor_m)) < near_m && arc > begin - near_m && arc < begin + length + near_m) {
      for (Bits& bits : sectors_) bits[i / 64] |= std::uint64_t{1} << (i % 64);
      continue;
    }
    Eigen::Vector2d from = m.curve.at(begin) - sensor_m;
    for (int k = 1; k <= pieces; ++k) {
      const Eigen::Vector2d to = m.curve.at(begin + length * k / pieces) - sensor_m;
      enter(i, from, to);
      from = to;
    }
  }
}

}  // namespace boresight::ghosts
