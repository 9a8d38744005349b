// What the estimators of a heading are given: the latest detections of one object.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "services/tracker/core/model/heading.hpp"

namespace boresight::tracking::classical {

/// A detection of one object, moved to the object's place now.
struct HistoryPoint {
  Eigen::Vector2d place_m{0.0, 0.0};  ///< in local axes
  double variance_m2 = 0.0;           ///< of the place, mean over the directions
  Eigen::Vector2d sight{1.0, 0.0};    ///< unit vector from the sensor
  double range_rate_mps = 0.0;        ///< over ground
  double range_rate_variance = 0.0;   ///< m²/s²
  double age_s = 0.0;
};

/// The latest detections, the oldest of which are replaced.
class History {
 public:
  static constexpr std::size_t kCapacity = 32;

  void add(const HistoryPoint& point) {
    points_[next_] = point;
    next_ = (next_ + 1) % kCapacity;
    if (number_ < kCapacity) ++number_;
  }
  /// Moves all by the object's motion and that of the axes; forgets those that are older than `longest_s`.
  void move(const Eigen::Vector2d& by_m, double elapsed_s, double longest_s) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < number_; ++k) {
      HistoryPoint point = points_[k];
      point.age_s += elapsed_s;
      point.place_m += by_m;
      if (point.age_s <= longest_s) points_[kept++] = point;
    }
    if (kept == number_) return;  // the ring stays a ring
    number_ = kept;
    next_ = kept % kCapacity;
  }
  [[nodiscard]] std::span<const HistoryPoint> points() const { return std::span(points_).first(number_); }

 private:
  std::array<HistoryPoint, kCapacity> points_{};
  std::size_t number_ = 0, next_ = 0;
};

}  // namespace boresight::tracking::classical
