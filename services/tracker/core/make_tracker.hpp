// A tracker by its configuration name.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/config.hpp"
#include "services/tracker/core/model/linear_scenario.hpp"
#include "services/tracker/core/multi_object_tracker.hpp"

namespace boresight::tracking {

/// "pmbm", "phd" or "classical" with the radar model of the vehicle. Throws std::invalid_argument for another name.
[[nodiscard]] std::unique_ptr<MultiObjectTracker> make_tracker(std::string_view name, const VehicleConfig& vehicle,
                                                               const Config& config);

/// The same filter with the linear model of a simulated scenario. Detections enter by x_vehicle_m and y_vehicle_m, the
/// number of each scan by its measurement time; boxes are the ellipses of the extent: length and width are twice its
/// half axes.
[[nodiscard]] std::unique_ptr<MultiObjectTracker> make_scenario_tracker(std::string_view name,
                                                                        const LinearScenario& scenario);

/// All names, the default first.
[[nodiscard]] std::vector<std::string> tracker_names();

}  // namespace boresight::tracking
