// The model of simulated scenarios: linear measurements of the position, uniform clutter, births at known places.
#pragma once

#include <limits>
#include <vector>

#include "services/tracker/core/model/linear_scenario.hpp"
#include "services/tracker/core/model/model.hpp"

namespace boresight::tracking {

class ScenarioModel final : public Model {
 public:
  explicit ScenarioModel(const LinearScenario& scenario);

  ScanStart begin_scan(const ClassifiedScan& scan) override;
  [[nodiscard]] std::span<const Measurement<double>> measurements() const override { return measurements_; }
  double predict(Component<double>& component, double elapsed_s) const override;
  [[nodiscard]] View<double> view(const Component<double>&) const override { return view_; }
  [[nodiscard]] std::span<const PoissonComponent> births() const override { return births_; }
  [[nodiscard]] bool has_births_anywhere() const override { return false; }
  void begin_group(std::span<const Measurement<double>>, std::span<const Prediction<double>>,
                   std::span<const double>) override {}
  [[nodiscard]] double log_newborn(const Cell<double>&) override;
  [[nodiscard]] Component<double> newborn(const Cell<double>&) override { return {}; }
  [[nodiscard]] double log_odds_of_part(const Component<double>&, const Component<double>&) override {
    return -std::numeric_limits<double>::infinity();
  }
  void join(const Component<double>&, const Component<double>&, std::uint32_t) override {}
  [[nodiscard]] double spread() const override { return scenario_.spread; }
  [[nodiscard]] bool are_linked(const Measurement<double>& a, const Measurement<double>& b) const override;
  [[nodiscard]] double link_distance_m() const override { return link_distance_m_; }
  void learn(std::span<const double>, std::span<const ObjectEstimate>) override {}

 private:
  LinearScenario scenario_;
  MotionParameters motion_;
  View<double> view_;
  std::vector<PoissonComponent> births_;
  std::vector<Measurement<double>> measurements_;
  double link_distance_m_ = 0.0, log_clutter_ = 0.0;
  double greatest_speed_mps_ = 0.0;  // of a newborn
  std::int64_t time_ns_ = 0;
  bool has_time_ = false;
};

}  // namespace boresight::tracking
