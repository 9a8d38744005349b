// Settings of the method `evidence`; the defaults are what config/services/ghost_filter.toml ships.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/common/extended_object/object_classes.hpp"
#include "services/ghost_filter/core/evidence/weights.hpp"
#include "services/ghost_filter/core/reflectors/config.hpp"

namespace boresight::ghosts {

/// Gates of the counts. The weights of the radar profiles hold for these values.
struct CountConfig {
  double memory_s = 0.3;                ///< of earlier scans
  double past_radius_m = 1.5;           ///< largest distance from where it would have been
  double past_radius_per_range = 0.02;  ///< added to that, per metre of range
  double past_range_rate_mps = 0.8;     ///< largest difference of the range rates over ground
  double company_radius_m = 2.5;        ///< largest difference in range, and across the line of sight
  double company_range_rate_mps = 0.6;  ///< largest difference of the measured range rates
  double wide_range_m = 8.0;            ///< the same of the wide ring
  double wide_range_rate_mps = 1.2;
  std::size_t most_neighbours = 96;    ///< detections of the scan that are looked at for one of them, nearest in range
  std::size_t most_past_looks = 256;   ///< earlier detections that are looked at for one
  std::size_t most_remembered = 4096;  ///< earlier detections in memory, newest first
};

/// From which value on a count or share has the next level.
struct LevelConfig {
  std::array<double, 5> past_scans{1.0, 2.0, 3.0, 5.0, 7.0};
  std::array<double, 3> company{2.0, 3.0, 4.0};
  std::array<double, 2> ring_share{0.5, 0.3};  ///< falling; no other in the ring is the lowest level
  std::array<double, 3> range_m{10.0, 30.0, 65.0};
  std::array<double, 3> wide_ring{1.0, 4.0, 10.0};
  std::array<double, 3> burst{8.0, 20.0, 45.0};
  std::array<double, 3> existence{0.25, 0.5, 0.75};
  std::array<double, 5> image_share{0.02, 0.1, 0.3, 0.6, 0.9};
  std::array<double, 4> track_log10_intensity{-6.0, -4.5, -3.0, -2.0};  ///< per m² and m/s
};

/// What known objects, and their mirror images, are expected to show.
struct IntensityConfig {
  double ambiguous_share = 0.03;      ///< of an object's detections, with any range rate
  double ambiguous_width_mps = 70.0;  ///< of these range rates
  double position_std_m = 0.3;        ///< of a prediction, beside its covariance
  double velocity_std_mps = 0.3;
  double other_intensity = 5e-5;     ///< of anything else, per m² and m/s
  double certainty_power = 4.0;      ///< s of (G2): the existence to this power
  double mirrored_existence = 0.5;   ///< least existence of a track whose mirror images are expected
  double mirror_share_per_m = 0.01;  ///< probability that a reflector mirrors, per metre of its length
  double most_mirror_share = 0.6;
  double least_mirror_share = 0.05;  ///< reflectors below are no mirrors
  double mirror_scatter_m = 0.1;     ///< least scatter of a mirror's detections across it
};

struct RadarWeights {
  std::uint32_t radar_id = 0;
  EvidenceWeights weights;
};

struct EvidenceConfig {
  double tracks_max_age_s = 0.5;  ///< older tracks are not used
  CountConfig counts;
  LevelConfig levels;
  IntensityConfig intensity;
  MapConfig map;
  EvidenceWeights weights;           ///< of radars that are not in `radars`
  std::vector<RadarWeights> radars;  ///< by id
  extended_object::ObjectClassTable classes = extended_object::object_class_table_defaults();
};

}  // namespace boresight::ghosts
