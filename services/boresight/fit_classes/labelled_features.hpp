// Features of tracks with the true class of their object, from a simulated drive through the whole chain.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "services/boresight/run/chain.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/scenario.hpp"
#include "services/tracker/core/classes/track_classifier.hpp"

namespace boresight::fit_classes {

/// A track at one time of its life.
struct LabelledFeatures {
  std::uint32_t track = 0, object = 0;
  extended_object::RoadUserClass object_class{};
  double age_s = 0.0;
  double detections = 0.0;
  tracking::ClassFeatures features{};
};

struct SimulatedDrive {
  simulator::Scenario scenario;  ///< with its radar profile
  std::uint64_t seed = 1;
  double duration_s = 20.0;
};

/// Tracks of the tracker in `settings`, each every half a second while it is the nearest one at a moving object.
/// `look` is called after each scan; it may throw to end the work.
[[nodiscard]] std::vector<LabelledFeatures> labelled_features(const SimulatedDrive& drive, const VehicleConfig& vehicle,
                                                              const run::Settings& settings,
                                                              const tracking::ObjectForest& forest,
                                                              const std::function<void()>& look);

/// The head of the table, and a row of it. Comments of the head state the numbers by which the features are made.
[[nodiscard]] std::string features_head(const tracking::ObjectForest& forest);
[[nodiscard]] std::string features_row(const std::string& profile, const std::string& scenario, std::uint64_t seed,
                                       const LabelledFeatures& row);

}  // namespace boresight::fit_classes
