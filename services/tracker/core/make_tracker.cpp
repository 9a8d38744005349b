#include "services/tracker/core/make_tracker.hpp"

#include <stdexcept>
#include <utility>

#include "services/tracker/core/classes/classifying_tracker.hpp"
#include "services/tracker/core/classical/classical_filter.hpp"
#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/model/scenario_model.hpp"
#include "services/tracker/core/output/ellipse_reporter.hpp"
#include "services/tracker/core/output/track_reporter.hpp"
#include "services/tracker/core/phd/phd_filter.hpp"
#include "services/tracker/core/pmbm/pmbm_filter.hpp"
#include "services/tracker/core/point_process_tracker.hpp"
#include "services/tracker/core/surroundings/surroundings_tracker.hpp"

namespace boresight::tracking {

namespace {

std::unique_ptr<Filter> make_filter(std::string_view name, const Config& config) {
  if (name == "pmbm") return std::make_unique<pmbm::PmbmFilter>(config.pmbm, config.capacity);
  if (name == "phd") return std::make_unique<phd::PhdFilter>(config.phd, phd::Capacity{});
  if (name == "classical") {
    return std::make_unique<classical::ClassicalFilter>(config.classical, config.capacity.objects,
                                                        config.capacity.measurements);
  }
  throw std::invalid_argument("unknown tracker \"" + std::string(name) + "\"");
}

}  // namespace

std::vector<std::string> tracker_names() {
  return {"pmbm", "phd", "classical"};
}

std::unique_ptr<MultiObjectTracker> make_tracker(std::string_view name, const VehicleConfig& vehicle,
                                                 const Config& config) {
  auto filter = make_filter(name, config);
  auto model = std::make_unique<RadarModel>(vehicle, config.model, config.capacity.objects);
  auto reporter = std::make_unique<TrackReporter>(*model, config.report, config.capacity.objects);
  std::unique_ptr<MultiObjectTracker> tracker =
      std::make_unique<PointProcessTracker>(std::move(model), std::move(filter), std::move(reporter));
  // The chain's own classes; those of the other trackers are a part of their measurement model.
  if (name == "classical" && !config.forest.table.trees.empty()) {
    tracker = std::make_unique<ClassifyingTracker>(std::move(tracker), TrackEvidence(vehicle, config.forest));
  }
  // Whatever tracks the moving objects: the surroundings do not depend on it.
  Surroundings surroundings(vehicle, config.surroundings, config.model.latest_scan_s, config.model.longest_gap_s);
  return std::make_unique<SurroundingsTracker>(std::move(tracker), std::move(surroundings));
}

std::unique_ptr<MultiObjectTracker> make_scenario_tracker(std::string_view name, const LinearScenario& scenario) {
  Config config;
  config.pmbm = {};                  // what is learnt of radars does not hold here
  config.pmbm.merge_distance = 4.0;  // of targets with ten detections a scan; choice: 3 … 6 are alike
  return std::make_unique<PointProcessTracker>(std::make_unique<ScenarioModel>(scenario), make_filter(name, config),
                                               std::make_unique<EllipseReporter>(scenario.confirmed_existence));
}

}  // namespace boresight::tracking
