// Resolution: what falls into one cell of range, azimuth and range rate is one detection.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/simulator/radar/round_trip.hpp"
#include "tests/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

/// A cell's number; quantities without a cell (size 0) are told apart to the sixth digit.
struct CellIndex {
  std::int64_t range, azimuth, range_rate;
  auto operator<=>(const CellIndex&) const = default;
};

[[nodiscard]] CellIndex cell_of(const ResolutionCell& cell, double range_m, double azimuth_rad, double range_rate_mps);

/// Merges echoes of one cell: their powers add up, range, angles and range rate are the centroid by power, truth and
/// key those of the strongest. Sorts by cell.
class Cells {
 public:
  explicit Cells(const ResolutionCell& cell) : cell_(cell) {}
  void merge(std::vector<Echo>& echoes);

 private:
  struct Entry {
    CellIndex cell;
    double power;  // linear
    Echo echo;
  };
  ResolutionCell cell_;
  std::vector<Entry> entries_;
};

}  // namespace boresight::simulator::radar
