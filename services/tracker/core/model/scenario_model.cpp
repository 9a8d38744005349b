#include "services/tracker/core/model/scenario_model.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

ScenarioModel::ScenarioModel(const LinearScenario& s) : scenario_(s) {
  motion_.acceleration_density = s.acceleration_density;
  motion_.rate_memory_s = s.rate_forgetting > 1.0 ? s.step_s / std::log(s.rate_forgetting) : kInfinity;
  motion_.extent_memory_s = s.extent_memory_s;
  view_.detection_probability = s.detection_probability;
  view_.noise_m2 = {s.noise_variance_m2, 0.0, s.noise_variance_m2};
  view_.range_rate_variance = s.range_rate_std_mps * s.range_rate_std_mps;
  view_.spread = s.spread;
  const Eigen::Vector2d span_m = s.area_max_m - s.area_min_m;
  log_clutter_ = std::log(std::max(kLeastProbability, s.clutter_per_scan) / (span_m.x() * span_m.y()));
  if (s.range_rate_std_mps > 0.0) log_clutter_ -= std::log(s.clutter_range_rate_span_mps);
  for (const ScenarioBirth& b : s.births) {
    PoissonComponent birth;
    birth.weight = s.birth_weight;
    Component<double>& c = birth.component;
    c.position_m = {b.mean[0], b.mean[1]};
    c.velocity_mps = {b.mean[2], b.mean[3]};
    c.position_covariance = {b.std[0] * b.std[0], 0.0, b.std[1] * b.std[1]};
    c.velocity_covariance = {b.std[2] * b.std[2], 0.0, b.std[3] * b.std[3]};
    c.extent_dof = b.extent_dof;
    c.extent_scale = {b.extent_scale(0, 0), b.extent_scale(0, 1), b.extent_scale(1, 1)};
    c.rate_shape = b.rate_shape;
    c.rate_inverse_scale = b.rate_inverse_scale;
    births_.push_back(birth);
    greatest_speed_mps_ =
        std::max(greatest_speed_mps_, (b.mean.tail<2>().cwiseAbs() + s.speed_sigma * b.std.tail<2>()).norm());
    // Detections of one newborn lie within some standard deviations of each other along its long axis.
    const Symmetric2<double> r = s.spread * extent(c) + view_.noise_m2;
    const double mean = 0.5 * trace(r), half = 0.5 * (r.xx - r.yy);
    link_distance_m_ =
        std::max(link_distance_m_, s.link_sigma * std::sqrt(mean + std::sqrt(half * half + r.xy * r.xy)));
  }
  measurements_.reserve(kMaxDetections);
}

ScanStart ScenarioModel::begin_scan(const ClassifiedScan& scan) {
  ScanStart start;
  const std::int64_t now_ns = scan.header.measurement_time_ns;
  // A scenario has steps of one length; the first scan is one step after the start.
  start.elapsed_s = has_time_ ? static_cast<double>(now_ns - time_ns_) * 1e-9 : scenario_.step_s;
  has_time_ = true;
  time_ns_ = now_ns;
  measurements_.clear();
  for (std::uint32_t i = 0; i < scan.number_of_valid_detections; ++i) {
    Measurement<double> z;
    z.position_m = {static_cast<double>(scan.x_vehicle_m[i]), static_cast<double>(scan.y_vehicle_m[i])};
    const double range_m = std::hypot(z.position_m.x, z.position_m.y);
    if (range_m > 0.0) z.sight = (1.0 / range_m) * z.position_m;
    z.range_rate_mps = static_cast<double>(scan.range_rate_over_ground_mps[i]);
    z.log_clutter = log_clutter_;
    measurements_.push_back(z);
  }
  return start;
}

double ScenarioModel::predict(Component<double>& component, double elapsed_s) const {
  tracking::predict(component, motion_, elapsed_s);
  return scenario_.survival_probability;
}

double ScenarioModel::log_newborn(const Cell<double>&) {
  return -kInfinity;
}

bool ScenarioModel::are_linked(const Measurement<double>& a, const Measurement<double>& b) const {
  if (squared_norm(a.position_m - b.position_m) > link_distance_m_ * link_distance_m_) return false;
  if (view_.range_rate_variance <= 0.0) return true;
  // Of one velocity: ṙ_a − ṙ_b = (u_a − u_b)ᵀ v + noise.
  const double limit_mps = scenario_.link_sigma * std::sqrt(2.0 * view_.range_rate_variance) +
                           greatest_speed_mps_ * std::sqrt(squared_norm(a.sight - b.sight));
  return std::abs(a.range_rate_mps - b.range_rate_mps) <= limit_mps;
}

}  // namespace boresight::tracking
