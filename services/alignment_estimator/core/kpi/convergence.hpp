// Convergence time and present drift of an estimate, from its own history and without truth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"

namespace boresight::alignment {

/// History of (k_v, yaw, pitch, roll) of one radar, the angles about the vehicle's axes. It thins with age: the time
/// since the start grows by 2 % from one kept value to the next. Times are exact to 2 % from 0.1 s to years, with
/// constant memory. No allocation.
class Convergence {
 public:
  /// Time and scans until 95 % of the initial error is removed; NaN and 0 if unknown.
  struct Settled {
    double seconds;
    std::uint32_t scans;
  };

  /// Adds the estimate after a scan. The distance starts at the first value. A step change starts a new distance at the
  /// value before it.
  void add(double seconds_of_drive, std::uint64_t scans, const Eigen::Vector4d& values, std::uint32_t step_changes);

  /// Driving until the value stayed within 5 % of the distance from the start to the present value (Burza 2025, §8; the
  /// truth is unknown). Unknown while the distance is below five times `std`, where it may be noise.
  [[nodiscard]] Settled to_95_percent(AlignmentParameter parameter, double std) const;
  /// Change over the last minute of driving; NaN before that.
  [[nodiscard]] double drift_per_minute(AlignmentParameter parameter) const;

 private:
  static constexpr double kGrowth = 1.02;
  static constexpr double kFirst_s = 0.1;
  /// 0.1 s · 1.02^1200 is 67 years.
  static constexpr std::size_t kCapacity = 1200;
  static constexpr std::size_t kMinute = 60;
  struct Entry {
    double seconds = 0.0;
    std::uint64_t scans = 0;
    Eigen::Vector4d values = Eigen::Vector4d::Zero();
  };
  std::array<Entry, kCapacity> kept_{};
  std::size_t number_kept_ = 0;
  Entry latest_;
  std::uint32_t step_changes_ = 0;
  /// One value per second of driving.
  std::array<Entry, kMinute + 1> minute_{};
  std::size_t minute_next_ = 0;
  std::size_t minute_size_ = 0;
};

}  // namespace boresight::alignment
