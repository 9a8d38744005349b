// Doppler ambiguity: the radar samples the phase chirp by chirp. It cannot distinguish range rates that differ by the
// width of its unambiguous interval.
#pragma once

#include <cmath>

namespace boresight::simulator::radar {

/// Folds a range rate into [−limit, limit). A limit of 0 means no folding: the radar resolves the ambiguity.
[[nodiscard]] inline double fold(double range_rate_mps, double limit_mps) {
  if (limit_mps <= 0.0) return range_rate_mps;
  const double width = 2.0 * limit_mps;
  return range_rate_mps - width * std::floor((range_rate_mps + limit_mps) / width);
}

}  // namespace boresight::simulator::radar
