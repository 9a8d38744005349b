// Whether the body pitches: radars then see it together. What moves the elevations of one alone, such as the road's
// mirror images, is not the body's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interfaces/messages/header.hpp"

namespace boresight::alignment {

/// Products of what two radars make of the body's pitch at about the same time. Their mean is the variance of what is
/// common, whatever moves each of them; how sure it is is told by sums over a second each, which no noise outlasts.
class CommonPitch {
 public:
  /// One scan moved mean and variance of the body's pitch, rad.
  void add(std::size_t radar, std::int64_t time_ns, double mean_before, double variance_before, double mean_after,
           double variance_after);
  /// 1 if the body is known to pitch, 0 if what is estimated of it may as well be noise, and between. With one radar
  /// it is never known.
  [[nodiscard]] double share() const;

 private:
  struct Said {
    bool ever = false;
    std::int64_t time_ns = 0;
    double value = 0.0;   ///< in stds of its noise, free of its slow mean
    double weight = 0.0;  ///< 1 / that std
    double mean = 0.0;    ///< rad, sliding
  };
  std::array<Said, kMaxRadars> said_{};
  std::int64_t block_ns_ = 0;
  double block_ = 0.0;
  double sum_ = 0.0, sum_of_squares_ = 0.0;
};

}  // namespace boresight::alignment
