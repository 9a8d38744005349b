#include "services/tracker/core/surroundings/edge_search.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {
constexpr double kBandsThatMayWin = 3.0;  // by chance each of the three has the most
}  // namespace

ContrastVote::ContrastVote(const RoadEdgeParameters& parameters)
    : least_(parameters.least_cell_detections),
      win_(std::log(parameters.contrast_probability * kBandsThatMayWin)),
      loss_(std::log((1.0 - parameters.contrast_probability) / (1.0 - 1.0 / kBandsThatMayWin))) {}

EdgeSearch::EdgeSearch(const RoadEdgeParameters& parameters, double behind_m)
    : parameters_(parameters),
      vote_(parameters),
      bin_m_(2.0 * parameters.band_half_width_m / kBand),
      behind_m_(behind_m) {}

double EdgeSearch::middle_m(std::size_t segment) const {
  return (static_cast<double>(segment) + 0.5) * parameters_.cell_m - behind_m_;
}

void EdgeSearch::fill(std::span<const Eigen::Vector2d> places, double curvature_per_m, double side) {
  for (auto& segment : sums_) segment.fill(0.0F);
  for (const Eigen::Vector2d& p : places) {
    const double at = (p.x() + behind_m_) / parameters_.cell_m;
    const double aside = side * (p.y() - 0.5 * curvature_per_m * p.x() * p.x()) / bin_m_;
    if (!(at >= 0.0 && at < static_cast<double>(kSegments) && aside >= 0.0 && aside < static_cast<double>(kBins)))
      continue;
    if (p.x() > parameters_.ahead_m) continue;
    sums_[static_cast<std::size_t>(at)][static_cast<std::size_t>(aside) + 1] += 1.0F;
  }
  for (std::size_t k = 0; k < kSegments; ++k) {
    for (std::size_t b = 1; b <= kBins; ++b) sums_[k][b] += sums_[k][b - 1];
    for (int b = kBand; b < static_cast<int>(kBins); ++b) {
      votes_[k][static_cast<std::size_t>(b)] =
          static_cast<float>(vote_.of(count(k, b), count(k, b - kBand), count(k, b + kBand)));
    }
  }
}

double EdgeSearch::votes(int bin, double slope) const {
  // Slopes are those of the side's own axis, outwards.
  const double step = slope * parameters_.cell_m / bin_m_;
  double shift = slope * middle_m(0) / bin_m_ + bin + 0.5;
  double sum = 0.0;
  for (std::size_t k = 0; k < kSegments; ++k, shift += step) {
    if (shift >= kBand && shift < static_cast<double>(kBins)) {
      sum += static_cast<double>(votes_[k][static_cast<std::size_t>(shift)]);
    }
  }
  return sum;
}

FoundEdge EdgeSearch::line(int bin, double slope, double curvature_per_m) const {
  FoundEdge edge;
  edge.is_found = true;
  edge.votes = votes(bin, slope);
  double on = 0.0, inner = 0.0, outer = 0.0;
  for (std::size_t k = 0; k < kSegments; ++k) {
    const int first = bin + static_cast<int>(std::lround(slope * middle_m(k) / bin_m_));
    if (first - kBand < 0) continue;  // too near to the path to compare it
    on += count(k, first);
    inner += count(k, first - kBand);
    outer += count(k, first + kBand);
  }
  const double band_m = kBand * bin_m_;
  edge.c = {(bin + 0.5 * kBand) * bin_m_, slope, curvature_per_m};
  edge.on = std::max(1.0, on - 0.5 * (inner + outer));
  edge.inner_per_m = inner / band_m;
  edge.outer_per_m = outer / band_m;
  return edge;
}

}  // namespace boresight::tracking
