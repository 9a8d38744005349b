// One radar cycle in the vehicle frame, corrected for mounting and mounting error, with ego motion compensated.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

/// Bits of `CorrectedScan::flags` and `ClassifiedScan::flags`: inputs that a stage lacked. Each stage adds its own.
namespace pipeline_flag {
inline constexpr std::uint32_t kNoAlignment = 1u << 0;     ///< no alignment estimate: nominal mounting, k_v = 1
inline constexpr std::uint32_t kAlignmentStale = 1u << 1;  ///< the estimate is older than its topic's deadline
inline constexpr std::uint32_t kNoEgoMotion = 1u << 2;     ///< no ego motion: range rates are not compensated
inline constexpr std::uint32_t kEgoMotionStale = 1u << 3;  ///< the last ego motion is older than its deadline
inline constexpr std::uint32_t kNoElevation = 1u << 4;  ///< the sensor measures no elevation: z is the sensor's height
inline constexpr std::uint32_t kNoTracks = 1u << 5;     ///< the ghost filter had no tracks: no mirror images of them
inline constexpr std::uint32_t kTracksStale = 1u << 6;  ///< the ghost filter's tracks were older than their deadline
/// Earlier scans of this radar were dropped: they waited for a stage when this scan arrived.
inline constexpr std::uint32_t kScansDropped = 1u << 7;
/// The radar's data are proven wrong: all detections are rejected, and the scan is no evidence of empty space either.
inline constexpr std::uint32_t kDistrusted = 1u << 8;
}  // namespace pipeline_flag

/// Bits of `CorrectedScan::detection_flags`, per detection.
namespace corrected_flag {
inline constexpr std::uint16_t kInvalid = 1u << 0;        ///< a needed value is not finite or not usable
inline constexpr std::uint16_t kAmbiguous = 1u << 1;      ///< carried over: the sensor doubts the range rate
inline constexpr std::uint16_t kOutsideRegion = 1u << 2;  ///< outside the region-of-interest box
inline constexpr std::uint16_t kWeak = 1u << 3;           ///< under the range-dependent RCS threshold
inline constexpr std::uint16_t kMoving = 1u << 4;         ///< no bit of motion if the ego motion is unknown
inline constexpr std::uint16_t kStationary = 1u << 5;
inline constexpr std::uint16_t kDoubted = 1u << 6;  ///< carried over: the sensor calls the detection invalid
/// Rejected: the following stages ignore a detection with any of these bits.
inline constexpr std::uint16_t kRejected = kInvalid | kOutsideRegion | kWeak;
}  // namespace corrected_flag

/// The sensor and the vehicle at `measurement_time_ns`, as used for the correction.
struct ScanGeometry {
  std::array<float, 3> sensor_position_vehicle_m;
  std::array<float, 3> sensor_velocity_vehicle_mps;  ///< over ground, in vehicle axes, with k_v applied
  /// Row-major R(sensor→vehicle), mounting plus correction.
  std::array<float, 9> sensor_to_vehicle;
  float speed_scale;    ///< k_v: true / signalled speed
  float ego_speed_mps;  ///< k_v applied; 0 with kNoEgoMotion
  float ego_speed_std_mps;
  float ego_yaw_rate_radps;
  float ego_yaw_rate_std_radps;
};
static_assert(sizeof(ScanGeometry) == 80);

/// Detections of one radar cycle in the vehicle frame (ISO 8855: origin rear axle on the ground, x forward, y left,
/// z up). Index i is the same detection as index i of the RadarScan with the same source and source_sequence.
struct CorrectedScan {
  static constexpr std::uint32_t kVersion = 1;

  MessageHeader header;
  std::uint32_t number_of_valid_detections;
  std::uint32_t fields;              ///< scan_field bits of the RadarScan
  std::uint32_t flags;               ///< pipeline_flag bits
  std::uint32_t cycle_counter;       ///< of the RadarScan
  std::uint64_t alignment_sequence;  ///< header.sequence of the used estimate; 0 if none
  ScanGeometry geometry;
  /// Covariance of the rotation error of `geometry.sensor_to_vehicle` about the vehicle's axes: xx, xy, xz, yy, yz, zz
  /// in rad². The error is common to all detections of the radar, in addition to their own standard deviations.
  std::array<float, 6> mounting_covariance;
  /// Standard deviation of `geometry.speed_scale` as the radar's range rates over ground contain it: without that of
  /// the radar's own scale of range rates.
  float speed_scale_std;
  std::array<std::uint32_t, 4> reserved;

  DetectionColumn<float> x_vehicle_m;
  DetectionColumn<float> y_vehicle_m;
  DetectionColumn<float> z_vehicle_m;
  DetectionColumn<float> range_m;
  DetectionColumn<float> azimuth_vehicle_rad;    ///< direction of the line of sight in vehicle axes
  DetectionColumn<float> elevation_vehicle_rad;  ///< direction of the line of sight in vehicle axes
  DetectionColumn<float> range_rate_mps;         ///< as measured, divided by the radar's own scale of range rates
  /// Range rate over ground: measured range rate minus that of a stationary reflector in the same direction.
  DetectionColumn<float> range_rate_over_ground_mps;
  DetectionColumn<float> rcs_dbsm;
  DetectionColumn<float> snr_db;
  DetectionColumn<float> range_std_m;
  DetectionColumn<float> azimuth_std_rad;
  DetectionColumn<float> elevation_std_rad;
  DetectionColumn<float> range_rate_std_mps;  ///< as stated by the radar × its learnt ratio of actual to stated
  DetectionColumn<float> existence_probability;
  DetectionColumn<std::uint16_t> detection_flags;  ///< corrected_flag bits
};

static_assert(kIsPlainMessage<CorrectedScan>);
static_assert(alignof(CorrectedScan) == 64);
static_assert(offsetof(CorrectedScan, x_vehicle_m) == 256);
static_assert(sizeof(CorrectedScan) == 256 + 15 * 4096 + 2048);

}  // namespace boresight
