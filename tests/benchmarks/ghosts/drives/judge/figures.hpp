// Figures of the probabilities of judged detections.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/ghosts/drives/judge/judged.hpp"

namespace boresight::bench::ghosts_drives {

/// Drives, each with its detections.
using Drives = std::vector<const DriveResult*>;

/// One figure of the detections of some drives together, by sums over each drive, so that a bootstrap visits the
/// detections once.
struct Figure {
  using Sums = std::vector<double>;
  std::function<Sums(const DriveResult&)> sums;
  std::function<double(const Sums&)> value;  ///< of the drives' sums together; NaN without data

  [[nodiscard]] double operator()(const Drives& drives) const;
};

/// A figure of all drives together, with its 95 % interval over the drives, and the median of the single drives.
struct Estimate {
  double all = 0.0;
  Interval interval;
  double median = 0.0;
};
[[nodiscard]] Estimate estimate(const Figure& figure, const Drives& drives);

/// Brier score (Brier 1950) of the lane over that of the base rates.
[[nodiscard]] Figure brier_ratio(Lane lane);
/// The same of the logarithmic score. Probabilities count as at least 1e-4, and at most 1 less that.
[[nodiscard]] Figure log_loss_ratio(Lane lane);
/// Mean |stated probability − share of real ones| over tenths of the probability, weighted by their detections.
[[nodiscard]] Figure calibration_error(Lane lane);
/// Share of real detections of objects that are known for over 1 s with a probability below 0.5.
[[nodiscard]] Figure known_lost(Lane lane);
/// Share of Doppler-ambiguous detections of known objects with a probability of at least 0.5.
[[nodiscard]] Figure ambiguous_kept(Lane lane);
/// Share of false detections below the probability that 90 % of the real ones reach; of one origin, or kUnknown: of
/// all.
[[nodiscard]] Figure recognised_at_90(Lane lane, Provenance origin = Provenance::kUnknown);
/// Share of an origin among the false detections.
[[nodiscard]] Figure share_of_false(Provenance origin);

/// Sums of the detections of one tenth of the probability.
struct ReliabilityBin {
  double stated = 0.0, real = 0.0, detections = 0.0;
};
/// By rising probability.
[[nodiscard]] std::vector<ReliabilityBin> reliability(const Drives& drives, Lane lane);

}  // namespace boresight::bench::ghosts_drives
