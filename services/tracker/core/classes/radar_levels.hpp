// The usual strength of a radar's detections of the stationary world, by range. Scales of radars differ by 10 dB and
// more, and near parts of the world are weaker. Both hold for objects alike, so strengths are compared with this level.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/tracker/core/classes/object_forest.hpp"

namespace boresight::tracking {

class RadarLevels {
 public:
  RadarLevels(std::size_t radars, const RadarLevelParameters& parameters);

  /// Learns from the stationary detections of a scan. Radars are counted from 0; others are passed over.
  void learn(const ClassifiedScan& scan, std::size_t radar);
  /// Forgets all: the recording began again.
  void clear();
  /// A strength over the level of the radar at that range; NaN while the radar has no level.
  [[nodiscard]] double strength_db(std::size_t radar, double range_m, double rcs_dbsm) const;
  [[nodiscard]] double snr_db(std::size_t radar, double range_m, double snr_db) const;

 private:
  /// Of bands of range: from 0 to the first edge, then each as far as twice the one before, the last without end.
  using Bands = std::array<double, 5>;
  struct Level {
    Bands sum_db{}, number{};
    void fade(double keep);
    void add(std::size_t band, double value_db);
    [[nodiscard]] double at(std::size_t band, double prior_number) const;
  };
  struct Radar {
    Level strength, snr;
    double time_s = 0.0;
    bool has_time = false;
  };
  [[nodiscard]] std::size_t band_of(double range_m) const;

  RadarLevelParameters parameters_;
  std::vector<Radar> radars_;
};

}  // namespace boresight::tracking
