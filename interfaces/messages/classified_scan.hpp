// One radar cycle with the provenance of each detection. Provenance is the detection's origin: direct echo of a moving
// or stationary object, multipath ghost, or clutter.
#pragma once

#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/header.hpp"

namespace boresight {

/// Origin of a detection (Le Ba Thanh 2023, §2). A ghost is an echo that reached the radar over a reflector; its
/// bounces are the reflections on the propagation path.
enum class Provenance : std::uint8_t {
  kUnknown = 0,     ///< not classified: rejected earlier, or no ego motion
  kMoving = 1,      ///< direct reflection of a moving object
  kStationary = 2,  ///< direct reflection of a stationary object
  kGhostType1 = 3,  ///< last bounce on the target: in the target's direction, but farther away
  kGhostType2 = 4,  ///< last bounce on a reflector: mirrored behind the reflector
  kClutter = 5,
};

/// A straight segment of a stationary reflector (guard rail, wall) in the vehicle frame's x-y plane.
struct ReflectorSegment {
  std::array<float, 2> start_vehicle_m;
  std::array<float, 2> end_vehicle_m;
  float residual_std_m;  ///< scatter of its detections across the line
  std::uint32_t number_of_detections;
};
static_assert(sizeof(ReflectorSegment) == 24);

inline constexpr std::size_t kMaxReflectorSegments = 64;

/// Detections of one radar cycle, classified; same order as in the CorrectedScan. Detections that the corrector
/// rejected (`corrected_flag::kRejected`) have `kUnknown` provenance.
struct ClassifiedScan {
  static constexpr std::uint32_t kVersion = 1;

  MessageHeader header;
  std::uint32_t number_of_valid_detections;
  std::uint32_t number_of_reflector_segments;
  std::uint32_t fields;  ///< scan_field bits
  std::uint32_t flags;   ///< pipeline_flag bits
  ScanGeometry geometry;
  std::array<std::uint8_t, 56> reserved;

  DetectionColumn<float> x_vehicle_m;
  DetectionColumn<float> y_vehicle_m;
  DetectionColumn<float> z_vehicle_m;
  DetectionColumn<float> range_m;
  DetectionColumn<float> azimuth_vehicle_rad;
  DetectionColumn<float> range_rate_over_ground_mps;
  DetectionColumn<float> rcs_dbsm;
  DetectionColumn<float> range_std_m;
  DetectionColumn<float> azimuth_std_rad;
  DetectionColumn<float> range_rate_std_mps;
  DetectionColumn<float> ghost_probability;  ///< 0…1
  DetectionColumn<std::uint16_t> detection_flags;
  DetectionColumn<Provenance> provenance;
  std::array<ReflectorSegment, kMaxReflectorSegments> reflector_segments;
};

static_assert(kIsPlainMessage<ClassifiedScan>);
static_assert(alignof(ClassifiedScan) == 64);
static_assert(offsetof(ClassifiedScan, x_vehicle_m) == 256);
static_assert(sizeof(ClassifiedScan) == 256 + 11 * 4096 + 2048 + 1024 + kMaxReflectorSegments * 24);

}  // namespace boresight
