// A simulated scenario: the truth with the model that a tracker is given, and measurements of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "services/boresight/track/estimates.hpp"
#include "services/boresight/track/measurement_table.hpp"
#include "services/tracker/core/model/linear_scenario.hpp"

namespace boresight::bench::scenarios {

struct Scenario {
  std::string name;
  tracking::LinearScenario model;
  track::ObjectsByStep truth;                           ///< of every step
  std::map<std::uint32_t, double> detections_per_scan;  ///< mean number if detected, by id of the object
};

struct Measurements {
  std::vector<std::vector<track::MeasuredPoint>> scans;
  std::vector<std::vector<std::uint32_t>> origins;  ///< of each measurement the id of its object; 0: clutter
};

}  // namespace boresight::bench::scenarios
