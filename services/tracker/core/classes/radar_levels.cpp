#include "services/tracker/core/classes/radar_levels.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::tracking {

void RadarLevels::Level::fade(double keep) {
  for (double& each : sum_db) each *= keep;
  for (double& each : number) each *= keep;
}

void RadarLevels::Level::add(std::size_t band, double value_db) {
  if (!std::isfinite(value_db)) return;
  sum_db[band] += value_db;
  number[band] += 1.0;
}

/// The mean of a band, drawn to that of all bands as long as it has few detections.
double RadarLevels::Level::at(std::size_t band, double prior_number) const {
  const double all = std::accumulate(number.begin(), number.end(), 0.0);
  if (all <= 0.0) return NAN;
  const double mean_db = std::accumulate(sum_db.begin(), sum_db.end(), 0.0) / all;
  return (sum_db[band] + prior_number * mean_db) / (number[band] + prior_number);
}

RadarLevels::RadarLevels(std::size_t radars, const RadarLevelParameters& parameters)
    : parameters_(parameters), radars_(radars) {}

std::size_t RadarLevels::band_of(double range_m) const {
  std::size_t band = 0;
  for (double edge_m = parameters_.first_band_m; band + 1 < Bands{}.size() && range_m >= edge_m; edge_m *= 2.0) ++band;
  return band;
}

void RadarLevels::clear() {
  std::fill(radars_.begin(), radars_.end(), Radar{});
}

void RadarLevels::learn(const ClassifiedScan& scan, std::size_t radar) {
  if (radar >= radars_.size() || (scan.flags & pipeline_flag::kDistrusted) != 0) return;
  Radar& of = radars_[radar];
  const double time_s = 1e-9 * static_cast<double>(scan.header.measurement_time_ns);
  const double keep = of.has_time ? std::exp(-std::abs(time_s - of.time_s) / parameters_.memory_s) : 1.0;
  of.time_s = time_s;
  of.has_time = true;
  of.strength.fade(keep);
  of.snr.fade(keep);
  const bool has_strength = (scan.fields & scan_field::kRcs) != 0, has_snr = (scan.fields & scan_field::kSnr) != 0;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    constexpr auto kLookedAt = corrected_flag::kRejected | corrected_flag::kStationary;
    if ((scan.detection_flags[i] & kLookedAt) != corrected_flag::kStationary) continue;
    const std::size_t band = band_of(static_cast<double>(scan.range_m[i]));
    if (has_strength) of.strength.add(band, static_cast<double>(scan.rcs_dbsm[i]));
    if (has_snr) of.snr.add(band, static_cast<double>(scan.snr_db[i]));
  }
}

double RadarLevels::strength_db(std::size_t radar, double range_m, double rcs_dbsm) const {
  if (radar >= radars_.size()) return NAN;
  return rcs_dbsm - radars_[radar].strength.at(band_of(range_m), parameters_.prior_number);
}

double RadarLevels::snr_db(std::size_t radar, double range_m, double snr_db) const {
  if (radar >= radars_.size()) return NAN;
  return snr_db - radars_[radar].snr.at(band_of(range_m), parameters_.prior_number);
}

}  // namespace boresight::tracking
