// The stationary detections of the recent past, in the present vehicle frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace boresight::ghosts::published {

class StationaryMap {
 public:
  static constexpr std::size_t kCapacity = 8192;
  StationaryMap();

  /// Moves all points to the vehicle frame of `time_ns` and forgets those older than `memory_s`. A clock that goes
  /// back by over a second, or stands still for longer than the memory, empties the map.
  void advance(std::int64_t time_ns, double speed_mps, double yaw_rate_radps, double memory_s);
  /// Adds a point of the present time; the oldest gives way when the map is full.
  void add(const Eigen::Vector2d& position_m);
  [[nodiscard]] std::span<const Eigen::Vector2d> points() const { return points_; }

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::int64_t> times_ns_;
  std::int64_t now_ns_ = 0;
};

}  // namespace boresight::ghosts::published
