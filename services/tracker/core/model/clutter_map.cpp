#include "services/tracker/core/model/clutter_map.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {

// Starting table, measured: radar-statistics.md §6, per m² and m/s over ranges of 0–10, 10–25, 25–50, 50–75 m and
// beyond, relative by |range rate| of 0–1, 1–2, 2–5, 5–10, 10–20 and 20–60 m/s.
constexpr std::array<double, 6> kRangeEdges_m{0.0, 10.0, 25.0, 50.0, 75.0, 1e9};
constexpr std::array<double, 5> kByRange{1.6e-4, 9e-5, 3.5e-5, 1.2e-5, 6e-6};
constexpr std::array<double, 13> kRateEdges_mps{-60, -20, -10, -5, -2, -1, 0, 1, 2, 5, 10, 20, 60};
constexpr std::array<double, 6> kByRate{4.9, 4.9, 2.3, 1.1, 1.1, 0.3};
constexpr double kLeastIntensity = 1e-9;
constexpr double kPaceRange_m = 10.0;  // of a cell
constexpr double kPace_mps = 1.0;      // |measured range rate| of what keeps pace
constexpr double kEgoMoves_mps = 2.0;  // over ground: below it the own vehicle hardly moves

std::size_t index_in(double share, std::size_t cells) {
  const double place = (share + 1.0) * 0.5 * static_cast<double>(cells);
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(cells) - 0.5));
}

}  // namespace

ClutterMap::ClutterMap(const ClutterParameters& parameters, double half_view_rad, double range_max_m,
                       double min_range_rate_mps)
    : parameters_(parameters),
      half_view_rad_(half_view_rad),
      range_max_m_(range_max_m),
      min_range_rate_mps_(min_range_rate_mps) {}

std::size_t ClutterMap::cell(const ClutterPlace& p) const {
  std::size_t range = 0, rate = 0;
  while (range + 1 < kRanges && p.range_m >= kRangeEdges_m[range + 1]) ++range;
  while (rate + 1 < kRates && p.range_rate_over_ground_mps >= kRateEdges_mps[rate + 1]) ++rate;
  return (range * kSectors + index_in(p.azimuth_share, kSectors)) * kRates + rate;
}

double ClutterMap::volume(std::size_t c) const {
  const std::size_t rate = c % kRates, range = c / kRates / kSectors;
  const double high = std::min(kRangeEdges_m[range + 1], range_max_m_),
               low = std::min(kRangeEdges_m[range], high - 1.0);
  double width = kRateEdges_mps[rate + 1] - kRateEdges_mps[rate];
  constexpr double kLeast = 0.1;
  if (rate == kRates / 2 || rate + 1 == kRates / 2) width = std::max(kLeast, width - min_range_rate_mps_);
  return half_view_rad_ * (high * high - low * low) * width / static_cast<double>(kSectors);
}

bool ClutterMap::keeps_pace(const ClutterPlace& p) const {
  return std::abs(p.range_rate_mps) < kPace_mps && std::abs(p.range_rate_over_ground_mps) > kEgoMoves_mps;
}

std::size_t ClutterMap::pace_cell(const ClutterPlace& p) const {
  const auto range =
      static_cast<std::size_t>(std::clamp(p.range_m / kPaceRange_m, 0.0, static_cast<double>(kPaceRanges) - 0.5));
  return range * kPaceSectors + index_in(p.azimuth_share, kPaceSectors);
}

double ClutterMap::pace_volume(std::size_t c) const {
  const double low = static_cast<double>(c / kPaceSectors) * kPaceRange_m, high = low + kPaceRange_m;
  return half_view_rad_ * (high * high - low * low) / static_cast<double>(kPaceSectors) * 2.0 * kPace_mps;
}

double ClutterMap::intensity(const ClutterPlace& p) const {
  const std::size_t c = cell(p), rate = c % kRates, range = c / kRates / kSectors;
  const double table = kByRange[range] * kByRate[rate >= kRates / 2 ? rate - kRates / 2 : kRates / 2 - 1 - rate];
  const double weight = parameters_.table_scans, v = volume(c);
  double density = (weight * table * v + sum_[c]) / (v * (weight + scans_));
  if (keeps_pace(p)) {
    const std::size_t pace = pace_cell(p);
    const double pv = pace_volume(pace);
    density = (weight * parameters_.with_ego_factor * density * pv + pace_sum_[pace]) / (pv * (weight + scans_));
  }
  return std::max(kLeastIntensity, density);
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
