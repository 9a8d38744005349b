// How fast an estimate came to where it is, and whether it moves on: without truth, from its own history.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"

namespace boresight::alignment {

/// History of (k_v, yaw, pitch, roll), the angles about the vehicle's axes, of one radar. It thins itself with age: the
/// time since the start grows by 2 % from one kept value to the next, so that times are known to 2 % from 0.1 s to
/// years with constant memory. No allocation.
class Convergence {
 public:
  /// Time and scans until 95 % of the way; NaN and 0 if not known.
  struct Settled {
    double seconds;
    std::uint32_t scans;
  };

  /// Takes the estimate after a scan. The first one is where the way starts, and a growing count of knocks starts a new
  /// way at the value before the knock.
  void add(double seconds_of_drive, std::uint64_t scans, const Eigen::Vector4d& values, std::uint32_t step_changes);

  /// Drive until the value stayed within 5 % of the way from the start to today's value (Burza 2025, §8; the truth is
  /// not known). Not known while the way is shorter than five times `std`: then it may be all noise.
  [[nodiscard]] Settled to_95_percent(AlignmentParameter parameter, double std) const;
  /// Change over the last minute of drive; NaN before that.
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
  /// One value a second of drive.
  std::array<Entry, kMinute + 1> minute_{};
  std::size_t minute_next_ = 0;
  std::size_t minute_size_ = 0;
};

}  // namespace boresight::alignment
