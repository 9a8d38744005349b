// Heading of a rigid body that does not turn, from its range rates along several lines of sight.
//
// A body that moves with the speed v along α shows ṙᵢ = v cos(θᵢ − α) along the direction θᵢ. Both estimators have the
// unknown turn rate as a part of their variance.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "services/tracker/core/classical/heading/heading.hpp"

namespace boresight::tracking::classical {

struct DopplerHeading {
  Heading heading;
  double speed_mps = 0.0;
};

struct DopplerParameters {
  std::size_t least_points = 3;  ///< fewer do not show an outlier
  double least_speed_mps = 1.0;  ///< a slower body shows its noise
  double interval_rad = 0.8;     ///< half of the interval that is searched
  double outlier_chi2 = 9.0;     ///< squared deviation of a range rate that is not the body's
};

/// The straight line cos θᵢ/ṙᵢ = 1/(v cos α) − tan α · sin θᵢ/ṙᵢ. Its points are weighted by ṙᵢ²/σᵢ², so that the line
/// is that of least squares of the range rates, and none is divided by a range rate of zero. Empty if the lines of
/// sight do not tell the velocity.
[[nodiscard]] std::optional<DopplerHeading> doppler_line(std::span<const HistoryPoint> points,
                                                         const DopplerParameters& parameters, double turn_mps);

/// The α within an interval about `near_rad` that makes ṙᵢ/cos(θᵢ − α) most alike: least weighted variance, in which a
/// deviation counts up to a limit. So moving parts of the body do not matter.
[[nodiscard]] std::optional<DopplerHeading> interval_search(std::span<const HistoryPoint> points, double near_rad,
                                                            const DopplerParameters& parameters, double turn_mps);

}  // namespace boresight::tracking::classical
