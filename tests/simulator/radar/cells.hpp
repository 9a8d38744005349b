// Resolution: echoes nearer to each other than a cell in range, azimuth and range rate are one detection.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/simulator/radar/round_trip.hpp"
#include "tests/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

/// Whether two echoes can be told apart: they differ by a cell's size or more in any of the three. Quantities without a
/// cell (size 0) are told apart to the sixth digit.
[[nodiscard]] bool resolved(const ResolutionCell& cell, const Echo& a, const Echo& b);

/// Merges what is not resolved. There is no grid: neighbours are not parted because a border happens to lie between
/// them. The strongest echo takes all that is within a cell of it, then the strongest of those left, and so on. Powers
/// add up, range, angles and range rate are the centroid by power, truth and key those of the strongest.
class Cells {
 public:
  explicit Cells(const ResolutionCell& cell) : cell_(cell) {}
  /// The result is ordered by the power of the strongest. Costs a sort, and for each result a look at what lies within
  /// a cell of range.
  void merge(std::vector<Echo>& echoes);

 private:
  [[nodiscard]] Echo take(std::size_t strongest, const std::vector<Echo>& echoes);
  ResolutionCell cell_;
  std::vector<Echo> merged_;
  std::vector<std::uint32_t> by_power_;
  std::vector<char> taken_;
};

}  // namespace boresight::simulator::radar
