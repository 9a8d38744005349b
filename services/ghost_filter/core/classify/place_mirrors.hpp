// All that may mirror in a scan: reflectors of the map, and sides of vehicles.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/config.hpp"
#include "services/ghost_filter/core/classify/object.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/reflector.hpp"

namespace boresight::ghosts {

inline constexpr std::size_t kMaxVehicleSides = 32;

/// Writes them to `mirrors`, in the vehicle frame as of `odometry`, up to its capacity, which all reflectors must fit
/// in; of vehicles as long as `min_mirror_length_m`, or about so, those sides that the sensor can see. The reflectors
/// are referred to.
void place_mirrors(std::span<const Reflector> reflectors, const Odometry& odometry, std::span<const Object> objects,
                   const Eigen::Vector2d& sensor_m, const ClassConfig& config, std::vector<Mirror>& mirrors);

}  // namespace boresight::ghosts
