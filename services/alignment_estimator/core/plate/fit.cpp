#include "services/alignment_estimator/core/plate/fit.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "services/alignment_estimator/core/plate/azimuth.hpp"
#include "services/alignment_estimator/core/plate/locations.hpp"
#include "services/alignment_estimator/core/plate/parabola.hpp"

namespace boresight::alignment::plate {

namespace {

constexpr double kSmallestStd_db = 0.01;  // below the amplitude resolution of any radar
constexpr double kGate = 3.0;             // stds

/// Repeatable choice of triples (splitmix64), independent of the distributions of the standard library.
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

/// The tilts as points of the fit.
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

/// The parabola of three tilts, refined by least squares over the tilts that agree with it. The refinement reduces the
/// effect of noise in the three, and keeps the sign of the curvature. False if the three do not determine a parabola.
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

/// RANSAC over every triple (at most 165, so none are drawn). A solution without a maximum is taken only if its cost is
/// lower by more than that of one rejected tilt, since the echo of a plate has a maximum. `rivals_variance`: variance
/// of the place of the maximum (rad²) over all solutions, weighted by their likelihood. Two bad tilts that agree are
/// hard to distinguish from good ones; a rival of similar likelihood then widens the std by its distance.
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
  // Least squares over the tilts finally used, for the covariance.
  Parabola refitted;
  if (std::isfinite(result.cost) && fit_used(points, result.used, refitted)) result.parabola = refitted;
  return result;
}

/// Maxima of M random triples, Burza 2025, §7: agreement of the tilts with one another.
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
  result.triples_median_rad = estimation::median(found);
  // By the MAD: the maximum of three neighbouring tilts may be anywhere and would dominate a plain spread.
  result.triples_std_rad = estimation::mad_std(found, result.triples_median_rad);
}

bool is_finite(const TiltMeasurement& tilt) {
  bool finite = std::isfinite(tilt.tilt_rad);
  for (std::size_t k = 0; k < tilt.scans; ++k) {
    finite = finite && std::isfinite(tilt.amplitude_db[k]) && std::isfinite(tilt.azimuth_rad[k]);
  }
  return finite;
}

/// Conditions under which a run cannot be evaluated.
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
    summary.median_db = estimation::median({scratch.data(), tilt.scans});
    summary.mean_azimuth_rad = tilt.azimuth.mean();
    summary.azimuth_std_rad = std::sqrt(tilt.azimuth.variance());
  }
}

/// Means weighted with the variances of the samples, as published (3).
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
  // The tilts are too close together to determine a parabola.
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
  const bool azimuths_agree = find_azimuth(measurements, config.method, result);
  const double widen = robust ? excess(points, parabola, used) : 1.0;
  // A curvature within its noise gives no maximum either; the published condition is b₁ ≥ 0 alone.
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
  if (!azimuths_agree || (robust && result.tilts_used < std::max(config.min_tilts, kFewestTilts))) {
    result.failure = Failure::kTooFewTilts;
  } else if (parabola.argmax() < std::min(first, last) || parabola.argmax() > std::max(first, last)) {
    result.failure = Failure::kMaximumOutsideTilts;
  } else if (result.maximum_db < config.min_amplitude_db) {
    result.failure = Failure::kAmplitudeTooLow;
  }
  return result;
}

}  // namespace boresight::alignment::plate
