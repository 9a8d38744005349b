// Births of the radar model: what a cell of detections that no object explains may be. It may be a new object of one of
// three kinds of motion, a source of clutter or a side lobe. Nothing new appears inside an object that exists.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

void RadarModel::begin_group(std::span<const Measurement<double>> group, std::span<const Prediction<double>> objects,
                             std::span<const double> existence) {
  group_objects_ = objects;
  group_existence_ = existence;
  if (group.empty() || radar_ == nullptr) return;
  Vector2<double> middle;
  for (const auto& z : group) middle = middle + (1.0 / static_cast<double>(group.size())) * z.position_m;
  const DetectionParameters& d = parameters_.detection;
  const BirthParameters& b = parameters_.birth;
  View<double> v;
  const Vector2<double> sight_m = middle - sensor_m_;
  const double range_m = std::max(kLeastRange_m, std::sqrt(squared_norm(sight_m)));
  v.detection_probability = d.detection_probability;
  v.exposure = exposure_at(range_m);
  v.noise_m2 = noise_at((1.0 / range_m) * sight_m, range_m);
  v.range_rate_variance =
      radar_->range_rate_std_mps * radar_->range_rate_std_mps + d.body_range_rate_std_mps * d.body_range_rate_std_mps;
  v.spread = d.spread;
  v.source_more = parameters_.source.more;
  v.evidence_share = parameters_.box.evidence_share;
  const std::array kinds = {b.slow, b.any, b.traffic};
  for (std::size_t k = 0; k < kBirthKinds; ++k) {
    Component<double> c;
    c.position_m = middle;
    c.rate_shape = d.count_shape;
    c.rate_inverse_scale = d.count_shape / d.count;
    c.position_covariance = {b.place_std_m * b.place_std_m, 0.0, b.place_std_m * b.place_std_m};
    const double variance = kinds[k].speed_std_mps * kinds[k].speed_std_mps;
    c.velocity_covariance = {variance, 0.0, variance};
    if (kinds[k].with_traffic) c.velocity_mps = sensor_velocity_mps_;
    v.turn_mps = turn_at(sight_m, c);
    c.extent_dof = b.extent_dof;
    const double scale = (b.extent_dof - 6.0) * b.half_length_m * b.half_length_m;
    c.extent_scale = {scale, 0.0, scale};
    // The density of the badly known place is taken away again.
    newborn_[k] = {
        c, Prediction<double>(c, v),
        std::log(kinds[k].density_per_m2) + std::log(2.0 * std::numbers::pi * b.place_std_m * b.place_std_m)};
  }
}

RadarModel::NewbornWeights RadarModel::newborn_weights(const Cell<double>& cell) {
  const BirthParameters& b = parameters_.birth;
  const SourceParameters& s = parameters_.source;
  const double f = 1.0 / cell.n;
  const Vector2<double> mean = cell.mean();
  double claimed = 0.25 * std::numeric_limits<double>::epsilon();  // less does not change 1 − claimed
  const Vector2<double> way = mean - sensor_m_;
  const double range_m = std::max(kLeastRange_m, std::sqrt(squared_norm(way)));
  const Vector2<double> sight = (1.0 / range_m) * way;
  const Symmetric2<double> noise = noise_at(sight, range_m);
  for (std::size_t l = 0; l < group_objects_.size(); ++l) {
    const Prediction<double>& p = group_objects_[l];
    if (group_existence_[l] <= claimed) continue;
    // The chance that the place is taken; the range rates must agree.
    const double mean_rate = dot(cell.sight_rate, p.velocity_mps()) * f;
    const double deviation =
        (cell.rate_squares * f - 2.0 * mean_rate + quadratic(cell.sight_squares, p.velocity_mps()) * f) /
        (p.range_rate_variance() + quadratic(p.velocity_covariance(), sight));
    const double agreeing = group_existence_[l] * std::exp(-0.5 * deviation / b.same_speed_chi2);
    if (agreeing <= claimed) continue;
    claimed = std::max(claimed, agreeing * taken_by(p.label(), p.position_m(), p.position_covariance() + f * noise,
                                                    std::sqrt(squared_norm(p.velocity_mps())), mean));
  }
  const double log_free = std::log(std::max(kLeastProbability, 1.0 - claimed));
  NewbornWeights w;
  std::array<double, kBirthKinds> log_p{};
  for (std::size_t k = 0; k < kBirthKinds; ++k) {
    newborn_[k].prediction.move_to(mean);
    log_p[k] = newborn_[k].prediction.log_likelihood(cell);
    w.object[k] = log_p[k] + newborn_[k].log_density + log_free;
  }
  // A source of clutter lies where clutter is, and its range rate is as clutter's: the density of an object's range
  // rate is taken away, that of the clutter put in its place.
  Newborn& any = newborn_[1];
  const double variance = b.any.speed_std_mps * b.any.speed_std_mps + any.prediction.range_rate_variance();
  const double log_rate = -0.5 * std::log(2.0 * std::numbers::pi * variance) - 0.5 * cell.rate_squares * f / variance;
  const double flat = log_p[1] + any.log_density - std::log(b.any.density_per_m2) + cell.log_clutter * f - log_rate;
  const double other = std::max(kLeastProbability, 1.0 - cell.wide_share * f);
  w.source = s.share > 0.0 ? flat + std::log(s.share * other) + any.prediction.log_source_ratio(cell.n) : -kInfinity;
  w.side_lobe = s.side_lobes > 0.0 && s.side_lobe_birth > 0.0
                    ? flat + std::log(s.side_lobe_birth * std::max(kLeastProbability, cell.side_lobe_share * f))
                    : -kInfinity;
  // An object that is not established either may give the cell as its side lobe: as many of them as of the objects
  // themselves, and the parent is detected now.
  const double missed = 1.0 - parameters_.detection.detection_probability;
  const double partner = missed + (1.0 - missed) * std::clamp(cell.partner * f, 0.0, 1.0);
  w.hidden_parent =
      s.side_lobes * s.side_lobe_birth * partner * std::exp(std::min(0.0, any.prediction.log_source_ratio(cell.n)));
  w.top = std::max(w.source, w.side_lobe);
  for (const double o : w.object) w.top = std::max(w.top, o);
  w.sum = std::exp(w.source - w.top) + std::exp(w.side_lobe - w.top);
  for (const double o : w.object) w.sum += (1.0 + w.hidden_parent) * std::exp(o - w.top);
  return w;
}

double RadarModel::log_newborn(const Cell<double>& cell) {
  const NewbornWeights w = newborn_weights(cell);
  return w.top + std::log(w.sum);
}

Component<double> RadarModel::newborn(const Cell<double>& cell) {
  const NewbornWeights w = newborn_weights(cell);
  std::array<Component<double>, kBirthKinds> updated;
  std::array<WeightedComponent<double>, kBirthKinds> mixture;
  double object = 0.0;
  for (std::size_t k = 0; k < kBirthKinds; ++k) {
    Component<double> at = newborn_[k].component;
    at.position_m = cell.mean();
    updated[k] = newborn_[k].prediction.updated(at, cell);
    const double weight = std::exp(w.object[k] - w.top);
    object += weight;
    mixture[k] = {weight + kLeastDensity, &updated[k]};  // a sum of zero cannot be normalised
  }
  Component<double> c = merge<double>(mixture);
  c.source.object = object / w.sum;
  c.source.side_lobe = (std::exp(w.side_lobe - w.top) + w.hidden_parent * object) / w.sum;
  c.source.lasting_source = std::exp(w.source - w.top) / w.sum * parameters_.source.lasting_share;
  c.source.radar = radar_index_;
  begin_side_lobe(c.source, c, w.hidden_parent);
  c.mirror = cell.mirror / cell.n;
  return c;
}

}  // namespace boresight::tracking
