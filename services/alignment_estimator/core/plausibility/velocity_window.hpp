// Velocity of a sensor over ground from the detections of half a second alone: neither the vehicle's motion nor the
// mounting is used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "services/alignment_estimator/core/scan_detections.hpp"

namespace boresight::alignment::plausibility {

/// Velocity in the sensor's x and y axes. A stationary reflector's range rate is −u·velocity.
struct VelocityFit {
  bool valid = false;
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  /// Shares of the field of view: detections that the velocity explains, and detections that it does not explain and
  /// that neither approach nor recede.
  double share = 0.0, standing_share = 0.0;
};

/// The detections of one window. No allocation.
class VelocityWindow {
 public:
  static constexpr std::size_t kCapacity = 192;

  void clear() { count_ = 0; }
  /// Takes at most `most` detections, evenly from the list.
  void add(const ScanDetections& scan, std::size_t most);
  [[nodiscard]] std::size_t count() const { return count_; }
  /// The velocity that explains most of the field of view, found from `starts` and from pairs of detections.
  [[nodiscard]] VelocityFit fit(std::span<const Eigen::Vector2d> starts);

 private:
  using Column = std::array<float, kCapacity>;
  void weigh();
  [[nodiscard]] float gate(const Eigen::Vector2d& velocity) const;
  [[nodiscard]] float score(const Eigen::Vector2d& velocity, float gate) const;
  [[nodiscard]] Eigen::Vector2d draw_pair(bool& usable);
  void refine(Eigen::Vector2d& velocity) const;
  void judge(VelocityFit& fit) const;

  std::size_t count_ = 0;
  std::size_t sectors_ = 0;  ///< of the field of view, with detections
  Column x_, y_, range_rate_, weight_;
  std::array<std::uint8_t, kCapacity> sector_;
  double azimuth_variance_ = 0.0, range_rate_variance_ = 0.0;  ///< sums
  float interval_mps_ = 0.0F, per_interval_ = 0.0F;            ///< unambiguous interval and 1/it; 0: none
  std::uint64_t random_ = 1;
};

}  // namespace boresight::alignment::plausibility
