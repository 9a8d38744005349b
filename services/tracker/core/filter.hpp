// A multi-object filter over a model: the point-process part of a tracker.
#pragma once

#include <cstdint>
#include <span>

#include "services/tracker/core/ggiw/component.hpp"
#include "services/tracker/core/model/model.hpp"

namespace boresight::tracking {

/// Existence of a Bernoulli component that was not detected, q being the chance of that if it exists: (T9).
[[nodiscard]] inline double missed_existence(double r, double q) {
  return r < 1.0 ? r * q / (1.0 - r + r * q) : 1.0;
}

/// Work and losses of one step.
struct FilterWork {
  std::uint32_t likelihood_evaluations = 0;
  bool budget_reached = false;
  std::uint32_t dropped_detections = 0;  ///< measurements beyond the capacity of a scan
  std::uint32_t dropped_objects = 0;     ///< hypotheses that found no room
  std::uint32_t cut_gates = 0;           ///< connections that would have made a group too large: nothing is lost
};

class Filter {
 public:
  virtual ~Filter() = default;

  /// One scan: predict by `elapsed_s`, then update with the model's measurements.
  virtual void step(Model& model, double elapsed_s) = 0;
  virtual void clear() = 0;

  [[nodiscard]] virtual std::span<const ObjectEstimate> estimates() const = 0;
  /// Of each measurement of the scan, the probability that a tracked object explains it.
  [[nodiscard]] virtual std::span<const double> explained() const = 0;
  [[nodiscard]] virtual const FilterWork& work() const = 0;
};

}  // namespace boresight::tracking
