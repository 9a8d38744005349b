// A model made of lists, for tests of filters: the test names measurements and births of each scan.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "services/tracker/core/model/model.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::support {

/// A world of lists: the measurements and births of the next scan are set by the test.
class ListModel final : public Model {
 public:
  MotionParameters motion;
  View<double> sensor;
  double survival = 0.99;
  Detections list;                      ///< of the next scan
  std::vector<PoissonComponent> born;   ///< of the next scan
  double anywhere_per_m2 = 0.0;         ///< density of births at any place; 0: none
  Component<double> newborn_prior;      ///< of such a birth, at the mean of its detections
  double link_m = 5.0, link_mps = 4.0;  ///< detections of one newborn are not farther apart
  double one_within_m = 0.0;            ///< objects nearer to each other are parts of one

  ScanStart begin_scan(const ClassifiedScan&) override { return {}; }
  [[nodiscard]] std::span<const Measurement<double>> measurements() const override { return list; }
  double predict(Component<double>& component, double elapsed_s) const override {
    tracking::predict(component, motion, elapsed_s);
    return survival;
  }
  [[nodiscard]] View<double> view(const Component<double>&) const override { return sensor; }
  [[nodiscard]] std::span<const PoissonComponent> births() const override { return born; }
  [[nodiscard]] bool has_births_anywhere() const override { return anywhere_per_m2 > 0.0; }
  void begin_group(std::span<const Measurement<double>>, std::span<const Prediction<double>>,
                   std::span<const double>) override {}
  /// The place of the birth is integrated out: it is known much worse than a cell is large.
  [[nodiscard]] double log_newborn(const Cell<double>& cell) override {
    if (anywhere_per_m2 <= 0.0) return -std::numeric_limits<double>::infinity();
    const Component<double> prior = prior_at(cell);
    const Symmetric2<double> s = prior.position_covariance;
    return std::log(anywhere_per_m2 * 2.0 * std::numbers::pi) + 0.5 * std::log(determinant(s)) +
           Prediction<double>(prior, sensor).log_likelihood(cell);
  }
  [[nodiscard]] Component<double> newborn(const Cell<double>& cell) override {
    const Component<double> prior = prior_at(cell);
    return Prediction<double>(prior, sensor).updated(prior, cell);
  }
  [[nodiscard]] bool are_linked(const Measurement<double>& a, const Measurement<double>& b) const override {
    return squared_norm(a.position_m - b.position_m) <= link_m * link_m &&
           (sensor.range_rate_variance <= 0.0 || std::abs(a.range_rate_mps - b.range_rate_mps) <= link_mps);
  }
  [[nodiscard]] double log_odds_of_part(const Component<double>& a, const Component<double>& b) override {
    return squared_norm(a.position_m - b.position_m) < one_within_m * one_within_m ? 1.0 : -1.0;
  }
  void join(const Component<double>&, const Component<double>&, std::uint32_t) override {}
  [[nodiscard]] double spread() const override { return sensor.spread; }
  [[nodiscard]] double link_distance_m() const override { return link_m; }
  void learn(std::span<const double>, std::span<const ObjectEstimate>) override {}

 private:
  [[nodiscard]] Component<double> prior_at(const Cell<double>& cell) const {
    Component<double> c = newborn_prior;
    c.position_m = cell.mean();
    return c;
  }
};

/// Cars seen by a sensor in the origin, ten scans a second.
inline ListModel car_model(bool has_range_rates) {
  ListModel m;
  m.motion.acceleration_density = 2.0;
  m.motion.rate_memory_s = 1.0;
  m.motion.extent_memory_s = 5.0;
  m.sensor.detection_probability = 0.9;
  m.sensor.noise_m2 = {0.09, 0.0, 0.09};
  m.sensor.range_rate_variance = has_range_rates ? 0.01 : 0.0;
  return m;
}
/// A car that may be anywhere within a few metres of this state.
inline PoissonComponent car_birth(const Eigen::Vector4d& state, double weight) {
  Reference r;
  r.mean = state;
  r.covariance = Eigen::Vector4d(9.0, 9.0, 4.0, 4.0).asDiagonal();
  r.rate_shape = 16.0;
  r.rate_inverse_scale = 2.0;
  r.dof = 20.0;
  r.scale = 14.0 * Eigen::Vector2d(4.0, 1.0).asDiagonal();
  return {weight, component_of(r)};
}
/// log of 15 false detections a scan on 200 m × 50 m, and range rates over 40 m/s.
inline double car_log_clutter(const ListModel& m) {
  return std::log(15.0 / (200.0 * 50.0)) - (m.sensor.range_rate_variance > 0.0 ? std::log(40.0) : 0.0);
}

}  // namespace boresight::tracking::support
