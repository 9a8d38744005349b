#include "services/tracker/core/model/clutter_map.hpp"

#include <algorithm>
#include <cmath>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking {

namespace {

std::size_t index_in(double share, std::size_t cells) {
  const double place = (share + 1.0) * 0.5 * static_cast<double>(cells);
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(cells) - 0.5));
}

}  // namespace

ClutterMap::ClutterMap(const ClutterParameters& parameters, double half_view_rad, double range_max_m)
    : parameters_(parameters), half_view_rad_(half_view_rad), range_max_m_(range_max_m) {}

double ClutterMap::range_edge_m(std::size_t edge) const {
  if (edge == 0) return 0.0;
  return edge == kRanges ? kInfinity : parameters_.table_range_edges_m[edge - 1];
}

double ClutterMap::rate_edge_mps(std::size_t edge) const {
  const auto& edges = parameters_.table_rate_edges_mps;
  if (edge == edges.size()) return 0.0;
  return edge > edges.size() ? edges[edge - edges.size() - 1] : -edges[edges.size() - 1 - edge];
}

std::size_t ClutterMap::cell(const ClutterPlace& p) const {
  std::size_t range = 0, rate = 0;
  while (range + 1 < kRanges && p.range_m >= range_edge_m(range + 1)) ++range;
  while (rate + 1 < kRates && p.range_rate_over_ground_mps >= rate_edge_mps(rate + 1)) ++rate;
  return (range * kSectors + index_in(p.azimuth_share, kSectors)) * kRates + rate;
}

double ClutterMap::volume(std::size_t c) const {
  const std::size_t rate = c % kRates, range = c / kRates / kSectors;
  const double high = std::min(range_edge_m(range + 1), range_max_m_), low = std::min(range_edge_m(range), high - 1.0);
  double width = rate_edge_mps(rate + 1) - rate_edge_mps(rate);
  if (rate == kRates / 2 || rate + 1 == kRates / 2) width -= parameters_.least_range_rate_mps;
  return half_view_rad_ * (high * high - low * low) * width / static_cast<double>(kSectors);
}

bool ClutterMap::keeps_pace(const ClutterPlace& p) const {
  return std::abs(p.range_rate_mps) < parameters_.pace_mps &&
         std::abs(p.range_rate_over_ground_mps) > parameters_.pace_over_ground_mps;
}

std::size_t ClutterMap::pace_cell(const ClutterPlace& p) const {
  const auto range = static_cast<std::size_t>(
      std::clamp(p.range_m / parameters_.pace_cell_m, 0.0, static_cast<double>(kPaceRanges) - 0.5));
  return range * kPaceSectors + index_in(p.azimuth_share, kPaceSectors);
}

double ClutterMap::pace_volume(std::size_t c) const {
  const double low = static_cast<double>(c / kPaceSectors) * parameters_.pace_cell_m,
               high = low + parameters_.pace_cell_m;
  return half_view_rad_ * (high * high - low * low) / static_cast<double>(kPaceSectors) * 2.0 * parameters_.pace_mps;
}

double ClutterMap::intensity(const ClutterPlace& p) const {
  const std::size_t c = cell(p), rate = c % kRates, range = c / kRates / kSectors;
  const double table = parameters_.table_by_range[range] *
                       parameters_.table_by_rate[rate >= kRates / 2 ? rate - kRates / 2 : kRates / 2 - 1 - rate];
  const double weight = parameters_.table_scans, v = volume(c);
  double density = (weight * table * v + sum_[c]) / (v * (weight + scans_));
  if (keeps_pace(p)) {
    const std::size_t pace = pace_cell(p);
    const double pv = pace_volume(pace);
    density = (weight * parameters_.with_ego_factor * density * pv + pace_sum_[pace]) / (pv * (weight + scans_));
  }
  return std::max(kLeastDensity, density);
}

void ClutterMap::begin_scan(double time_s) {
  const double keep = has_time_ ? std::exp(-std::max(0.0, time_s - time_s_) / parameters_.memory_s) : 0.0;
  has_time_ = true;
  time_s_ = time_s;
  for (double& s : sum_) s *= keep;
  for (double& s : pace_sum_) s *= keep;
  scans_ = scans_ * keep + 1.0;
}

void ClutterMap::add(const ClutterPlace& p, double unexplained) {
  if (keeps_pace(p)) {
    pace_sum_[pace_cell(p)] += unexplained;
  } else {
    sum_[cell(p)] += unexplained;
  }
}

}  // namespace boresight::tracking
