#include "services/alignment_estimator/core/plate/azimuth.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "services/alignment_estimator/core/plate/locations.hpp"

namespace boresight::alignment::plate {

namespace {

using Pool = std::array<double, kMaxTilts * kMaxScansPerTilt>;

constexpr double kSmallestStd_rad = 1e-5;  // below the azimuth resolution of any radar
constexpr double kReach = 3.0;             // in stds by the MAD

struct AzimuthMean {
  double mean = 0.0, std = 0.0;  ///< std of the mean
  std::size_t used = 0;
};

AzimuthMean mean_within(std::span<const double> samples, double centre, double reach) {
  Welford kept;
  for (const double sample : samples) {
    if (std::abs(sample - centre) <= reach) kept.add(sample);
  }
  AzimuthMean result{.mean = kept.mean(), .std = 0.0, .used = kept.count()};
  if (kept.count() > 0) result.std = std::sqrt(kept.variance() / static_cast<double>(kept.count()));
  return result;
}

/// (9): two rounds, each dropping samples over 2σ from the mean.
AzimuthMean two_sigma_mean(std::span<const double> samples) {
  AzimuthMean mean = mean_within(samples, 0.0, HUGE_VAL);
  for (int round = 0; round < 2; ++round) {
    const double sigma = mean.std * std::sqrt(static_cast<double>(mean.used));
    const AzimuthMean kept = mean_within(samples, mean.mean, 2.0 * sigma);
    if (kept.used > 0) mean = kept;  // none only by rounding, if all are equal
  }
  return mean;
}

/// Two rounds, each keeping the samples within 3 MAD of the median.
AzimuthMean three_mad_mean(std::span<double> samples) {
  Pool scratch;
  AzimuthMean mean;
  double centre = 0.0, reach = HUGE_VAL;
  for (int round = 0; round < 2; ++round) {
    std::size_t kept = 0;
    for (const double sample : samples) {
      if (std::abs(sample - centre) <= reach) scratch[kept++] = sample;
    }
    centre = estimation::median({scratch.data(), kept});
    reach = kReach * estimation::mad_std({scratch.data(), kept}, centre);
    // Coarsely quantised angles may be equal in most scans; the MAD is then 0.
    if (!(reach > 0.0)) return two_sigma_mean(samples);
    mean = mean_within(samples, centre, reach);
  }
  return mean;
}

/// Tilts whose azimuth agrees with the majority: at the others the radar saw another object. A tilt whose amplitude
/// contradicts the others must agree more closely in azimuth.
std::array<bool, kMaxTilts> agreeing_azimuths(const Measurements& measurements, const PlateResult& result) {
  const std::size_t count = measurements.number_of_tilts;
  const Locations azimuths = locate(measurements, kSmallestStd_rad, [](const TiltMeasurement& tilt) {
    return std::tie(tilt.azimuth_rad, tilt.azimuth);
  });
  Column scratch = azimuths.value;
  const double centre = estimation::median({scratch.data(), count});
  std::array<bool, kMaxTilts> agree{};
  for (std::size_t i = 0; i < count; ++i) {
    const double gate = result.tilts[i].used ? 4.0 : 1.0;
    agree[i] = std::abs(azimuths.value[i] - centre) <= gate * azimuths.std[i];
  }
  return agree;
}

}  // namespace

bool find_azimuth(const Measurements& measurements, FitMethod method, PlateResult& result) {
  const bool robust = method == FitMethod::kRobust;
  const std::size_t tilts = measurements.number_of_tilts;
  std::array<bool, kMaxTilts> agree{};
  agree.fill(true);
  bool most_agree = true;
  if (robust) {
    const std::array<bool, kMaxTilts> agreeing = agreeing_azimuths(measurements, result);
    most_agree = 2 * static_cast<std::size_t>(std::count(agreeing.begin(), agreeing.end(), true)) > tilts;
    if (most_agree) agree = agreeing;
  }
  Pool pool;
  std::size_t count = 0, all = 0;
  for (std::size_t i = 0; i < tilts; ++i) {
    const TiltMeasurement& tilt = measurements.tilts[i];
    all += tilt.scans;
    if (!agree[i]) continue;
    for (std::size_t k = 0; k < tilt.scans; ++k) pool[count++] = tilt.azimuth_rad[k];
  }
  const std::span<double> samples{pool.data(), count};
  const AzimuthMean mean = robust ? three_mad_mean(samples) : two_sigma_mean(samples);
  result.yaw_rad = -mean.mean;  // (9)
  result.yaw_std_rad = mean.std;
  result.azimuth_inlier_ratio = static_cast<double>(mean.used) / static_cast<double>(all);
  return most_agree;
}

}  // namespace boresight::alignment::plate
