#include "tests/simulator/radar/cells.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::simulator::radar {

namespace {

std::int64_t index(double value, double size) {
  return static_cast<std::int64_t>(std::floor(value / (size > 0.0 ? size : 1e-6)));
}

}  // namespace

CellIndex cell_of(const ResolutionCell& cell, double range_m, double azimuth_rad, double range_rate_mps) {
  return {index(range_m, cell.range_m), index(azimuth_rad, cell.azimuth_rad),
          index(range_rate_mps, cell.range_rate_mps)};
}

void Cells::merge(std::vector<Echo>& echoes) {
  entries_.clear();
  for (const Echo& e : echoes) {
    entries_.push_back(
        {cell_of(cell_, e.range_m, e.azimuth_rad, e.range_rate_mps), std::pow(10.0, 0.1 * e.power_db), e});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    if (a.cell != b.cell) return a.cell < b.cell;
    return a.power != b.power ? a.power > b.power : a.echo.key < b.echo.key;
  });
  echoes.clear();
  for (std::size_t begin = 0; begin < entries_.size();) {
    std::size_t end = begin + 1;
    while (end < entries_.size() && entries_[end].cell == entries_[begin].cell) ++end;
    Echo merged = entries_[begin].echo;
    if (end - begin > 1) {
      double power = 0.0, range = 0.0, azimuth = 0.0, elevation = 0.0, rate = 0.0;
      for (std::size_t i = begin; i < end; ++i) {
        const Entry& e = entries_[i];
        power += e.power;
        range += e.power * e.echo.range_m;
        azimuth += e.power * e.echo.azimuth_rad;
        elevation += e.power * e.echo.elevation_rad;
        rate += e.power * e.echo.range_rate_mps;
      }
      merged.range_m = range / power;
      merged.azimuth_rad = azimuth / power;
      merged.elevation_rad = elevation / power;
      merged.range_rate_mps = rate / power;
      merged.power_db = 10.0 * std::log10(power);
    }
    echoes.push_back(merged);
    begin = end;
  }
}

}  // namespace boresight::simulator::radar
