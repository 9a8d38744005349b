// Range rates of wheels, which are not their vehicle's.
#pragma once

#include "services/tracker/core/clusters.hpp"
#include "services/tracker/core/kalman.hpp"

namespace boresight::tracking {

/// Share of wheels in the detections of a vehicle that is seen from beside.
inline constexpr double kWheelShare = 0.5;

/// The chance that a measurement's range rate is that of a vehicle's body and not of a wheel, of which each part has
/// another one, between nothing and twice the body's. From beside a body shows so little range rate that a wheel's,
/// taken for it, changes the speed by metres per second. `wheel_share`: of such detections, whatever they show.
[[nodiscard]] double chance_of_body(const KinematicState& vehicle, const PositionRate& measurement,
                                    double wheel_share = kWheelShare);

/// Whether the lines of sight to the cluster's detections are so far apart that their mean says less of the velocity
/// than each of them does: of what drives alongside, the ends show how fast it is, and its middle shows nothing.
[[nodiscard]] bool is_seen_all_round(const Cluster& cluster);

/// Update of a vehicle's velocity by the range rates of such a cluster one by one, each as likely a wheel's as it is:
/// the strongest, which hardly ever is one, comes first.
void follow_rates(KinematicState& vehicle, const Cluster& cluster, const Eigen::Vector2d& sensor_m);

}  // namespace boresight::tracking
