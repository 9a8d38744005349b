#include "services/tracker/core/surroundings/edge_search.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {
constexpr double kBandsThatMayWin = 3.0;  // by chance each of the three has the most
constexpr double kBehind_m = 10.0;        // where the search begins
}  // namespace

ContrastVote::ContrastVote(const RoadEdgeParameters& parameters)
    : least_(parameters.least_cell_detections),
      win_(std::log(parameters.contrast_probability * kBandsThatMayWin)),
      loss_(std::log((1.0 - parameters.contrast_probability) / (1.0 - 1.0 / kBandsThatMayWin))) {}

EdgeSearch::EdgeSearch(const RoadEdgeParameters& parameters)
    : parameters_(parameters), vote_(parameters), bin_m_(2.0 * parameters.band_half_width_m / kBand) {}

double EdgeSearch::middle_m(std::size_t piece) const {
  return (static_cast<double>(piece) + 0.5) * parameters_.cell_m - kBehind_m;
}

void EdgeSearch::fill(std::span<const Eigen::Vector2d> places, double curvature_per_m, double side) {
  for (auto& piece : sums_) piece.fill(0.0F);
  for (const Eigen::Vector2d& p : places) {
    const double at = (p.x() + kBehind_m) / parameters_.cell_m;
    const double aside = side * (p.y() - 0.5 * curvature_per_m * p.x() * p.x()) / bin_m_;
    if (!(at >= 0.0 && at < static_cast<double>(kPieces) && aside >= 0.0 && aside < static_cast<double>(kBins)))
      continue;
    if (p.x() > parameters_.ahead_m) continue;
    sums_[static_cast<std::size_t>(at)][static_cast<std::size_t>(aside) + 1] += 1.0F;
  }
  for (auto& piece : sums_) {
    for (std::size_t b = 1; b <= kBins; ++b) piece[b] += piece[b - 1];
  }
}

FoundEdge EdgeSearch::evaluate(int bin, double slope, double curvature_per_m, double side) const {
  FoundEdge edge;
  double on = 0.0, inner = 0.0, outer = 0.0;
  for (std::size_t k = 0; k < kPieces; ++k) {
    const int first = bin + static_cast<int>(std::lround(side * slope * middle_m(k) / bin_m_));
    if (first - kBand < 0) continue;  // too near to the path to compare it
    const double a = count(k, first), b = count(k, first - kBand), c = count(k, first + kBand);
    edge.votes += vote_.of(a, b, c);
    on += a;
    inner += b;
    outer += c;
  }
  const double band_m = kBand * bin_m_;
  edge.c = {side * (bin + 0.5 * kBand) * bin_m_, slope, curvature_per_m};
  edge.on = std::max(1.0, on - 0.5 * (inner + outer));
  edge.inner_per_m = inner / band_m;
  edge.outer_per_m = outer / band_m;
  return edge;
}

}  // namespace boresight::tracking
