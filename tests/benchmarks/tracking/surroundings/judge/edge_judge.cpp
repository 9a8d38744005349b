#include "tests/benchmarks/tracking/surroundings/judge/edge_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace boresight::bench::surroundings {

namespace {

constexpr double kPlaceStep_m = 5.0;

struct Place {
  double y_m, variance_m2;
};

/// An edge at x, where it was detected.
std::optional<Place> place_of(const RoadEdge& e, double x_m) {
  if (x_m < static_cast<double>(e.start_x_m) || x_m > static_cast<double>(e.end_x_m)) return std::nullopt;
  const double basis[] = {1.0, x_m, 0.5 * x_m * x_m};
  Place place{0.0, 0.0};
  for (std::size_t i = 0; i < kRoadEdgeStateSize; ++i) {
    place.y_m += basis[i] * static_cast<double>(e.coefficients[i]);
    for (std::size_t k = 0; k < kRoadEdgeStateSize; ++k) {
      place.variance_m2 += basis[i] * basis[k] * static_cast<double>(e.covariance[i * kRoadEdgeStateSize + k]);
    }
  }
  return place;
}

}  // namespace

double EdgeFigures::rms_m() const {
  return std::sqrt(squares_m2 / static_cast<double>(samples));
}
double EdgeFigures::nees() const {
  return normalised / static_cast<double>(samples);
}

void add(const TrackList& list, const std::vector<TrueEdge>& truth, EdgeFigures& figures) {
  for (double x = 0.0; x <= kFarthest_m; x += kPlaceStep_m) {
    for (const bool is_left : {true, false}) {
      // The structures of that side at x, and the innermost one.
      double innermost_m = std::numeric_limits<double>::infinity();
      double nearest_loose_m = innermost_m;
      std::vector<double> ys, loose_ys;
      for (const TrueEdge& edge : truth) {
        const std::optional<double> y = edge.is_left == is_left ? edge.at(x) : std::nullopt;
        if (!y) continue;
        if (edge.is_loose) {
          loose_ys.push_back(*y);
          if (edge.hides) nearest_loose_m = std::min(nearest_loose_m, std::abs(*y));
          continue;
        }
        ys.push_back(*y);
        if (std::abs(*y) < std::abs(innermost_m)) innermost_m = *y;
      }
      // A row in front of a structure hides it.
      const bool is_wanted = std::abs(innermost_m) <= std::min(kWidest_m, nearest_loose_m);
      bool is_found = false;
      for (std::size_t k = 0; k < list.number_of_road_edges; ++k) {
        const RoadEdge& e = list.road_edges[k];
        if ((e.side == RoadSide::kLeft) != is_left) continue;
        const std::optional<Place> place = place_of(e, x);
        if (!place) continue;
        double error_m = std::numeric_limits<double>::infinity();
        double nearest_m = 0.0;
        for (const double y : ys) {
          if (std::abs(place->y_m - y) >= std::abs(error_m)) continue;
          error_m = place->y_m - y;
          nearest_m = y;
        }
        if (std::abs(error_m) > kNear_m && std::any_of(loose_ys.begin(), loose_ys.end(),
                                                       [&](double y) { return std::abs(place->y_m - y) <= kNear_m; })) {
          continue;
        }
        if (std::abs(error_m) > kNear_m) {
          ++figures.elsewhere;
          continue;
        }
        ++figures.samples;
        figures.squares_m2 += error_m * error_m;
        figures.normalised += error_m * error_m / place->variance_m2;
        figures.signed_m += is_left ? error_m : -error_m;
        if (nearest_m != innermost_m) continue;
        ++figures.inner;
        is_found = true;
      }
      if (!is_wanted) continue;
      ++figures.wanted;
      figures.found += is_found ? 1 : 0;
    }
  }
}

}  // namespace boresight::bench::surroundings
