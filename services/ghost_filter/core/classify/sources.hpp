// What may have ghosts: tracked objects and what was detected lately. Found along a ray, with the mirrors by which each
// is reached from the sensor, so that of all ways by all mirrors only those are followed that lead to something.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/cell_table.hpp"
#include "services/ghost_filter/core/classify/mirror_fan.hpp"
#include "services/ghost_filter/core/classify/object.hpp"
#include "services/ghost_filter/core/classify/recent_movers.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"

namespace boresight::ghosts {

/// A line of sight, or what it becomes behind a mirror.
struct Ray {
  Eigen::Vector2d from_m, direction;  ///< unit
  double farthest_m;
  double std_m, std_per_m;  ///< across it: at its begin, and what each metre adds
};

/// A source near a ray.
struct Touch {
  std::uint32_t source;
  double along_m;  ///< of its centre
  double reach_m;  ///< half of what it may take up along the ray
};

/// Where a mover is now, in the vehicle frame.
struct Spot {
  Eigen::Vector2d place_m;
  double variance_m2;  ///< with what it may have moved otherwise
};

/// Mirrors by number.
using MirrorBits = std::array<std::uint64_t, MirrorFan::kMaxMirrors / 64>;

class Sources {
 public:
  static constexpr std::size_t kMax = 256;
  Sources();
  /// Of the present scan. All that is passed is only referred to, and `objects` is shorter than kMax. Mirrors less sure
  /// than `least_existence` lead nowhere.
  void build(std::span<const Mirror> mirrors, std::span<const Object> objects, const RecentMovers& movers,
             const Odometry& odometry, const Eigen::Vector2d& sensor_m, double extent_std_m, double least_existence);
  /// What is near the ray: from a mirror those only that are reached by it; kAny: from the sensor.
  void touched(const Ray& ray, std::uint32_t by_mirror, std::vector<Touch>& touches) const;
  static constexpr std::uint32_t kAny = 0xFFFFFFFF;
  /// The mirrors by which one of those has together with the way along the ray about the length `length_m`. It errs on
  /// the side of too many. `but_source` has no part in it.
  [[nodiscard]] MirrorBits ways(const Ray& ray, std::span<const Touch> touches, double length_m, double slack_m,
                                std::uint32_t but_source) const;
  [[nodiscard]] const Spot& spot(std::uint32_t mover) const { return spots_[mover]; }
  /// Calls `visit(number)` for the movers of a source. None: it is the object with the source's number.
  template <typename Visit>
  void visit_movers(std::uint32_t source, const Visit& visit) const {
    for (std::uint32_t i = first_mover_[source]; i != kNone; i = next_mover_[i]) visit(i);
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Source {
    Eigen::Vector2d centre_m, axis;
    double half_length_m, half_width_m;
    double blur_m;    // on each side
    double radius_m;  // with all that
  };
  /// By a mirror to a source's centre. Length not a number: it cannot be said.
  struct Way {
    std::uint32_t mirror;
    double length_m;
    Eigen::Vector2d arrival;
  };
  /// False: there is no room for all that was detected in cells of that size.
  bool gather(const RecentMovers& movers, const Odometry& odometry, double extent_std_m, double cell_m);
  void find_ways(std::span<const Mirror> mirrors, const Eigen::Vector2d& sensor_m, double least_existence);
  void find_sectors(const Eigen::Vector2d& sensor_m);
  using SourceBits = std::array<std::uint64_t, kMax / 64>;
  std::vector<Source> sources_;  // the objects in their order, then cells of movers
  std::vector<Way> ways_;
  std::array<std::uint32_t, kMax + 1> first_way_{};
  std::array<SourceBits, MirrorFan::kMaxMirrors> reached_{};
  std::array<std::uint32_t, kMax> first_mover_{};
  std::vector<std::uint32_t> next_mover_;
  std::vector<Spot> spots_;
  std::array<SourceBits, MirrorFan::kSectors> in_sector_{};  // as the sensor sees them
  geometry::CellTable cells_;
};

}  // namespace boresight::ghosts
