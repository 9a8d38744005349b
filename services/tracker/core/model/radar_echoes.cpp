// Detections in the boxes of tracked objects with range rates of moving parts or off by a Doppler ambiguity. They add
// to the clutter there, so that nothing new starts.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/common/extended_object/range_rate_model.hpp"
#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

void RadarModel::add_clutter(Measurement<double>& z, double added, double& share) {
  const double base = std::exp(z.log_clutter), sum = base + added, was = share * base;
  z.side_lobe_share *= base / sum;
  z.wide_share *= base / sum;
  share = (was + added) / sum;
  z.log_clutter = std::log(sum);
}

void RadarModel::add_wide_range_rates() {
  const SourceParameters& s = parameters_.source;
  const BoxEstimator& boxes = boxes_.estimator();
  const double least = parameters_.box.least_probability;
  const double level = radar_->wide_seen / radar_->wide_expected;
  double seen = 0.0, expected = 0.0;
  for (const KnownObject& o : objects_) {
    if (o.existence < s.parent_existence) continue;
    const Component<double>& c = o.component;
    const Vector2<double> way = c.position_m - sensor_m_;
    const double range_m = std::max(kLeastRange_m, std::sqrt(squared_norm(way)));
    const ObjectBoxes::Record* object = boxes_.see(c, noise_at((1.0 / range_m) * way, range_m));
    if (object == nullptr || !object->memory.has_point) continue;
    const double cosine = std::cos(object->memory.heading_rad), sine = std::sin(object->memory.heading_rad);
    const double speed_mps = std::sqrt(squared_norm(c.velocity_mps));
    for (const ClassView& view : object->views) {
      expected += o.existence * view.probability * view.expected_detections * (view.wide_share + s.ambiguity_share);
    }
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
      Measurement<double>& z = measurements_[i];
      const Vector2<double> d = z.position_m - c.position_m;
      if (squared_norm(d) > reach_m_ * reach_m_) continue;
      const Symmetric2<double> covariance = c.position_covariance + noise_at(z.sight, places_[i].range_m);
      const double body_mps = dot(z.sight, c.velocity_mps);
      const Eigen::Vector2d sight_box(cosine * z.sight.x + sine * z.sight.y, cosine * z.sight.y - sine * z.sight.x);
      const BoxEstimator::Place place = boxes.place(object->memory, d, covariance);
      double added = 0.0, inside_any = 0.0, body_variance = 0.0;
      for (std::size_t k = 0; k < object->views.size(); ++k) {
        const ClassView& view = object->views[k];
        if (view.probability < least) continue;
        const double inside = boxes.inside(object->memory, k, place, {0.0, 0.0});
        if (inside < least) continue;
        const auto rates =
            extended_object::range_rate_mixture(boxes.table()[k].micro_doppler, sight_box, body_mps, speed_mps);
        const double deviation = z.range_rate_mps - rates[2].mean_mps;
        const double of_parts = rates[2].weight * std::exp(-0.5 * deviation * deviation / rates[2].variance_m2ps2) /
                                std::sqrt(2.0 * std::numbers::pi * rates[2].variance_m2ps2);
        added += view.probability * view.expected_detections * inside /
                 (object->memory.classes[k].length_m * boxes.table()[k].size.width_mean_m) *
                 (of_parts + s.ambiguity_share / s.ambiguity_width_mps);
        inside_any += view.probability * inside;
        body_variance += view.probability * view.range_rate_variance_m2ps2;
      }
      added *= o.existence * level;
      if (added <= 0.0) continue;
      // What deviates so much is no detection of the body.
      const double variance = body_variance + radar_->range_rate_std_mps * radar_->range_rate_std_mps +
                              quadratic(c.velocity_covariance, z.sight);
      const double off_mps = z.range_rate_mps - body_mps;
      if (off_mps * off_mps > s.wide_chi2 * variance) seen += o.existence * inside_any;
      add_clutter(z, added, z.wide_share);
    }
  }
  radar_->wide_seen += seen;
  radar_->wide_expected += expected;
}

}  // namespace boresight::tracking
