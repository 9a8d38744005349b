// What vehicles hide of the map from the own one: nothing seen there does not mean that there is nothing.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "services/ghost_filter/core/reflector_map/curve.hpp"

namespace boresight::ghosts {

/// A stretch of a curve, by arc length.
struct Stretch {
  double begin_m, end_m;
};

/// The stretches of one curve that are hidden.
class HiddenStretches {
 public:
  static constexpr std::size_t kMost = 16;
  void add(const Stretch& stretch) {
    if (count_ < kMost) stretches_[count_++] = stretch;
  }
  [[nodiscard]] bool contains(double arc_m) const;
  /// How far beyond a place the curve is hidden without a gap, towards larger arc lengths or smaller ones, at most
  /// `most_m`.
  [[nodiscard]] double after(double arc_m, double most_m) const;
  [[nodiscard]] double before(double arc_m, double most_m) const;

 private:
  std::array<Stretch, kMost> stretches_{};
  std::size_t count_ = 0;
};

class Shadows {
 public:
  static constexpr std::size_t kMost = 64;
  /// From where it is looked; nothing hides anything yet.
  void begin(const Eigen::Vector2d& eye_m);
  /// A vehicle: its middle, the unit vector along it and half its length and width. What has the eye in it, and what
  /// comes after the first kMost, hides nothing.
  void add(const Eigen::Vector2d& middle_m, const Eigen::Vector2d& axis, double half_length_m, double half_width_m);
  [[nodiscard]] HiddenStretches on(const Curve& curve) const;

 private:
  /// A ray past a corner, and how far away that is; unit.
  struct Edge {
    Eigen::Vector2d direction;
    double corner_m;
  };
  struct Shadow {
    Edge right, left;
  };
  Eigen::Vector2d eye_m_{0.0, 0.0};
  std::array<Shadow, kMost> shadows_{};
  std::size_t count_ = 0;
};

}  // namespace boresight::ghosts
