#include "tests/benchmarks/tracking/drives/judge/estimates.hpp"

#include <cmath>

#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::bench::tracking {

namespace {

constexpr double kPercent = 100.0;

struct Term {
  double part = 0.0, whole = 0.0;
};

/// `finish(Σ part / Σ whole)` over objects.
template <typename TermOf, typename Finish>
Estimate ratio(const std::vector<std::size_t>& objects, const TermOf& term_of, const Finish& finish) {
  std::vector<Term> terms;
  for (const std::size_t object : objects) {
    const Term term = term_of(object);
    if (term.whole > 0.0) terms.push_back(term);
  }
  const auto figure_of = [&](const auto& index_of, std::size_t count) {
    Term sum;
    for (std::size_t i = 0; i < count; ++i) {
      sum.part += terms[index_of(i)].part;
      sum.whole += terms[index_of(i)].whole;
    }
    return sum.whole > 0.0 ? finish(sum.part / sum.whole) : kNaN;
  };
  Estimate estimate;
  estimate.objects = terms.size();
  estimate.figure = figure_of([](std::size_t i) { return i; }, terms.size());
  estimate.interval = bootstrap(terms.size(), [&](const std::vector<std::size_t>& picks) {
    return figure_of([&picks](std::size_t i) { return picks[i]; }, picks.size());
  });
  return estimate;
}

}  // namespace

std::vector<std::size_t> objects_of_class(const Evaluation& evaluation, std::size_t object_class) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < evaluation.objects.size(); ++i) {
    if (object_class == judge::kClasses || judge::index_of(evaluation.objects[i].object_class) == object_class) {
      indices.push_back(i);
    }
  }
  return indices;
}

double tracked_percent(const Outcome& outcome, const std::vector<std::size_t>& objects) {
  if (objects.empty() || outcome.objects.empty()) return kNaN;
  double sum = 0.0;
  for (const std::size_t object : objects) sum += outcome.objects[object].share();
  return kPercent * sum / static_cast<double>(objects.size());
}

Estimate tracked_estimate(const Outcome& outcome, const std::vector<std::size_t>& objects) {
  return ratio(
      objects,
      [&](std::size_t i) {
        return Term{outcome.objects[i].share(), 1.0};
      },
      [](double mean) { return kPercent * mean; });
}

double tracked_percent_of_lists(const Outcome& outcome) {
  ObjectTally sum;
  for (const ObjectTally& object : outcome.objects) sum.add(object, 1.0);
  return sum.lists_in_view > 0.0 ? kPercent * sum.share() : kNaN;
}

Estimate difference_points(const Outcome& tracker, const Outcome& baseline, const std::vector<std::size_t>& objects) {
  if (baseline.objects.empty()) return {kNaN, {kNaN, kNaN}, 0};
  return ratio(
      objects,
      [&](std::size_t i) {
        return Term{tracker.objects[i].share() - baseline.objects[i].share(), 1.0};
      },
      [](double mean) { return kPercent * mean; });
}

Estimate inside_percent(const Outcome& outcome, const std::vector<std::size_t>& objects) {
  return ratio(
      objects,
      [&](std::size_t i) {
        return Term{outcome.objects[i].errors_inside, outcome.objects[i].errors_with_covariance};
      },
      [](double share) { return kPercent * share; });
}

Estimate near_rms(const Outcome& outcome, const std::vector<std::size_t>& objects, NearError error) {
  const auto term = [&](std::size_t i) -> Term {
    const ObjectTally::Near& near = outcome.objects[i].near;
    switch (error) {
      case NearError::kLength_m:
        return {near.length_m2, near.lists};
      case NearError::kHeading_deg:
        return {near.heading_rad2, near.lists_moving};
      case NearError::kAxis_deg:
        return {near.axis_rad2, near.lists};
      case NearError::kAlong_m:
        return {near.along_m2, near.lists};
      case NearError::kAcross_m:
        return {near.across_m2, near.lists};
    }
    return {};
  };
  const bool is_angle = error == NearError::kHeading_deg || error == NearError::kAxis_deg;
  return ratio(objects, term, [&](double mean) { return (is_angle ? kDegreesPerRadian : 1.0) * std::sqrt(mean); });
}

}  // namespace boresight::bench::tracking
