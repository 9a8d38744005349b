// Expected detections of no object, for each radar by range, sector and range rate: a table to begin with, then what
// the radar showed and no object explains (radar-statistics.md §6). Echoes that keep pace with the own vehicle are
// apart.
#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "services/tracker/core/model/radar_parameters.hpp"

namespace boresight::tracking {

/// Where a detection lies for the map.
struct ClutterPlace {
  double range_m = 0.0;
  double azimuth_share = 0.0;  ///< place in the field of view, −1 … 1
  double range_rate_over_ground_mps = 0.0;
  double range_rate_mps = 0.0;  ///< as measured
};

class ClutterMap {
 public:
  /// Half the angle of view and the largest range give the areas of the cells.
  ClutterMap(const ClutterParameters& parameters, double half_view_rad, double range_max_m);

  /// Expected detections per m² and m/s at a place.
  [[nodiscard]] double intensity(const ClutterPlace& place) const;

  /// Opens a scan: what was learnt fades by the time since the radar's last one.
  void begin_scan(double time_s);
  /// A detection of the scan that no object explains, with that probability.
  void add(const ClutterPlace& place, double unexplained);

 private:
  // Cells: ranges and range rates of both signs as the table has them, and sectors.
  static constexpr std::size_t kRanges = std::tuple_size_v<decltype(ClutterParameters::table_by_range)>;
  static constexpr std::size_t kOneWayRates = std::tuple_size_v<decltype(ClutterParameters::table_by_rate)>;
  static constexpr std::size_t kRates = kOneWayRates + kOneWayRates;
  static constexpr std::size_t kSectors = 7, kPaceRanges = 10, kPaceSectors = 15;
  /// Edges of the table, from the nearest range and the largest range rate of approach on.
  [[nodiscard]] double range_edge_m(std::size_t edge) const;
  [[nodiscard]] double rate_edge_mps(std::size_t edge) const;
  [[nodiscard]] std::size_t cell(const ClutterPlace& place) const;
  [[nodiscard]] std::size_t pace_cell(const ClutterPlace& place) const;
  [[nodiscard]] bool keeps_pace(const ClutterPlace& place) const;
  /// Volume of a cell in m² m/s.
  [[nodiscard]] double volume(std::size_t cell) const;
  [[nodiscard]] double pace_volume(std::size_t cell) const;

  ClutterParameters parameters_;
  double half_view_rad_, range_max_m_;
  std::array<double, kRanges * kSectors * kRates> sum_{};
  std::array<double, kPaceRanges * kPaceSectors> pace_sum_{};
  double scans_ = 0.0, time_s_ = 0.0;
  bool has_time_ = false;
};

}  // namespace boresight::tracking
