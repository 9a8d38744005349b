// Whether reflectors mirror. Hedges, kerbs and rows of parked cars look like rails and walls, but nothing is seen in
// them: so it is looked where tracked objects would have to be seen, and what never shows one is no mirror. What is
// tracked with the length of a car may be a van, whose flank shows images.
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/object.hpp"
#include "services/ghost_filter/core/classify/recent_movers.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"

namespace boresight::ghosts {

/// Log-odds that a reflector mirrors, by its length and how long it is known, before anything was looked for in it.
[[nodiscard]] double mirrors_by_length(double length_m, double age_s);

class MirrorTrials {
 public:
  struct Scan {
    Eigen::Vector2d sensor_m, sensor_velocity_mps;
    double mounting_std_rad;  ///< of the sensor's yaw
    std::span<const Object> objects;
    const Odometry* odometry;
    const RecentMovers* movers;  ///< of the scan itself, too
  };
  /// For a new scan: nothing was detected yet in any direction.
  void begin();
  /// Something was detected there, whatever it is: so far the radar sees.
  void saw(const Eigen::Vector2d& direction, double range_m);
  /// What the scan tells of a mirror, of the map or a vehicle's: the change of the log-odds that it is one. Everything
  /// in the vehicle frame.
  [[nodiscard]] double evidence_of(const Mirror& mirror, const Scan& scan) const;

 private:
  enum class Outcome { kUnknown, kSeen, kNotSeen };
  [[nodiscard]] Outcome look_for(const Object& object, const Mirror& mirror, const Scan& scan) const;
  static constexpr std::size_t kSectors = 64;
  std::array<double, kSectors> farthest_m_{};
  double farthest_of_all_m_ = 0.0;
};

}  // namespace boresight::ghosts
