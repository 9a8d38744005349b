// Settings of the tracker; the defaults are what config/services/tracker.toml ships.
#pragma once

#include <string>

#include "services/tracker/core/classes/object_forest.hpp"
#include "services/tracker/core/classical/parameters.hpp"
#include "services/tracker/core/model/radar_parameters.hpp"
#include "services/tracker/core/output/track_reporter.hpp"
#include "services/tracker/core/phd/parameters.hpp"
#include "services/tracker/core/pmbm/parameters.hpp"
#include "services/tracker/core/surroundings/parameters.hpp"

namespace boresight::tracking {

struct Config {
  std::string tracker = "pmbm";  ///< name for make_tracker()
  RadarModelParameters model;
  /// Nothing returns to a Poisson part where births are everywhere; echoes of radars last.
  pmbm::Parameters pmbm{.min_existence = 0.07, .join_existence = 0.95};
  pmbm::Capacity capacity;
  phd::Parameters phd;
  classical::Parameters classical;
  ReportParameters report;
  SurroundingsParameters surroundings;
  ObjectForest forest;  ///< classes of tracks by their features; without trees: the prior
};

}  // namespace boresight::tracking
