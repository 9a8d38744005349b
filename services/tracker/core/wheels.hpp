// Range rates of wheels, which are not their vehicle's.
#pragma once

#include "services/tracker/core/kalman.hpp"

namespace boresight::tracking {

/// The chance that a measurement's range rate is that of a vehicle's body and not of a wheel, of which each part has
/// another one, between nothing and twice the body's. From beside a body shows so little range rate that a wheel's,
/// taken for it, changes the speed by metres per second.
[[nodiscard]] double chance_of_body(const KinematicState& vehicle, const PositionRate& measurement);

}  // namespace boresight::tracking
