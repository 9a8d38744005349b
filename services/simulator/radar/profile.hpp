// The statistics of one radar as plain data: what this radar reports of the world, apart from wave propagation. Keys,
// units and origins: config/schema/radar_profile.md and config/radar_profiles/. Without values (`ideal`) every effect
// is off.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace boresight::simulator::radar {

inline constexpr std::size_t kObjectKnots = 7;    ///< ranges at which the statistics of objects are given
inline constexpr std::size_t kStrengthKnots = 6;  ///< ranges at which RCS is given
inline constexpr std::size_t kRings = 10;         ///< rings of the stationary world
inline constexpr double kRing_m = 10.0;           ///< width of a ring
inline constexpr std::size_t kDeviationBins = 5;

using ByRange = std::array<double, kObjectKnots>;
/// Values at the quantiles 10, 25, 50, 75 and 90 %, or 5, 25, 50, 75 and 95 %.
using FiveQuantiles = std::array<double, 5>;

/// Probability that a radar reports no detection of an object in sight.
struct PresenceSpec {
  bool on = false;
  ByRange range_m{5.0, 15.0, 25.0, 35.0, 57.5, 72.5, 90.0};
  ByRange car{}, truck{}, two_wheeler{}, pedestrian{}, standing_vehicle{}, standing_truck{};  ///< P(none)
  /// P(none | none in the scan before).
  double car_after_none = 0.0, truck_after_none = 0.0, two_wheeler_after_none = 0.0, pedestrian_after_none = 0.0,
         standing_vehicle_after_none = 0.0, standing_truck_after_none = 0.0;
  [[nodiscard]] bool operator==(const PresenceSpec&) const = default;
};

/// Number of detections of an object that is detected: 1 + Poisson.
struct CountSpec {
  bool on = false;
  ByRange range_m{5.0, 15.0, 25.0, 35.0, 57.5, 72.5, 90.0};
  ByRange car{}, truck{}, two_wheeler{}, pedestrian{}, standing_vehicle{}, standing_truck{};  ///< mean
  double rear_factor = 1.0, side_factor = 1.0, front_factor = 1.0;  ///< of the mean, by aspect; vehicles
  double correlation = 0.0;                                         ///< from scan to scan, of the Poisson part
  std::uint32_t most = 1;                                           ///< largest number
  [[nodiscard]] bool operator==(const CountSpec&) const = default;
};

/// Places of an object's detections on its body.
struct SpotSpec {
  bool on = false;
  double car_behind_m = 1.0, truck_behind_m = 1.0;  ///< mean distance behind the nearest point, along the line of sight
  double car_inside_share = 0.0, truck_inside_share = 0.0;  ///< of the side's detections: over kInside_m inside
  double correlation = 0.0;                                 ///< from scan to scan
  [[nodiscard]] bool operator==(const SpotSpec&) const = default;
};

/// Detections that deviate from the range rate of the rigid body.
struct MicroDopplerSpec {
  bool on = false;
  double rear = 0.0, side = 0.0, front = 0.0;  ///< share that deviates by over 0.5 m/s; vehicles, by aspect
  double pedestrian = 0.0, two_wheeler = 0.0;  ///< the same
  double large_share = 0.0;                    ///< of these: over 1 m/s
  FiveQuantiles ratio{};                       ///< 5, 25, 50, 75, 95 %: deviation / radial speed of the body
  double pedestrian_std_mps = 0.0;             ///< of the detections that do not deviate
  [[nodiscard]] bool operator==(const MicroDopplerSpec&) const = default;
};

/// RCS at the quantiles 10, 50 and 90 %, by range.
struct StrengthQuantiles {
  std::array<double, kStrengthKnots> low_dbsm{}, median_dbsm{}, high_dbsm{};
  [[nodiscard]] bool operator==(const StrengthQuantiles&) const = default;
};

struct StrengthSpec {
  bool on = false;
  std::array<double, kStrengthKnots> range_m{5.0, 15.0, 25.0, 37.5, 55.0, 82.5};
  StrengthQuantiles vehicle{}, false_mover{}, stationary{};
  double pedestrian_dbsm = 0.0, two_wheeler_dbsm = 0.0;  ///< median
  double person_std_db = 0.0;                            ///< of pedestrians and two-wheelers
  double detection_std_db = 0.0;                         ///< among the detections of one object in one scan
  double detection_correlation = 0.0;                    ///< of this part, from scan to scan
  double scan_std_db = 0.0;                              ///< from scan to scan
  double object_correlation = 0.0;                       ///< of the rest, from scan to scan
  double radar_offset_db = 0.0;                          ///< offset of the scale: uniform ±, per drive and radar
  [[nodiscard]] bool operator==(const StrengthSpec&) const = default;
};

/// Mirror images: their RCS against the level of their object's strongest detection, and how often mirrors work.
struct MirrorStrengthSpec {
  bool on = false;
  double mirror_strength_db = 0.0, mirror_strength_std_db = 0.0;
  double working_share = 1.0;  ///< of the paths over mirrors, at an instant: real surfaces are rough and interrupted
  [[nodiscard]] bool operator==(const MirrorStrengthSpec&) const = default;
};

/// False moving detections at a log-normal rate.
struct FalseMoverSpec {
  bool on = false;
  double median_per_scan = 0.0;
  double p90_per_scan = 0.0;                             ///< 90 % quantile of the rate
  double correlation_after_1s = 0.0;                     ///< of the rate's logarithm
  double abeam_factor = 1.0;                             ///< of the rate, for a radar that looks abeam
  FiveQuantiles range_m{};                               ///< 10, 25, 50, 75, 90 %
  std::array<double, kDeviationBins> deviation_share{};  ///< of 1–2, 2–5, 5–10, 10–20, 20–36 m/s
  double near_zero_share = 0.0;                          ///< range rate within ±1 m/s: as fast as the ego vehicle
  double lasting_share = 0.0;                            ///< of the births: longer than one scan
  double lasting_scans = 2.0;                            ///< their mean length
  [[nodiscard]] bool operator==(const FalseMoverSpec&) const = default;
};

/// Range rates that the sensor resolves wrongly.
struct DopplerAmbiguitySpec {
  bool on = false;
  double stationary_share = 0.0, moving_share = 0.0;
  double width_min_mps = 0.0, width_max_mps = 0.0;
  [[nodiscard]] bool operator==(const DopplerAmbiguitySpec&) const = default;
};

/// Detections of stationary reflectors at a wrong azimuth.
struct AzimuthAmbiguitySpec {
  bool on = false;
  double per_scan = 0.0;
  double sine_step = 0.0, sine_step_std = 0.0;  ///< of sin(azimuth)
  [[nodiscard]] bool operator==(const AzimuthAmbiguitySpec&) const = default;
};

/// Side lobes of moving objects.
struct SideLobeSpec {
  bool on = false;
  double per_object = 0.0;  ///< mean number per detected moving object and scan
  double least_offset_rad = 0.0;
  double strength_db = 0.0, strength_std_db = 0.0;  ///< against the object's strongest detection
  [[nodiscard]] bool operator==(const SideLobeSpec&) const = default;
};

/// Azimuth smear: for seconds, dozens of detections in one range interval.
struct BurstSpec {
  bool on = false;
  double every_s = 60.0;  ///< mean time from one burst to the next, per radar
  double duration_min_s = 1.0, duration_max_s = 1.0;
  double per_scan = 0.0;
  double range_min_m = 0.0, range_max_m = 0.0;  ///< of the interval's beginning
  double depth_m = 0.0;                         ///< of the interval
  double azimuth_width_rad = 0.0;               ///< largest; the least is a third of it
  double range_rate_std_mps = 0.0;              ///< about zero
  [[nodiscard]] bool operator==(const BurstSpec&) const = default;
};

/// The dense, near, weak, flickering stationary world.
struct StationaryWorldSpec {
  bool on = false;
  double reflector_seen = 1.0;            ///< probability of a scenario's reflector in a scan
  std::array<double, kRings> per_ring{};  ///< added detections in rings of 10 m, for a view of 140°
  double seen_again = 0.0;                ///< probability that an added detection is seen again in the next scan
  double bright_share = 0.15;             ///< of the patches, at an instant
  double neighbours = 0.0;                ///< mean number of further detections of a bright patch
  double patch_std_m = 0.0;               ///< their spread
  double path_half_width_m = 0.0;         ///< nothing lies in the ego vehicle's own path
  [[nodiscard]] bool operator==(const StationaryWorldSpec&) const = default;
};

/// The sensor's own verdicts on a detection.
struct ValiditySpec {
  bool on = false;
  double valid_real = 1.0, valid_false = 1.0;              ///< probability of no invalid flag
  double unambiguous_real = 1.0, unambiguous_false = 1.0;  ///< probability of no ambiguity flag
  double existence_separation = 0.0;  ///< distance of the two normal distributions behind the existence probability
  [[nodiscard]] bool operator==(const ValiditySpec&) const = default;
};

/// Time from the measurement to the last byte of the detection list.
struct LatencySpec {
  double constant_s = 0.02;
  double per_detection_s = 0.0;
  [[nodiscard]] bool operator==(const LatencySpec&) const = default;
};

struct Profile {
  std::string name = "ideal";
  PresenceSpec presence{};
  CountSpec count{};
  SpotSpec spots{};
  MicroDopplerSpec micro_doppler{};
  StrengthSpec strength{};
  MirrorStrengthSpec mirror{};
  FalseMoverSpec false_mover{};
  DopplerAmbiguitySpec doppler_ambiguity{};
  AzimuthAmbiguitySpec azimuth_ambiguity{};
  SideLobeSpec side_lobe{};
  BurstSpec burst{};
  StationaryWorldSpec stationary_world{};
  ValiditySpec validity{};
  LatencySpec latency{};
  [[nodiscard]] bool operator==(const Profile&) const = default;

  /// Whether any effect changes detections; latency changes only their transmission.
  [[nodiscard]] bool changes_detections() const {
    return presence.on || count.on || spots.on || micro_doppler.on || strength.on || mirror.on || false_mover.on ||
           doppler_ambiguity.on || azimuth_ambiguity.on || side_lobe.on || burst.on || stationary_world.on ||
           validity.on;
  }
};

}  // namespace boresight::simulator::radar
