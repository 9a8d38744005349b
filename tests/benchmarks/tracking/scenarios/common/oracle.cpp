#include "tests/benchmarks/tracking/scenarios/common/oracle.hpp"

#include <memory>
#include <optional>

#include "services/boresight/track/tracker_run.hpp"
#include "services/tracker/core/model/scenario_model.hpp"

namespace boresight::bench::scenarios {

namespace {

using tracking::Cell;
using tracking::Component;
using tracking::Prediction;
using tracking::ScenarioModel;

/// One object of which all measurements are known.
class KnownObject {
 public:
  void predict(const ScenarioModel& model, double elapsed_s) {
    if (component_) existence_ *= model.predict(*component_, elapsed_s);
  }
  void update(const ScenarioModel& model, const Cell<double>& cell) {
    if (!component_) component_ = likeliest_birth(model, cell);
    Prediction<double> prediction(*component_, model.view(*component_));
    component_ = prediction.updated(*component_, cell);
    existence_ = 1.0;
  }
  void miss(const ScenarioModel& model) {
    if (!component_) return;
    const Prediction<double> prediction(*component_, model.view(*component_));
    component_ = prediction.missed_component(*component_);
    existence_ = existence_ * prediction.missed() / (1.0 - existence_ + existence_ * prediction.missed());
  }
  [[nodiscard]] bool exists() const { return existence_ > 0.5; }
  [[nodiscard]] track::ExtendedObject estimate(std::uint32_t id) const {
    const auto x = tracking::extent(*component_);
    track::ExtendedObject object;
    object.ellipse.centre_m = {component_->position_m.x, component_->position_m.y};
    object.ellipse.extent_m2 << x.xx, x.xy, x.xy, x.yy;
    object.velocity_mps = {component_->velocity_mps.x, component_->velocity_mps.y};
    object.id = id;
    return object;
  }

 private:
  static Component<double> likeliest_birth(const ScenarioModel& model, const Cell<double>& cell) {
    const Component<double>* best = nullptr;
    double best_log = 0.0;
    for (const tracking::PoissonComponent& birth : model.births()) {
      const double log = Prediction<double>(birth.component, model.view(birth.component)).log_likelihood(cell);
      if (best == nullptr || log > best_log) {
        best = &birth.component;
        best_log = log;
      }
    }
    return *best;
  }

  std::optional<Component<double>> component_;  // from the first detection on
  double existence_ = 0.0;
};

}  // namespace

track::ObjectsByStep oracle_estimates(const Scenario& scenario, const Measurements& measurements) {
  ScenarioModel model(scenario.model);
  const auto scan = std::make_unique<ClassifiedScan>();
  std::map<std::uint32_t, KnownObject> objects;
  track::ObjectsByStep estimates(measurements.scans.size());
  for (std::size_t i = 0; i < measurements.scans.size(); ++i) {
    track::fill_scan(measurements.scans[i], i + 1, scenario.model.step_s, *scan);
    const double elapsed_s = model.begin_scan(*scan).elapsed_s;
    std::map<std::uint32_t, Cell<double>> cells;
    for (std::size_t k = 0; k < model.measurements().size(); ++k) {
      const std::uint32_t origin = measurements.origins[i][k];
      if (origin != 0) cells[origin].add(model.measurements()[k], 1.0);
    }
    for (auto& [id, object] : objects) object.predict(model, elapsed_s);
    for (const auto& [id, cell] : cells) objects[id].update(model, cell);
    for (auto& [id, object] : objects) {
      if (!cells.contains(id)) object.miss(model);
      if (object.exists()) estimates[i].push_back(object.estimate(id));
    }
  }
  return estimates;
}

}  // namespace boresight::bench::scenarios
