// Between the shared component and a motion filter: kinematics, and a cell's range rates as measurements.
#pragma once

#include <optional>

#include "services/tracker/core/filters/motion_filter.hpp"
#include "services/tracker/core/ggiw/prediction.hpp"

namespace boresight::tracking::classical {

/// State of a motion filter with a component's place and velocity, and no acceleration within the deviation.
[[nodiscard]] filters::MotionState motion_state(const Component<double>& component, double acceleration_std_mps2);

/// Writes place, velocity and their covariances into a component.
void set_kinematics(const filters::MotionState& state, Component<double>& component);

/// What the range rates of a cell tell of its object's velocity.
struct CellVelocity {
  /// Along the mean line of sight; empty without range rates.
  std::optional<filters::RangeRate> along;
  /// Across it, as a velocity that is unknown along it; empty where all lines of sight are one.
  struct Across {
    Eigen::Vector2d velocity_mps;
    Eigen::Matrix2d covariance;  ///< m²/s²
  };
  std::optional<Across> across;
};

/// The rates ṙᵢ = uᵢᵀv give the information Σ uᵢuᵢᵀ/σ² of the velocity v. Its eigenvectors are the two directions; both
/// together contain all that the rates tell. The unknown turn rate of the object adds to both variances.
[[nodiscard]] CellVelocity cell_velocity(const Cell<double>& cell, const View<double>& view);

}  // namespace boresight::tracking::classical
