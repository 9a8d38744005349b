// What the scans of one track tell of its class. One scan of a real radar shows one or two detections of a car, so
// nothing is concluded from a single scan: sums fade with a memory of seconds, and the features are made of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "services/tracker/core/classes/object_forest.hpp"
#include "services/tracker/core/clusters/cluster_features.hpp"

namespace boresight::tracking {

/// The features of a track, in the order of the table of the forest.
enum class ClassFeature : std::uint8_t {
  kCountRate,          ///< detections a scan, relative to those expected of one object at its ranges
  kDetectedShare,      ///< of scans with the object in view, those that show it
  kMostCount,          ///< most detections in one scan, relative as above
  kLength,             ///< m, longest extent along the heading that one scan showed
  kWidth,              ///< m, the same across
  kDepth,              ///< m, the same in range
  kArea,               ///< m², largest area of the box of one scan
  kHeight,             ///< m, highest detection above the road
  kVolume,             ///< m³, largest volume of the box of one scan
  kAlongStd,           ///< m, of the places within a scan, over scans, along the heading
  kAcrossStd,          ///< m, the same across
  kReachAlong,         ///< m, extent of the accumulated places in the track's axes, along
  kReachAcross,        ///< m, the same across
  kStrength,           ///< dB, mean over the radar's level
  kStrongest,          ///< dB, mean of each scan's strongest detection
  kStrengthStd,        ///< dB, of detections about their mean
  kSnr,                ///< dB, mean over the radar's level
  kRangeRateStd,       ///< m/s, of range rates within a scan
  kRangeRateResidual,  ///< m/s, rms of range rates about those of the track's motion
  kWideShare,          ///< of the detections, those with a range rate that is not the body's
  kSpeed,              ///< m/s, mean
  kLargestSpeed,       ///< m/s, that the track reached
  kSpeedStd,           ///< m/s, of its speeds
  kTurnRate,           ///< rad/s, mean magnitude of the change of course
  kRange,              ///< m, mean
  kNearest,            ///< m, smallest range
  kAspect,             ///< 1, mean of |cos| of the angle between heading and line of sight
  kDuration,           ///< s
  kNumber,             ///< of features
};
inline constexpr auto kClassFeatures = static_cast<std::size_t>(ClassFeature::kNumber);
using ClassFeatures = std::array<double, kClassFeatures>;

/// Names of the features in the table of the forest.
[[nodiscard]] std::string_view name_of(ClassFeature feature);

/// One scan of one track. Positions, directions and velocities are in the same axes, which may differ from scan to
/// scan.
struct TrackObservation {
  std::span<const ClusterPoint> points;  ///< of the scan that are the track's; none: not detected
  Vector2<double> position_m;            ///< centre of the track
  Vector2<double> velocity_mps;          ///< over ground
  Symmetric2<double> velocity_covariance_m2ps2;
  double heading_rad = 0.0;
  Vector2<double> sensor_m;
  double in_view = 1.0;    ///< probability that the radar has the object in view and nothing hides it
  double elapsed_s = 0.0;  ///< since the scan before, of any radar
  double yaw_rad = 0.0;    ///< of these axes against those that do not turn: the course is compared across scans
};

class ClassEvidence {
 public:
  /// Does not allocate.
  void add(const TrackObservation& scan, const ClassEvidenceParameters& parameters);
  [[nodiscard]] ClassFeatures features() const;
  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// Detections so far, faded.
  [[nodiscard]] double detections() const { return detections_; }

 private:
  /// Weighted sum of a quantity and its square.
  struct Sums {
    double weight = 0.0, sum = 0.0, squares = 0.0;
    void fade(double keep);
    void add(double value, double by = 1.0);
    [[nodiscard]] double mean() const;
    [[nodiscard]] double std() const;
  };
  /// Sum of squared deviations, each sum with its degrees of freedom.
  struct Scatter {
    double squares = 0.0, freedom = 0.0;
    void fade(double keep);
    void add(const ClusterStatistics& of_scan, double deviation);
    [[nodiscard]] double std() const;
  };
  /// Largest value, which fades to the present one.
  struct Most {
    double value = ClusterPoint::kUnknown;
    void add(double now, double keep);
  };
  void fade(double keep);
  void add_motion(const TrackObservation& scan, const ClassEvidenceParameters& parameters);
  void add_points(const TrackObservation& scan, const ClassEvidenceParameters& parameters, double expected,
                  double keep);

  double duration_s_ = 0.0;
  double scans_ = 0.0, detected_ = 0.0, detections_ = 0.0, expected_ = 0.0;
  Sums speed_, range_, aspect_, strength_, strongest_, snr_, residual_, wide_, turn_;
  Scatter along_, across_, range_rate_;
  Most most_count_, length_, width_, depth_, area_, height_, volume_, largest_speed_;
  Most ahead_, behind_, left_, right_;  // of the track's centre
  double nearest_m_ = ClusterPoint::kUnknown;
  double course_rad_ = 0.0, course_time_s_ = -1.0;  // of the latest scan in motion
};

}  // namespace boresight::tracking
