// Resolution: echoes that differ by less than a cell in range, azimuth and range rate make one detection.
#pragma once

#include <cstdint>
#include <vector>

#include "services/simulator/radar/round_trip.hpp"
#include "services/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

/// Whether two echoes are resolved: they differ by a cell's size or more in at least one of the three quantities. A
/// quantity without a cell (size 0) is resolved from a difference of 1e-6.
[[nodiscard]] bool resolved(const ResolutionCell& cell, const Echo& a, const Echo& b);

/// Merges echoes that are not resolved. There is no grid, so no cell border can separate neighbours. The strongest echo
/// takes all echoes within a cell of it; then the strongest remaining echo does the same, and so on. Powers add up.
/// Range, angles and range rate are the centroid weighted by power. Truth and key are those of the strongest echo.
class Cells {
 public:
  explicit Cells(const ResolutionCell& cell) : cell_(cell) {}
  /// The result is ordered by the power of the strongest echo in each detection. The cost is a sort, and for each
  /// detection a visit of the echoes within a cell of range.
  void merge(std::vector<Echo>& echoes);

 private:
  [[nodiscard]] Echo take(std::size_t strongest, const std::vector<Echo>& echoes);
  ResolutionCell cell_;
  std::vector<Echo> merged_;
  std::vector<std::uint32_t> by_power_;
  std::vector<char> taken_;
};

}  // namespace boresight::simulator::radar
