// Places that objects take, and objects that are parts of one.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

/// log of a normal density.
double log_density(const Vector2<double>& e, const Symmetric2<double>& covariance) {
  return -0.5 * quadratic(inverse(covariance), e) - 0.5 * std::log(determinant(covariance)) -
         std::log(2.0 * std::numbers::pi);
}

}  // namespace

double RadarModel::taken_by(std::uint32_t label, const Vector2<double>& position_m,
                            const Symmetric2<double>& covariance_m2, double speed_mps,
                            const Vector2<double>& place_m) const {
  const BirthParameters& b = parameters_.birth;
  const Vector2<double> d = place_m - position_m;
  const BoxMemory* object = memory(label);
  if (object == nullptr || !object->has_point) {
    const double r2 = squared_norm(d) / (b.person_m * b.person_m);
    return std::exp(-std::numbers::ln2 * r2 * r2);
  }
  double taken = 0.0;
  const double headway_m = b.headway_s * speed_mps;
  const BoxEstimator::Place place = boxes_.estimator().place(*object, d, covariance_m2);
  for (std::size_t k = 0; k < object->probability.size(); ++k) {
    if (object->probability[k] < parameters_.box.least_probability) continue;
    const auto within = [&](double along_m) {
      return boxes_.estimator().inside(*object, k, place, {along_m, b.gap_across_m});
    };
    const double with_headway = within(b.gap_along_m + headway_m);
    if (with_headway <= 0.0) continue;  // all the more without
    taken += object->probability[k] * ((1.0 - b.close_share) * with_headway + b.close_share * within(b.gap_along_m));
  }
  return taken;
}

double RadarModel::log_odds_of_part(const Component<double>& whole, const Component<double>& part) {
  const BirthParameters& b = parameters_.birth;
  const Vector2<double> d = part.position_m - whole.position_m;
  if (squared_norm(d) > reach_m_ * reach_m_) return -kInfinity;
  const BoxMemory *of_whole = memory(whole.label), *of_part = memory(part.label);
  if (of_whole == nullptr || of_part == nullptr || !of_whole->has_point || !of_part->has_point) return -kInfinity;
  const BoxEstimator& boxes = boxes_.estimator();
  const double unlikely = parameters_.box.least_probability, least_apart = parameters_.box.least_doubt;
  // Reflections anywhere in the box; two objects do not overlap.
  const Symmetric2<double> covariance = whole.position_covariance + part.position_covariance;
  const BoxEstimator::Place place = boxes.place(*of_whole, d, covariance);
  double one = 0.0;
  for (std::size_t k = 0; k < of_whole->probability.size(); ++k) {
    if (of_whole->probability[k] < unlikely) continue;
    one += of_whole->probability[k] * boxes.inside(*of_whole, k, place, {0.0, 0.0}) /
           (of_whole->classes[k].length_m * boxes.table()[k].size.width_mean_m);
  }
  if (one <= 0.0) return -kInfinity;
  const Vector2<double> dv = part.velocity_mps - whole.velocity_mps;
  const Symmetric2<double> cv = whole.velocity_covariance + part.velocity_covariance;
  const double between = b.neighbour_speed_std_mps * b.neighbour_speed_std_mps;
  // People walk in company, vehicles keep their distance.
  const double of_person = of_whole->probability[static_cast<std::size_t>(extended_object::RoadUserClass::kPedestrian)];
  const double neighbours = of_person * b.company_density_per_m2 + (1.0 - of_person) * b.neighbour_density_per_m2;
  const double of_motion = log_density(dv, cv) - std::log(neighbours) -
                           log_density(dv, cv + Symmetric2<double>{between, 0.0, between}) - std::log(b.part_odds);
  // Most pairs are two objects however little they are apart.
  if (std::log(one / least_apart) + of_motion <= 0.0) return -kInfinity;
  double apart = 0.0;
  const double headway_m = b.headway_s * std::sqrt(squared_norm(whole.velocity_mps));
  const double c = std::cos(of_part->heading_rad), s = std::sin(of_part->heading_rad);
  for (std::size_t l = 0; l < of_part->probability.size(); ++l) {
    if (of_part->probability[l] < unlikely) continue;
    const ClassBox& other = of_part->classes[l];
    const Vector2<double> centre = {d.x - c * other.point_m.x() + s * other.point_m.y(),
                                    d.y - s * other.point_m.x() - c * other.point_m.y()};
    const Symmetric2<double> spread = covariance + (other.length_variance_m2 * other.point_by_length.squaredNorm()) *
                                                       Symmetric2<double>{c * c, c * s, s * s};
    const BoxEstimator::Place at = boxes.place(*of_whole, centre, spread);
    for (std::size_t k = 0; k < of_whole->probability.size(); ++k) {
      if (of_whole->probability[k] < unlikely) continue;
      const auto overlap = [&](double gap_m) {
        return boxes.inside(*of_whole, k, at, {0.5 * other.length_m + gap_m, 0.5 * boxes.table()[l].size.width_mean_m});
      };
      apart += of_whole->probability[k] * of_part->probability[l] *
               (1.0 - (1.0 - b.close_share) * overlap(headway_m) - b.close_share * overlap(0.0));
    }
  }
  return std::log(one) - std::log(std::max(least_apart, apart)) + of_motion;
}

void RadarModel::join(const Component<double>& whole, const Component<double>& part, std::uint32_t label) {
  boxes_.join(whole, part, label);
}

}  // namespace boresight::tracking
