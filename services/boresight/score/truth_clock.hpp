// Times of a run on the clock of its truth.
#pragma once

#include <cstdint>
#include <optional>

#include "services/boresight/score/car_truth.hpp"
#include "services/boresight/score/truth_source.hpp"

namespace boresight::score {

class TruthClock {
 public:
  /// Reads the first times of the tables, and the offsets of the radars' stamps. Throws InputError.
  explicit TruthClock(const TruthSource& truth)
      : car_(read_car_truth(truth.drive)), first_s_(first_time_s(truth).value_or(0.0)) {}

  /// Finds the truth's time 0. `time_ns`: a time of the run, best its first one. `since_start_s`: how long after the
  /// run's first measurement it is.
  void begin(std::int64_t time_ns, double since_start_s) {
    origin_ns_ = truth_origin_ns(first_s_, time_ns, since_start_s);
  }
  /// The run itself states the truth's time 0.
  void begin_at(std::int64_t origin_ns) { origin_ns_ = origin_ns; }
  [[nodiscard]] bool has_begun() const { return origin_ns_.has_value(); }

  /// The truth's time 0 on the clock of the run, ns; 0 before begin().
  [[nodiscard]] std::int64_t origin_ns() const { return origin_ns_.value_or(0); }
  /// A time of the run on the truth's clock.
  [[nodiscard]] double time_s(std::int64_t time_ns) const { return 1e-9 * static_cast<double>(time_ns - origin_ns()); }
  /// Time of measurement of a scan, which a late stamp does not state.
  [[nodiscard]] double measured_s(std::uint32_t radar, std::int64_t stamp_ns) const {
    return time_s(stamp_ns) - car_.stamp_offset_s(radar);
  }
  /// Of the truth's first row.
  [[nodiscard]] double first_s() const { return first_s_; }
  [[nodiscard]] const CarTruth& car() const { return car_; }

 private:
  CarTruth car_;
  double first_s_;
  std::optional<std::int64_t> origin_ns_;
};

}  // namespace boresight::score
