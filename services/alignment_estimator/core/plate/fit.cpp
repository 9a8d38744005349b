#include "services/alignment_estimator/core/plate/fit.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "services/alignment_estimator/core/plate/parabola.hpp"

namespace boresight::alignment::plate {

namespace {

using Column = std::array<double, kMaxTilts>;
using Pool = std::array<double, kMaxTilts * kMaxScansPerTilt>;

constexpr double kSigmaOfMad = 1.4826;     // of a normal distribution
constexpr double kSmallestStd_db = 0.01;   // below any radar's resolution of amplitude
constexpr double kSmallestStd_rad = 1e-5;  // the same of azimuth
constexpr double kGate = 3.0;              // stds, for tilts and for azimuths

/// Sorts the values in part.
double median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// 1.4826 · median |value − centre|; overwrites the values.
double mad_std(std::span<double> values, double centre) {
  for (double& value : values) value = std::abs(value - centre);
  return kSigmaOfMad * median(values);
}

/// Repeatable choice of triples (splitmix64): results do not depend on the library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t limit) {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<std::size_t>((z ^ (z >> 31)) % limit);
  }

 private:
  std::uint64_t state_;
};

/// The tilts as points to fit.
struct Points {
  std::size_t count = 0;
  Column tilt{}, amplitude{}, std{};

  [[nodiscard]] std::span<const double> tilts() const { return {tilt.data(), count}; }
  [[nodiscard]] std::span<const double> amplitudes() const { return {amplitude.data(), count}; }
};

bool fit_triple(const Points& points, std::size_t i, std::size_t j, std::size_t k, Parabola& out) {
  const std::array<double, 3> t{points.tilt[i], points.tilt[j], points.tilt[k]};
  const std::array<double, 3> a{points.amplitude[i], points.amplitude[j], points.amplitude[k]};
  constexpr std::array<double, 3> kEqual{1.0, 1.0, 1.0};
  return fit_parabola(t, a, kEqual, out);
}

bool fit_used(const Points& points, const std::array<bool, kMaxTilts>& used, Parabola& out) {
  Column weights{};
  for (std::size_t i = 0; i < points.count; ++i) {
    if (used[i]) weights[i] = 1.0 / (points.std[i] * points.std[i]);
  }
  return fit_parabola(points.tilts(), points.amplitudes(), {weights.data(), points.count}, out);
}

/// Marks the tilts that lie on the parabola; returns Σ min(r², gate²) over all, r in stds.
double consensus(const Points& points, const Parabola& parabola, std::array<bool, kMaxTilts>& used) {
  double cost = 0.0;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double r = (points.amplitude[i] - parabola.at(points.tilt[i])) / points.std[i];
    used[i] = std::abs(r) <= kGate;
    cost += used[i] ? r * r : kGate * kGate;
  }
  return cost;
}

/// A parabola, the tilts that lie on it, and Σ min(r², gate²) over all tilts.
struct Solution {
  Parabola parabola;
  std::array<bool, kMaxTilts> used{};
  double cost = HUGE_VAL;
};

/// The parabola of three tilts, refined by least squares over those that agree with it, so that the noise of the three
/// does not decide. A maximum stays a maximum, none stays none. False if the three do not make a parabola.
bool refined_triple(const Points& points, std::size_t i, std::size_t j, std::size_t k, Solution& out) {
  if (!fit_triple(points, i, j, k, out.parabola)) return false;
  out.cost = consensus(points, out.parabola, out.used);
  for (int round = 0; round < 5; ++round) {
    Solution refined;
    if (!fit_used(points, out.used, refined.parabola)) break;
    if (refined.parabola.has_maximum() != out.parabola.has_maximum()) break;
    refined.cost = consensus(points, refined.parabola, refined.used);
    if (refined.cost >= out.cost) break;
    out = refined;
  }
  return true;
}

/// RANSAC over every triple (at most 165: no need to draw). The best solution has a maximum unless one without explains
/// more than one tilt better: plates do have maxima. `rivals_variance`: of the place of the maximum (rad²) over all
/// solutions, weighted by how likely each is: two bad tilts that agree may be told from good ones only just, and a
/// rival nearly as likely widens the std by its distance.
Solution fit_robust(const Points& points, double& rivals_variance) {
  constexpr std::size_t kMostTriples = kMaxTilts * (kMaxTilts - 1) * (kMaxTilts - 2) / 6;
  std::array<double, kMostTriples> costs{}, maxima{};
  std::size_t count = 0;
  Solution best, best_without;
  for (std::size_t i = 0; i + 2 < points.count; ++i) {
    for (std::size_t j = i + 1; j + 1 < points.count; ++j) {
      for (std::size_t k = j + 1; k < points.count; ++k) {
        Solution solution;
        if (!refined_triple(points, i, j, k, solution)) continue;
        Solution& same_kind = solution.parabola.has_maximum() ? best : best_without;
        if (solution.cost < same_kind.cost) same_kind = solution;
        if (!solution.parabola.has_maximum()) continue;
        costs[count] = solution.cost;
        maxima[count++] = solution.parabola.argmax();
      }
    }
  }
  double weights = 0.0, squares = 0.0;
  for (std::size_t n = 0; n < count; ++n) {
    const double weight = std::exp(0.5 * (best.cost - costs[n]));
    weights += weight;
    squares += weight * (maxima[n] - best.parabola.argmax()) * (maxima[n] - best.parabola.argmax());
  }
  rivals_variance = count > 0 ? squares / weights : 0.0;
  Solution result = best_without.cost + kGate * kGate < best.cost ? best_without : best;
  // Always least squares over what is used in the end, for its covariance.
  Parabola refitted;
  if (std::isfinite(result.cost) && fit_used(points, result.used, refitted)) result.parabola = refitted;
  return result;
}

/// Maxima of M random triples, Report A §7: how far the tilts agree with one another.
void judge_by_triples(const Points& points, const FitConfig& config, PlateResult& result) {
  std::array<double, kMaxTriples> maxima{};
  std::size_t count = 0;
  const std::size_t wanted = std::clamp<std::size_t>(config.triples, 1, kMaxTriples);
  Random random(config.seed);
  for (std::size_t n = 0; n < wanted; ++n) {
    const std::size_t i = random.below(points.count);
    std::size_t j = random.below(points.count - 1);
    std::size_t k = random.below(points.count - 2);
    if (j >= i) ++j;
    for (const std::size_t taken : {std::min(i, j), std::max(i, j)}) {
      if (k >= taken) ++k;
    }
    Parabola parabola;
    if (fit_triple(points, i, j, k, parabola) && parabola.has_maximum()) maxima[count++] = -parabola.argmax();
  }
  if (count == 0) return;
  std::size_t agreeing = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (std::abs(maxima[n] - result.pitch_rad) <= config.consistency_rad) ++agreeing;
  }
  // Triples without a maximum contradict every result.
  result.self_consistency = static_cast<double>(agreeing) / static_cast<double>(wanted);
  const std::span<double> found{maxima.data(), count};
  result.triples_median_rad = median(found);
  // By the MAD: three tilts close together have their maximum anywhere, and a plain spread would tell only of those.
  result.triples_std_rad = mad_std(found, result.triples_median_rad);
}

/// What a tilt's scans say together.
struct Location {
  double value = 0.0;
  double scan_variance = 0.0;  ///< of one scan: `scans` times that of the value
};

/// Tukey's biweight about the median, c = 4.685 σ by the MAD: as little moved by bad scans as the median itself, and
/// nearly as sharp as the mean on good ones, which decides whether two bad tilts can be told from good ones.
/// `all` are the same samples; their std stands in where most samples are equal, and the MAD tells nothing.
Location biweight(const std::array<double, kMaxScansPerTilt>& samples, const Welford& all, double smallest_std) {
  const std::size_t count = all.count();
  std::array<double, kMaxScansPerTilt> scratch = samples;
  double centre = median({scratch.data(), count});
  const double mad = mad_std({scratch.data(), count}, centre);
  const double scale = mad > smallest_std ? mad : std::max(std::sqrt(all.variance()), smallest_std);
  constexpr double kTukey = 4.685;
  Location result;
  for (int round = 0; round < 3; ++round) {
    double weights = 0.0, shift = 0.0, squares = 0.0, slope = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const double u = (samples[k] - centre) / (kTukey * scale);
      if (std::abs(u) >= 1.0) continue;
      const double w = (1.0 - u * u) * (1.0 - u * u);
      weights += w;
      shift += w * (samples[k] - centre);
      squares += w * w * (samples[k] - centre) * (samples[k] - centre);
      slope += (1.0 - u * u) * (1.0 - 5.0 * u * u);
    }
    centre += shift / weights;  // more than half of the samples are within one MAD of the median: never 0
    result = {centre, static_cast<double>(count) * squares / (slope * slope)};
  }
  return result;
}

/// Locations of all tilts with the std that the scatter of the scans gives each. The noise of the radar is the same at
/// every tilt: the usual scatter keeps a tilt that scatters little by chance from ruling the fit. One that scatters far
/// more is believed to.
struct Locations {
  Column value{}, std{};
};
template <typename Get>
Locations locate(const Measurements& measurements, double smallest_std, Get get) {
  Locations result;
  Column scatter{}, scratch{};
  for (std::size_t i = 0; i < measurements.number_of_tilts; ++i) {
    const auto& [samples, all] = get(measurements.tilts[i]);
    const Location location = biweight(samples, all, smallest_std);
    result.value[i] = location.value;
    scatter[i] = scratch[i] = location.scan_variance;
  }
  const double usual = std::max(median({scratch.data(), measurements.number_of_tilts}), smallest_std * smallest_std);
  for (std::size_t i = 0; i < measurements.number_of_tilts; ++i) {
    const double of_scan = scatter[i] > 3.0 * usual ? scatter[i] : usual;
    result.std[i] = std::sqrt(of_scan / static_cast<double>(measurements.tilts[i].scans));
  }
  return result;
}

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
    mean = mean_within(samples, mean.mean, 2.0 * sigma);
  }
  return mean;
}

/// Two rounds, each keeping what lies within 3 MAD of the median.
AzimuthMean three_mad_mean(std::span<double> samples) {
  Pool scratch;
  AzimuthMean mean;
  double centre = 0.0, reach = HUGE_VAL;
  for (int round = 0; round < 2; ++round) {
    std::size_t kept = 0;
    for (const double sample : samples) {
      if (std::abs(sample - centre) <= reach) scratch[kept++] = sample;
    }
    centre = median({scratch.data(), kept});
    reach = kGate * mad_std({scratch.data(), kept}, centre);
    // Coarsely quantised angles may be equal for most scans; then the MAD tells nothing.
    if (!(reach > 0.0)) return two_sigma_mean(samples);
    mean = mean_within(samples, centre, reach);
  }
  return mean;
}

/// Tilts whose azimuth agrees with that of most: elsewhere something beside the plate was seen. A tilt whose amplitude
/// contradicts the others is under suspicion, and its azimuth must agree more closely.
std::array<bool, kMaxTilts> agreeing_azimuths(const Measurements& measurements, const PlateResult& result) {
  const std::size_t count = measurements.number_of_tilts;
  const Locations azimuths = locate(measurements, kSmallestStd_rad, [](const TiltMeasurement& tilt) {
    return std::tie(tilt.azimuth_rad, tilt.azimuth);
  });
  Column scratch = azimuths.value;
  const double centre = median({scratch.data(), count});
  std::array<bool, kMaxTilts> agree{};
  for (std::size_t i = 0; i < count; ++i) {
    const double gate = result.tilts[i].used ? 4.0 : 1.0;
    agree[i] = std::abs(azimuths.value[i] - centre) <= gate * azimuths.std[i];
  }
  return agree;
}

void find_azimuth(const Measurements& measurements, bool robust, PlateResult& result) {
  std::array<bool, kMaxTilts> agree{};
  agree.fill(true);
  if (robust) agree = agreeing_azimuths(measurements, result);
  Pool pool;
  std::size_t count = 0, all = 0;
  for (std::size_t i = 0; i < measurements.number_of_tilts; ++i) {
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
}

bool is_finite(const TiltMeasurement& tilt) {
  bool finite = std::isfinite(tilt.tilt_rad);
  for (std::size_t k = 0; k < tilt.scans; ++k) {
    finite = finite && std::isfinite(tilt.amplitude_db[k]) && std::isfinite(tilt.azimuth_rad[k]);
  }
  return finite;
}

/// What makes a run unfit to be evaluated at all.
Failure check(const Measurements& measurements, const FitConfig& config) {
  const std::size_t count = measurements.number_of_tilts;
  if (count < std::max(config.min_tilts, kFewestTilts) || count > kMaxTilts) return Failure::kTooFewTilts;
  for (std::size_t i = 0; i < count; ++i) {
    const TiltMeasurement& tilt = measurements.tilts[i];
    if (tilt.scans < kMinScansPerTilt || tilt.scans > kMaxScansPerTilt) return Failure::kTooFewScans;
    if (!is_finite(tilt)) return Failure::kNotFinite;
  }
  const bool rises = measurements.tilts[1].tilt_rad > measurements.tilts[0].tilt_rad;
  for (std::size_t i = 1; i < count; ++i) {
    const double step = measurements.tilts[i].tilt_rad - measurements.tilts[i - 1].tilt_rad;
    if (!(rises ? step > 0.0 : step < 0.0)) return Failure::kTiltsNotMonotonic;
  }
  return Failure::kNone;
}

void summarise(const Measurements& measurements, PlateResult& result) {
  result.number_of_tilts = measurements.number_of_tilts;
  for (std::size_t i = 0; i < measurements.number_of_tilts; ++i) {
    const TiltMeasurement& tilt = measurements.tilts[i];
    TiltSummary& summary = result.tilts[i];
    summary.tilt_rad = tilt.tilt_rad;
    summary.scans = tilt.scans;
    summary.mean_db = tilt.amplitude.mean();
    summary.std_db = std::sqrt(tilt.amplitude.variance());
    std::array<double, kMaxScansPerTilt> scratch = tilt.amplitude_db;
    summary.median_db = median({scratch.data(), tilt.scans});
    summary.mean_azimuth_rad = tilt.azimuth.mean();
    summary.azimuth_std_rad = std::sqrt(tilt.azimuth.variance());
  }
}

/// Means with the variances of the samples, as published (3).
Points published_points(const PlateResult& result) {
  Points points{.count = result.number_of_tilts};
  for (std::size_t i = 0; i < points.count; ++i) {
    points.tilt[i] = result.tilts[i].tilt_rad;
    points.amplitude[i] = result.tilts[i].mean_db;
    points.std[i] = std::max(result.tilts[i].std_db, kSmallestStd_db);
  }
  return points;
}

/// Robust locations of the tilts' amplitudes.
Points robust_points(const Measurements& measurements, double model_std_db) {
  const Locations amplitudes = locate(measurements, kSmallestStd_db, [](const TiltMeasurement& tilt) {
    return std::tie(tilt.amplitude_db, tilt.amplitude);
  });
  Points points{.count = measurements.number_of_tilts, .tilt = {}, .amplitude = amplitudes.value, .std = {}};
  for (std::size_t i = 0; i < points.count; ++i) {
    points.tilt[i] = measurements.tilts[i].tilt_rad;
    points.std[i] = std::hypot(amplitudes.std[i], model_std_db);
  }
  return points;
}

/// χ² per degree of freedom of the tilts used, at least 1: residuals larger than the noise widen the std.
double excess(const Points& points, const Parabola& parabola, const std::array<bool, kMaxTilts>& used) {
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < points.count; ++i) {
    if (!used[i]) continue;
    const double r = (points.amplitude[i] - parabola.at(points.tilt[i])) / points.std[i];
    squares += r * r;
    ++count;
  }
  return count > 3 ? std::max(1.0, squares / (count - 3)) : 1.0;
}

}  // namespace

std::string_view name_of(Failure failure) {
  switch (failure) {
    case Failure::kNone:
      return "NONE";
    case Failure::kAborted:
      return "ABORTED";
    case Failure::kPositioningTimeout:
      return "POSITIONING_TIMEOUT";
    case Failure::kNoPlateSeen:
      return "NO_PLATE_SEEN";
    case Failure::kMeasuringTimeout:
      return "MEASURING_TIMEOUT";
    case Failure::kDecisionTimeout:
      return "DECISION_TIMEOUT";
    case Failure::kTooFewTilts:
      return "TOO_FEW_TILTS";
    case Failure::kTooFewScans:
      return "TOO_FEW_SCANS";
    case Failure::kTiltsNotMonotonic:
      return "TILTS_NOT_MONOTONIC";
    case Failure::kNotFinite:
      return "NOT_FINITE";
    case Failure::kNoMaximum:
      return "NO_MAXIMUM";
    case Failure::kMaximumOutsideTilts:
      return "MAXIMUM_OUTSIDE_TILTS";
    case Failure::kAmplitudeTooLow:
      return "AMPLITUDE_TOO_LOW";
  }
  return "?";
}

std::string_view explain(Failure failure) {
  switch (failure) {
    case Failure::kNone:
      return "the run is good";
    case Failure::kAborted:
      return "the station aborted the run";
    case Failure::kPositioningTimeout:
      return "the plate was not reported in place in time";
    case Failure::kNoPlateSeen:
      return "no detection of the plate in its window for too long";
    case Failure::kMeasuringTimeout:
      return "too few scans showed the plate in time";
    case Failure::kDecisionTimeout:
      return "the station did not go on after a tilt";
    case Failure::kTooFewTilts:
      return "too few tilts, or too few that agree with one another";
    case Failure::kTooFewScans:
      return "a tilt has fewer than 10 or more than 50 scans";
    case Failure::kTiltsNotMonotonic:
      return "the tilts neither rise nor fall throughout";
    case Failure::kNotFinite:
      return "a measured value is not a number";
    case Failure::kNoMaximum:
      return "the amplitude has no maximum over the tilt";
    case Failure::kMaximumOutsideTilts:
      return "the amplitude's maximum lies beyond the tilts that were measured";
    case Failure::kAmplitudeTooLow:
      return "the amplitude at its maximum is below the limit: the bumper transmits too little";
  }
  return "?";
}

PlateResult evaluate(const Measurements& measurements, const FitConfig& config) {
  PlateResult result;
  result.method = config.method;
  result.failure = check(measurements, config);
  if (!result.ok()) return result;
  summarise(measurements, result);

  const bool robust = config.method == FitMethod::kRobust;
  const Points points = robust ? robust_points(measurements, config.model_std_db) : published_points(result);
  Solution solution;
  double rivals_variance = 0.0;
  if (robust) {
    solution = fit_robust(points, rivals_variance);
  } else {
    std::fill_n(solution.used.begin(), points.count, true);
    if (fit_used(points, solution.used, solution.parabola)) solution.cost = 0.0;
  }
  // Tilts so close together that no parabola can be told.
  if (!std::isfinite(solution.cost)) {
    result.failure = Failure::kNoMaximum;
    return result;
  }
  const Parabola& parabola = solution.parabola;
  const std::array<bool, kMaxTilts>& used = solution.used;
  for (std::size_t i = 0; i < points.count; ++i) {
    result.tilts[i].used = used[i];
    result.tilts[i].taken_db = points.amplitude[i];
    result.tilts[i].fitted_db = parabola.at(points.tilt[i]);
    if (used[i]) ++result.tilts_used;
  }
  result.parabola = {parabola.b[0], parabola.b[1], parabola.b[2]};
  find_azimuth(measurements, robust, result);
  const double widen = robust ? excess(points, parabola, used) : 1.0;
  // A curvature within its own noise tells of no maximum either; the published condition is b₁ ≥ 0 alone.
  const bool flat = robust && parabola.b[0] + 2.0 * std::sqrt(parabola.covariance(0, 0) * widen) >= 0.0;
  if (!parabola.has_maximum() || flat) {
    result.failure = Failure::kNoMaximum;
    return result;
  }
  result.pitch_rad = -parabola.argmax();  // (1)(7)
  result.maximum_db = parabola.maximum();
  judge_by_triples(points, config, result);
  result.pitch_std_rad =
      robust ? std::sqrt(parabola.argmax_variance() * widen + rivals_variance) : result.triples_std_rad;

  const double first = points.tilt[0], last = points.tilt[points.count - 1];
  if (robust && result.tilts_used < std::max(config.min_tilts, kFewestTilts)) {
    result.failure = Failure::kTooFewTilts;
  } else if (parabola.argmax() < std::min(first, last) || parabola.argmax() > std::max(first, last)) {
    result.failure = Failure::kMaximumOutsideTilts;
  } else if (result.maximum_db < config.min_amplitude_db) {
    result.failure = Failure::kAmplitudeTooLow;
  }
  return result;
}

}  // namespace boresight::alignment::plate
