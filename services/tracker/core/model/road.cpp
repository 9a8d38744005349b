#include "services/tracker/core/model/road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "services/common/geometry/frames.hpp"

namespace boresight::tracking {

namespace {

/// Headings of one kind: their weight with the course that was seen, and what they make of it.
struct Way {
  double weight, rad, variance_rad2;
};

/// Normal density on a circle.
double density(double e_rad, double variance_rad2) {
  const double turn = 2.0 * std::numbers::pi;
  if (variance_rad2 > std::numbers::pi * std::numbers::pi) return 1.0 / turn;  // within 2 %
  double sum = 0.0;
  for (const double e : {e_rad - turn, e_rad, e_rad + turn}) sum += std::exp(-0.5 * e * e / variance_rad2);
  return sum / std::sqrt(turn * variance_rad2);
}

/// Along the road, against it, and any other, of a vehicle.
std::array<Way, 3> ways_of(double parallel_std_rad, const Road& road, double vehicle_probability,
                           const Course& course) {
  const double std2 = parallel_std_rad * parallel_std_rad, sum = std2 + course.variance_rad2;
  const auto parallel = [&](double share, double rad) {
    const double e = geometry::wrap_angle(course.rad - rad);
    return Way{vehicle_probability * share * density(e, sum), rad + std2 / sum * e, std2 * course.variance_rad2 / sum};
  };
  const double other = 1.0 - vehicle_probability * (road.along_share + road.against_share);
  return {parallel(road.along_share, road.heading_rad),
          parallel(road.against_share, road.heading_rad + std::numbers::pi),
          Way{other / (2.0 * std::numbers::pi), course.rad, course.variance_rad2}};
}

}  // namespace

Course on_road(const RoadParameters& parameters, const Road& road, const Course& course, double vehicle_probability) {
  const auto ways = ways_of(parameters.parallel_std_rad, road, vehicle_probability, course);
  const Way& best =
      *std::max_element(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.weight < b.weight; });
  double weights = 0.0, mean = 0.0, squares = 0.0;
  for (const Way& w : ways) {
    const double off = geometry::wrap_angle(w.rad - best.rad);
    weights += w.weight;
    mean += w.weight * off;
    squares += w.weight * (w.variance_rad2 + off * off);
  }
  mean /= weights;
  return {geometry::wrap_angle(best.rad + mean), squares / weights - mean * mean};
}

void ParallelTraffic::forget(double elapsed_s) {
  const double keep = std::exp(-std::max(0.0, elapsed_s) / parameters_.memory_s);
  for (double* const sum : {&along_s_, &against_s_, &seen_s_}) *sum *= keep;
}

void ParallelTraffic::add(const Course& course, double road_heading_rad, double time_s) {
  if (course.variance_rad2 > parameters_.parallel_std_rad * parameters_.parallel_std_rad) return;
  const auto [along, against, other] = ways_of(parameters_.parallel_std_rad, road(road_heading_rad), 1.0, course);
  const double weights = along.weight + against.weight + other.weight;
  along_s_ += time_s * along.weight / weights;
  against_s_ += time_s * against.weight / weights;
  seen_s_ += time_s;
}

Road ParallelTraffic::road(double heading_rad) const {
  const double start_s = parameters_.parallel_share * parameters_.prior_s, all_s = parameters_.prior_s + seen_s_;
  return {heading_rad, (start_s + along_s_) / all_s, (start_s + against_s_) / all_s};
}

}  // namespace boresight::tracking
