// Figures over objects, each with the interval of a bootstrap over the objects (object = drive × id).
#pragma once

#include <cstddef>
#include <vector>

#include "tests/benchmarks/common/intervals.hpp"
#include "tests/benchmarks/tracking/drives/judge/evaluation.hpp"

namespace boresight::bench::tracking {

struct Estimate {
  double figure = 0.0;  ///< NaN without data
  Interval interval;
  std::size_t objects = 0;  ///< with data
};

/// Indices of the objects of a class by judge::index_of(); judge::kClasses: of all classes.
[[nodiscard]] std::vector<std::size_t> objects_of_class(const Evaluation& evaluation, std::size_t object_class);

/// Mean share of lists in which the objects are tracked, %.
[[nodiscard]] double tracked_percent(const Outcome& outcome, const std::vector<std::size_t>& objects);
/// The same with its interval.
[[nodiscard]] Estimate tracked_estimate(const Outcome& outcome, const std::vector<std::size_t>& objects);
/// tracked_percent() with each object weighted by its lists in view: the tracked_share of `boresight score`.
[[nodiscard]] double tracked_percent_of_lists(const Outcome& outcome);
/// Mean over the objects of the difference of their shares, percentage points; paired.
[[nodiscard]] Estimate difference_points(const Outcome& tracker, const Outcome& baseline,
                                         const std::vector<std::size_t>& objects);
/// Share of position errors inside the stated 95 % ellipse, %.
[[nodiscard]] Estimate inside_percent(const Outcome& outcome, const std::vector<std::size_t>& objects);

/// Root mean squares while an object is near.
enum class NearError { kLength_m, kHeading_deg, kAxis_deg, kAlong_m, kAcross_m };
[[nodiscard]] Estimate near_rms(const Outcome& outcome, const std::vector<std::size_t>& objects, NearError error);

}  // namespace boresight::bench::tracking
