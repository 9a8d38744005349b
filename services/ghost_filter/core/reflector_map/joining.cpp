#include "services/ghost_filter/core/reflector_map/joining.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ghosts {

namespace {

constexpr double kJoiningGate = 2.0;         // standard deviations
constexpr double kMostJoiningSlack_m = 0.4;  // by which uncertain curves may be farther apart than the tolerance
constexpr double kTurn_rad = 0.1;

}  // namespace

bool runs_along(const Reflector& longer, const Reflector& shorter, const MapConfig& config) {
  const double begin = longer.begin_m() - config.max_gap_m, end = longer.end_m() + config.max_gap_m;
  const double half = 0.5 * shorter.length_m();
  // However they bend, neither reaches farther from its origin than along itself. That tells those apart that are far
  // from each other, nearly all in a large map; the rest is for the others.
  const double farthest_m = std::max(-longer.begin_m(), longer.end_m()) +
                            std::max(-shorter.begin_m(), shorter.end_m()) + 2.0 * half + config.max_gap_m +
                            config.tolerance_m + kMostJoiningSlack_m;
  if ((longer.curve.origin_m - shorter.curve.origin_m).squaredNorm() > farthest_m * farthest_m) return false;
  const auto apart = [&](double arc) {
    const Eigen::Vector2d p = shorter.curve.at(arc);
    const double there = longer.curve.arc(p);
    const double within = std::clamp(there, longer.begin_m(), longer.end_m());
    const double slack = kJoiningGate * std::sqrt(longer.variance_at(within) + shorter.variance_at(arc));
    return std::abs(longer.curve.distance(p)) - std::min(kMostJoiningSlack_m, slack);
  };
  // The middle first: it tells nearly all pairs apart.
  const double middle = 0.5 * (shorter.begin_m() + shorter.end_m());
  const Eigen::Vector2d there = shorter.curve.at(middle);
  const double arc = longer.curve.arc(there);
  if (arc + half < begin || arc - half > end) return false;
  const double apart_there = config.tolerance_m + 0.05 * half;
  if (std::abs(longer.curve.distance(there)) > apart_there + kMostJoiningSlack_m || apart(middle) > apart_there)
    return false;
  const double first = longer.curve.arc(shorter.curve.at(shorter.begin_m()));
  const double last = longer.curve.arc(shorter.curve.at(shorter.end_m()));
  if (std::max(first, last) < begin || std::min(first, last) > end) return false;
  const Eigen::Vector2d a = longer.curve.tangent_at(arc), b = shorter.curve.tangent_at(middle);
  if (std::abs(a.x() * b.y() - a.y() * b.x()) > kTurn_rad) return false;
  // Where they are beside each other, or nearest to it, they must agree; what lies beyond is not known to the longer.
  const double low = std::max(std::min(first, last), longer.begin_m() - config.max_gap_m);
  const double high = std::min(std::max(first, last), longer.end_m() + config.max_gap_m);
  const double sign = first < last ? 1.0 : -1.0;
  for (const double at : {low, high}) {
    const double of_shorter = std::clamp(middle + sign * (at - arc), shorter.begin_m(), shorter.end_m());
    if (apart(of_shorter) > config.tolerance_m) return false;
  }
  return true;
}

bool join(Reflector& longer, const Reflector& shorter) {
  Occupancy occupancy = longer.occupancy;
  for (double arc = shorter.begin_m(); arc <= shorter.end_m(); arc += 0.5 * occupancy.bin_m()) {
    const double there = longer.curve.arc(shorter.curve.at(arc)) + longer.arc_shift_m;
    if (!occupancy.extend(there)) return false;
    occupancy.join(there, shorter.occupancy, arc + shorter.arc_shift_m);
  }
  longer.occupancy = occupancy;
  longer.log_odds = std::max(longer.log_odds, shorter.log_odds);
  longer.born_ns = std::min(longer.born_ns, shorter.born_ns);
  longer.detections += shorter.detections;
  // Its begin, middle and end stand for all that it knows of its three parameters.
  CurveFit fit(longer.curve, longer.covariance.inverse());
  for (const double share : {0.0, 0.5, 1.0}) {
    const double arc = shorter.begin_m() + share * shorter.length_m();
    fit.add(shorter.curve.at(arc), 3.0 * shorter.variance_at(arc) + 0.1 * 0.1);
  }
  longer.curve = fit.solve();
  longer.covariance = fit.covariance();
  longer.evidence = {};
  return true;
}

}  // namespace boresight::ghosts
