// The antenna: field of view, pattern, and losses by dirt in front of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Core>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/radar/blockage.hpp"

namespace boresight::simulator::radar {

/// A direction in the antenna's frame.
struct Look {
  double azimuth_rad, elevation_rad;
  double loss_db;  ///< one way
  bool inside;     ///< the field of view
};

/// One-way gain relative to boresight, dB: a parabola (the main lobe) with −3 dB at the edges of the field of view.
[[nodiscard]] inline double pattern_db(double azimuth_rad, double elevation_rad, const FieldOfView& view) {
  constexpr double kEdge_db = -3.0;
  const double width = std::max(std::abs(view.azimuth_min_rad), std::abs(view.azimuth_max_rad));
  const double height = std::max(std::abs(view.elevation_min_rad), std::abs(view.elevation_max_rad));
  const double a = azimuth_rad / width, e = elevation_rad / height;
  return kEdge_db * std::min(2.0, a * a + e * e);
}

class Antenna {
 public:
  explicit Antenna(const FieldOfView& view) : view_(view) {}

  /// Sets the dirt of a scan.
  void set_dirt(std::span<const Dirt> dirt) { dirt_ = dirt; }

  /// `direction`: unit vector, sensor frame.
  [[nodiscard]] Look look(const Eigen::Vector3d& direction) const {
    Look l{std::atan2(direction.y(), direction.x()), std::asin(std::clamp(direction.z(), -1.0, 1.0)), 0.0, false};
    l.inside = l.azimuth_rad >= view_.azimuth_min_rad && l.azimuth_rad <= view_.azimuth_max_rad &&
               l.elevation_rad >= view_.elevation_min_rad && l.elevation_rad <= view_.elevation_max_rad;
    l.loss_db = -pattern_db(l.azimuth_rad, l.elevation_rad, view_) + 0.5 * loss_db(dirt_, l.azimuth_rad);
    return l;
  }
  [[nodiscard]] const FieldOfView& view() const { return view_; }

 private:
  FieldOfView view_;
  std::span<const Dirt> dirt_;
};

}  // namespace boresight::simulator::radar
