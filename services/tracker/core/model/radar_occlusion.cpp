#include "services/tracker/core/model/radar_occlusion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

/// P(standard normal < x)
double below(double x) {
  return x > kCertainDeviations ? 1.0 : x < -kCertainDeviations ? 0.0 : 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// ∫ P(standard normal < t) dt up to x.
double integral_below(double x) {
  if (std::abs(x) > kCertainDeviations) return std::max(0.0, x);
  return x * below(x) + std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

/// c of (1): of azimuths within ± `half_rad`, by those within ± `front_half_rad` of `front_rad`.
double covered_share(double half_rad, double front_rad, double front_half_rad, double std_rad) {
  const auto beyond = [&](double edge_rad) {
    return std_rad *
           (integral_below((half_rad - edge_rad) / std_rad) - integral_below((-half_rad - edge_rad) / std_rad));
  };
  const double share = (beyond(front_rad - front_half_rad) - beyond(front_rad + front_half_rad)) / (2.0 * half_rad);
  return std::clamp(share, 0.0, 1.0);
}

}  // namespace

Occlusion::Occlusion(std::size_t max_objects) : index_(std::bit_ceil(2 * max_objects + 2)) {
  outlines_.reserve(max_objects);
}

void Occlusion::begin_scan(const Vector2<double>& sensor_m) {
  sensor_m_ = sensor_m;
  outlines_.clear();
  index_.clear();
}

void Occlusion::add(std::uint32_t label, double existence, const Box& box) {
  if (outlines_.size() == outlines_.capacity()) return;
  Outline o{};
  o.label = label;
  o.existence = existence;
  o.centre_m = Vector2<double>{box.centre_m.x(), box.centre_m.y()} - sensor_m_;
  o.cosine = std::cos(box.heading_rad);
  o.sine = std::sin(box.heading_rad);
  // Whatever its heading, a box covers its width. E[cos 2δ] of the heading's error δ says how much of the rest counts.
  const double known = std::exp(-2.0 * box.heading_variance_rad2);
  o.half_width_m = 0.5 * box.width_m;
  o.half_length_m = o.half_width_m + 0.5 * known * (box.length_m - box.width_m);
  o.range_m = std::sqrt(squared_norm(o.centre_m));
  // Around the sensor there is no outline.
  if (o.range_m <= std::hypot(o.half_length_m, o.half_width_m)) return;
  const Vector2<double> sight = (1.0 / o.range_m) * o.centre_m;
  const Symmetric2<double> covariance{box.covariance_m2(0, 0), box.covariance_m2(0, 1), box.covariance_m2(1, 1)};
  o.range_variance_m2 = quadratic(covariance, sight);
  o.azimuth_variance_rad2 = quadratic(covariance, Vector2<double>{-sight.y, sight.x}) / (o.range_m * o.range_m);
  double least_rad = 0.0, most_rad = 0.0;  // of the corners from the centre
  for (const double along : {-o.half_length_m, o.half_length_m}) {
    for (const double across : {-o.half_width_m, o.half_width_m}) {
      const Vector2<double> corner = {o.centre_m.x + o.cosine * along - o.sine * across,
                                      o.centre_m.y + o.sine * along + o.cosine * across};
      const double off_rad = std::atan2(sight.x * corner.y - sight.y * corner.x, dot(sight, corner));
      least_rad = std::min(least_rad, off_rad);
      most_rad = std::max(most_rad, off_rad);
    }
  }
  o.middle_rad = std::remainder(std::atan2(sight.y, sight.x) + 0.5 * (least_rad + most_rad), 2.0 * std::numbers::pi);
  o.sight = {std::cos(o.middle_rad), std::sin(o.middle_rad)};
  o.half_rad = 0.5 * (most_rad - least_rad);
  static_cast<void>(index_.insert(label, static_cast<int>(outlines_.size())));
  outlines_.push_back(o);
}

Occlusion::Chord Occlusion::chord(const Outline& o, const Vector2<double>& sight) {
  const auto to_box = [&o](const Vector2<double>& v) {
    return Vector2<double>{o.cosine * v.x + o.sine * v.y, o.cosine * v.y - o.sine * v.x};
  };
  const Vector2<double> centre = to_box(o.centre_m), way = to_box(sight);
  const double along = std::max(kLeastProbability, std::abs(way.x)),
               across = std::max(kLeastProbability, std::abs(way.y));
  const double x = std::copysign(1.0, way.x) * centre.x, y = std::copysign(1.0, way.y) * centre.y;
  return {std::max((x - o.half_length_m) / along, (y - o.half_width_m) / across),
          std::min((x + o.half_length_m) / along, (y + o.half_width_m) / across)};
}

bool Occlusion::are_in_line(const Outline& a, const Outline& b, Pair& pair) {
  double middle_rad = b.middle_rad - a.middle_rad;
  if (std::abs(middle_rad) > std::numbers::pi) middle_rad -= std::copysign(2.0 * std::numbers::pi, middle_rad);
  const double variance_rad2 = a.azimuth_variance_rad2 + b.azimuth_variance_rad2;
  const double gap_rad = std::abs(middle_rad) - a.half_rad - b.half_rad;
  if (gap_rad > 0.0 && gap_rad * gap_rad > kCertainDeviations * kCertainDeviations * variance_rad2) return false;
  // A line of sight in the middle of the azimuths of both, or of the gap between them.
  const double at_rad =
      0.5 * (std::max(-a.half_rad, middle_rad - b.half_rad) + std::min(a.half_rad, middle_rad + b.half_rad));
  const double tangent = std::tan(at_rad), per_unit = std::sqrt(1.0 + tangent * tangent);
  const Vector2<double> sight{a.sight.x - tangent * a.sight.y, a.sight.y + tangent * a.sight.x};
  pair = {middle_rad, std::sqrt(variance_rad2), std::sqrt(a.range_variance_m2 + b.range_variance_m2) / per_unit,
          chord(a, sight), chord(b, sight)};
  return true;
}

double Occlusion::hidden_share(std::uint32_t label, double enough) const {
  const int index = index_.find(label);
  if (index < 0) return 0.0;
  const auto own = static_cast<std::size_t>(index);
  const Outline& o = outlines_[own];
  double free = 1.0;
  Pair pair{};
  for (std::size_t i = 0; i < outlines_.size() && 1.0 - free < enough; ++i) {
    const Outline& other = outlines_[i];
    // Of each pair, the one that was added first is a.
    const bool is_a = own < i;
    if (i == own || !(is_a ? are_in_line(o, other, pair) : are_in_line(other, o, pair))) continue;
    const Chord &of_own = is_a ? pair.a : pair.b, &of_other = is_a ? pair.b : pair.a;
    const double behind = below((of_own.middle() - of_other.leave) / pair.range_std);
    if (behind <= 0.0) continue;
    const double from_own_rad = is_a ? pair.middle_rad : -pair.middle_rad;
    free *= 1.0 - other.existence * behind * covered_share(o.half_rad, from_own_rad, other.half_rad, pair.std_rad);
  }
  return 1.0 - free;
}

}  // namespace boresight::tracking
