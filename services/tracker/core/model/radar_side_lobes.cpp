// Side lobes. The echo of an object also enters by the antenna's side lobes: a detection of the object's own range and
// range rate at another azimuth, weaker, and there as long as the object is. What a component is, is judged from scan
// to scan by
//
//     (1)  odds of side lobe to object = u + h Σ_j r_j λ_j(range, range rate) / λ_o(velocity) · q(strength)
//
// over the other objects j: λ_j is the density of lasting side lobes of j, λ_o that of vehicles beside j, and q how
// much likelier the difference of the mean strengths is of a side lobe. All of them are those of the latest estimates:
// the odds of one scan replace those of the scan before, for scans are not independent. Only what no later scan undoes
// is multiplied: u is the prior that the parent is not established yet, h the chance that a side lobe has left the ring
// of its parent for as long as this one did.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

double centred_density(double e, double variance) {
  return std::exp(-0.5 * e * e / variance) / std::sqrt(2.0 * std::numbers::pi * variance);
}

}  // namespace

RadarModel::Ring RadarModel::ring_of(const Component<double>& c) const {
  const Vector2<double> way = c.position_m - sensor_m_;
  const double range_m = std::max(kLeastRange_m, std::sqrt(squared_norm(way)));
  const Vector2<double> sight = (1.0 / range_m) * way;
  return {range_m, dot(sight, c.velocity_mps - sensor_velocity_mps_), quadratic(c.position_covariance, sight),
          quadratic(c.velocity_covariance, sight), sight};
}

RadarModel::RingSpread RadarModel::ring_spread(const KnownObject& parent, const Ring& r) const {
  const double rate_std_mps = parameters_.source.side_lobe_range_rate_std_mps;
  return {parent.ring_depth_m2 + r.range_variance_m2,
          rate_std_mps * rate_std_mps + parent.ring.range_rate_variance_m2ps2 + r.range_rate_variance_m2ps2};
}

double RadarModel::ring_distance(const KnownObject& parent, const Ring& r) const {
  const RingSpread spread = ring_spread(parent, r);
  const double a = r.range_m - parent.ring.range_m, b = r.range_rate_mps - parent.ring.range_rate_mps;
  return a * a / spread.range_m2 + b * b / spread.range_rate_m2ps2;
}

double RadarModel::side_lobe_density(const KnownObject& parent, const Ring& r, double distance) const {
  const RingSpread spread = ring_spread(parent, r);
  return std::exp(-0.5 * distance) / (2.0 * std::numbers::pi * std::sqrt(spread.range_m2 * spread.range_rate_m2ps2)) /
         (2.0 * radar_->half_view_rad * std::max(parameters_.source.side_lobe_nearest_m, parent.ring.range_m));
}

double RadarModel::beside_share(const KnownObject& object, const Vector2<double>& place_m,
                                const Symmetric2<double>& noise_m2, const Vector2<double>& sight) const {
  const SourceParameters& s = parameters_.source;
  const Component<double>& c = object.component;
  const Symmetric2<double> covariance = c.position_covariance + noise_m2;
  // Outside the main lobe …
  const Vector2<double> across{-sight.y, sight.x};
  const double off_m = std::abs(dot(across, place_m - c.position_m)), least_m = object.ring.range_m * s.main_lobe_rad;
  const double outside =
      0.5 * std::erfc((least_m - off_m) / std::sqrt(2.0 * std::max(kLeastProbability, quadratic(covariance, across))));
  if (outside < parameters_.box.least_probability) return 0.0;
  // … and outside the body.
  const Vector2<double> d = place_m - c.position_m;
  const BoxMemory* box = memory(c.label);
  if (box == nullptr || !box->has_point) {
    const Symmetric2<double> scatter = parameters_.detection.spread * extent(c) + covariance;
    return quadratic(inverse(scatter), d) < s.side_lobe_least_deviations * s.side_lobe_least_deviations ? 0.0 : outside;
  }
  double own = 0.0;
  const BoxEstimator::Place place = boxes_.estimator().place(*box, d, covariance);
  for (std::size_t k = 0; k < box->probability.size(); ++k) {
    if (box->probability[k] < parameters_.box.least_probability) continue;
    own += box->probability[k] * boxes_.estimator().inside(*box, k, place, {0.0, 0.0});
  }
  return outside * std::max(0.0, 1.0 - own);
}

double RadarModel::strength_odds(const MeanStrength& lobe, const MeanStrength& parent) const {
  if (lobe.number <= 0.0 || parent.number <= 0.0) return 1.0;
  const SourceParameters& s = parameters_.source;
  // The first detections count in full, later ones are not independent of them.
  const auto independent = [&](double n) {
    const double share = parameters_.box.evidence_share;
    return share * n + (1.0 - share) * std::min(1.0, n);
  };
  const double of_means =
      s.strength_std_db * s.strength_std_db * (1.0 / independent(lobe.number) + 1.0 / independent(parent.number));
  const double difference_db = lobe.mean_db - parent.mean_db;
  return centred_density(difference_db - s.side_lobe_strength_db,
                         s.side_lobe_strength_std_db * s.side_lobe_strength_std_db + of_means) /
         centred_density(difference_db, 2.0 * s.object_strength_std_db * s.object_strength_std_db + of_means);
}

void RadarModel::find_rings() {
  const SourceParameters& s = parameters_.source;
  for (KnownObject& o : objects_) {
    o.ring = ring_of(o.component);
    o.ring_depth_m2 = s.side_lobe_range_std_m * s.side_lobe_range_std_m + o.ring.range_variance_m2 +
                      parameters_.detection.spread * quadratic(extent(o.component), o.ring.sight);
    o.in_beam = o.ring.range_m > radar_->range_max_m ? 0.0 : o.existence * in_view(o.component);
    o.lobes_on_ring = 0.0;
  }
  lobes_.clear();
  for (const KnownObject& o : objects_) {
    if (o.side_lobe > 0.0) lobes_.push_back({o.ring.range_m, o.ring.range_variance_m2, &o});
  }
  for (KnownObject& parent : objects_) {
    for (const Lobe& lobe : lobes_) {
      const double off_m = lobe.range_m - parent.ring.range_m;
      if (off_m * off_m > s.side_lobe_chi2 * (parent.ring_depth_m2 + lobe.range_variance_m2)) continue;
      if (lobe.object != &parent && ring_distance(parent, lobe.object->ring) <= s.side_lobe_chi2) {
        parent.lobes_on_ring += lobe.object->side_lobe;
      }
    }
  }
}

double RadarModel::side_lobe_level(double lobes_on_ring) const {
  // Gamma-Poisson: few objects give most side lobes.
  const SourceParameters& s = parameters_.source;
  const double lasting = s.side_lobes * s.side_lobe_birth;
  return s.side_lobes * (s.side_lobe_shape + lobes_on_ring) / (s.side_lobe_shape + lasting);
}

void RadarModel::add_side_lobes() {
  const SourceParameters& s = parameters_.source;
  for (const KnownObject& o : objects_) {
    if (o.in_beam < s.parent_existence) continue;
    const double level = o.in_beam * side_lobe_level(o.lobes_on_ring);
    const MeanStrength strength{o.component.strength_db, o.component.strengths};
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
      Measurement<double>& z = measurements_[i];
      const Ring at{places_[i].range_m, places_[i].range_rate_mps, 0.0, 0.0, z.sight};
      const double distance = ring_distance(o, at);
      if (distance > s.side_lobe_chi2) continue;
      const double beside = beside_share(o, z.position_m, noise_at(z.sight, places_[i].range_m), z.sight);
      if (beside <= 0.0) continue;
      add_clutter(
          z,
          level * beside * side_lobe_density(o, at, distance) * strength_odds({z.strength_db, z.strengths}, strength),
          z.side_lobe_share);
    }
  }
}

void RadarModel::find_partners() {
  const SourceParameters& s = parameters_.source;
  by_range_.clear();
  for (std::size_t i = 0; i < measurements_.size(); ++i) by_range_.push_back(i);
  std::sort(by_range_.begin(), by_range_.end(),
            [this](std::size_t a, std::size_t b) { return places_[a].range_m < places_[b].range_m; });
  const double reach = std::sqrt(s.side_lobe_chi2);
  const auto note = [&](Measurement<double>& lobe, const Measurement<double>& parent, double likely) {
    const double odds = strength_odds({lobe.strength_db, lobe.strengths}, {parent.strength_db, parent.strengths});
    lobe.partner = std::max(lobe.partner, likely * std::min(1.0, odds));
  };
  for (std::size_t a = 0; a < by_range_.size(); ++a) {
    const std::size_t i = by_range_[a];
    for (std::size_t b = a + 1; b < by_range_.size(); ++b) {
      const std::size_t j = by_range_[b];
      const double off_m = (places_[j].range_m - places_[i].range_m) / s.side_lobe_range_std_m;
      if (off_m > reach) break;
      const double off_mps = (places_[j].range_rate_mps - places_[i].range_rate_mps) / s.side_lobe_range_rate_std_mps;
      const double distance = off_m * off_m + off_mps * off_mps;
      const double apart_m = std::max(parameters_.birth.link_distance_m, places_[i].range_m * s.main_lobe_rad);
      if (distance > s.side_lobe_chi2 ||
          squared_norm(measurements_[j].position_m - measurements_[i].position_m) < apart_m * apart_m) {
        continue;
      }
      const double likely = std::exp(-0.5 * distance);
      note(measurements_[i], measurements_[j], likely);
      note(measurements_[j], measurements_[i], likely);
    }
  }
}

double RadarModel::side_lobe_of(std::uint32_t label) const {
  if (label == 0) return 0.0;
  const auto known = std::find_if(objects_.begin(), objects_.end(),
                                  [label](const KnownObject& o) { return o.component.label == label; });
  return known == objects_.end() ? 0.0 : known->side_lobe;
}

RadarModel::LobeEvidence RadarModel::side_lobe_evidence(const Component<double>& c) const {
  const SourceParameters& s = parameters_.source;
  const BirthParameters& b = parameters_.birth;
  const Ring ring = ring_of(c);
  const double flat = b.any.density_per_m2 / (std::sqrt(2.0 * std::numbers::pi) * b.any.speed_std_mps);
  const Symmetric2<double> noise = noise_at(ring.sight, ring.range_m);
  LobeEvidence e;
  for (const KnownObject& o : objects_) {
    const double off_m = ring.range_m - o.ring.range_m;
    if (off_m * off_m > s.side_lobe_chi2 * (o.ring_depth_m2 + ring.range_variance_m2) || o.in_beam <= 0.0 ||
        (c.label != 0 && o.component.label == c.label)) {
      continue;
    }
    const double distance = ring_distance(o, ring);
    if (distance > s.side_lobe_chi2) continue;
    const double beside = beside_share(o, c.position_m, noise + c.position_covariance, ring.sight);
    if (beside <= 0.0) continue;
    // That it may lie in the main lobe is in the odds. It does not leave the ring by that.
    e.on_ring = std::max(e.on_ring, o.in_beam);
    const double lasting = s.side_lobe_birth * side_lobe_level(std::max(0.0, o.lobes_on_ring - side_lobe_of(c.label)));
    // Another vehicle drives about as this one does.
    const double apart_mps = dot(ring.sight, c.velocity_mps - o.component.velocity_mps);
    const double apart_variance = b.neighbour_speed_std_mps * b.neighbour_speed_std_mps +
                                  ring.range_rate_variance_m2ps2 +
                                  quadratic(o.component.velocity_covariance, ring.sight);
    const double object = b.neighbour_density_per_m2 * centred_density(apart_mps, apart_variance) + flat;
    e.odds += o.in_beam * beside * lasting * side_lobe_density(o, ring, distance) / object *
              strength_odds({c.strength_db, c.strengths}, {o.component.strength_db, o.component.strengths});
  }
  return e;
}

void RadarModel::begin_side_lobe(SourceClasses<double>& source, const Component<double>& c, double hidden) const {
  source.hidden_parent = hidden;
  source.kept_ring = 1.0;
  source.side_lobe_odds = hidden + side_lobe_evidence(c).odds;
}

void RadarModel::weigh_side_lobe(Component<double>& c) const {
  SourceClasses<double>& source = c.source;
  const bool is_of_other_radar = source.radar >= 0 && source.radar != radar_index_;
  if (source.side_lobe < kLeastProbability || source.side_lobe_odds <= 0.0 || is_of_other_radar) return;
  const LobeEvidence e = side_lobe_evidence(c);
  // A parent is stronger than its side lobe: that it is not detected is a miss.
  const double miss = std::pow(1.0 - parameters_.detection.detection_probability, parameters_.box.evidence_share);
  source.hidden_parent *= miss;
  source.kept_ring *= e.on_ring + (1.0 - e.on_ring) * miss;
  const double odds = source.hidden_parent + source.kept_ring * e.odds;
  const double lobe = source.side_lobe * odds / source.side_lobe_odds;
  const double sum = 1.0 - source.side_lobe + lobe;
  source.side_lobe_odds = odds;
  source.object /= sum;
  source.lasting_source /= sum;
  source.side_lobe = lobe / sum;
}

}  // namespace boresight::tracking
