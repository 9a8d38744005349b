// How likely each origin of a detection is: expected densities of detections at its place with its range rate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/config.hpp"
#include "services/ghost_filter/core/classify/recent_movers.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

namespace boresight::ghosts {

/// A tracked vehicle, or the own one, predicted to the scan; vehicle frame and axes.
struct Object {
  Eigen::Vector2d position_m{0.0, 0.0};  ///< centre
  Eigen::Vector2d axis{1.0, 0.0};        ///< of its length, unit
  double half_length_m = 0.0, half_width_m = 0.0;
  Eigen::Vector2d velocity_mps{0.0, 0.0};  ///< over ground
  Eigen::Matrix2d position_covariance = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d velocity_covariance = Eigen::Matrix2d::Zero();
  double weight = 0.0;  ///< probability that it exists and is no image itself
  bool own = false;     ///< the own vehicle: seen only in mirrors
};

/// A detection, in the plane.
struct Measured {
  Eigen::Vector2d position_m, direction;
  double range_m, rate_mps;  ///< rate over ground
  double range_std_m, azimuth_std_rad, rate_std_mps;
  double still_std_mps;  ///< of the range rate over ground of what stands still
  double rcs_dbsm;       ///< NaN: not measured
};

/// Expected number of detections for each m² and m/s.
struct Densities {
  double moving = 0.0, stationary = 0.0, type1 = 0.0, type2 = 0.0, clutter = 0.0;
  [[nodiscard]] double sum() const { return moving + stationary + type1 + type2 + clutter; }
};

/// What the detections of a scan are judged by.
struct Surroundings {
  Eigen::Vector2d sensor_m, sensor_velocity_mps;
  std::span<const Mirror> mirrors;
  std::span<const Object> objects;
  const Odometry* odometry;
  const RecentMovers* movers;  ///< of the scan itself, too
  const StationaryGrid* stationary;
};

class Judge {
 public:
  static constexpr std::size_t kMaxObjects = 129;
  explicit Judge(const ClassConfig& config);

  /// For a new scan; what is in `surroundings` is only referred to.
  void begin(const Surroundings& surroundings);
  /// `index` of the detection in the scan; `but_object`: is not considered, nor what is near to the detection.
  [[nodiscard]] Densities weigh(const Measured& measured, std::uint32_t index, std::uint32_t but_object = kNobody);
  /// As weigh(), but only what a detection that looks stationary can be: that, or of an object that is tracked.
  [[nodiscard]] Densities weigh_still(const Measured& measured);
  /// Whether there is a mirror in front of the detection, as probability.
  [[nodiscard]] double behind_mirror(const Measured& measured) const;

 private:
  struct Way {
    Detour detour;
    std::uint32_t mirror;
  };
  struct Ways {
    std::uint32_t begin = 0, count = 0;
    bool known = false;
  };
  /// The detours to an object (slot = its number) or a detection of the scan (slot = kMaxObjects + its number).
  [[nodiscard]] std::span<const Way> ways_to(std::size_t slot, const Eigen::Vector2d& target_m);
  [[nodiscard]] double of_objects(const Measured& measured, std::uint32_t but_object) const;
  [[nodiscard]] bool is_known_still(const Measured& measured) const;
  [[nodiscard]] double of_stationary(const Measured& measured) const;
  [[nodiscard]] double type2(const Measured& measured, const Mirror& mirror, const Turn& turn,
                             std::uint32_t but_object) const;
  [[nodiscard]] double type1(const Measured& measured, std::uint32_t index, std::uint32_t but_object, bool& hidden);
  [[nodiscard]] bool has_company(const Measured& measured, std::uint32_t index) const;
  ClassConfig config_;
  Surroundings s_{};
  std::vector<Ways> slots_;
  std::vector<Way> ways_;
};

}  // namespace boresight::ghosts
