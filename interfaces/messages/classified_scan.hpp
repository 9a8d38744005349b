// One radar cycle with the provenance of each detection, and the probability of every origin. Provenance is the
// detection's origin: direct echo of a moving or stationary object, multipath ghost, clutter, or an ambiguity.
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
  kClutter = 5,     ///< false detection of another cause: noise, interference
  kAmbiguity = 6,   ///< Doppler or azimuth ambiguity of a real reflection: right echo, wrong range rate or angle
};

/// Every origin that a detection can have, in the order of their probabilities.
inline constexpr std::array kOrigins = {Provenance::kMoving,     Provenance::kStationary, Provenance::kGhostType1,
                                        Provenance::kGhostType2, Provenance::kClutter,    Provenance::kAmbiguity};
inline constexpr std::size_t kNumberOfOrigins = 6;
static_assert(kOrigins.size() == kNumberOfOrigins);
/// With kUnknown.
inline constexpr std::size_t kNumberOfProvenances = kNumberOfOrigins + 1;

/// Index of an origin, which is not kUnknown, in `kOrigins` and in all arrays of probabilities.
[[nodiscard]] constexpr std::size_t index_of_origin(Provenance origin) {
  return static_cast<std::size_t>(origin) - 1;
}

/// Probabilities of the origins of one detection, 0…1, in the order of `kOrigins`.
using OriginProbabilities = std::array<float, kNumberOfOrigins>;

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
  static constexpr std::uint32_t kVersion = 4;
  /// Log-likelihood ratio of a certain origin: beyond what any evidence reaches.
  static constexpr float kCertain = 20.0F;

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
  DetectionColumn<float> snr_db;
  DetectionColumn<float> range_std_m;
  DetectionColumn<float> azimuth_std_rad;
  DetectionColumn<float> range_rate_std_mps;
  /// By index_of_origin(), 0…1. They sum to 1 for each classified detection, and are all 0 for an unclassified one.
  std::array<DetectionColumn<float>, kNumberOfOrigins> origin_probability;
  /// ln p(evidence | direct echo of a moving object) / p(evidence | false). A track at the detection's own place is not
  /// part of this evidence: a tracker that used the probabilities would confirm its own tracks. Tracks enter by the
  /// mirror images that they make expected. 0 for a detection without evidence.
  DetectionColumn<float> moving_log_likelihood_ratio;
  DetectionColumn<std::uint16_t> detection_flags;
  DetectionColumn<Provenance> provenance;  ///< one label by the ghost filter's rule, for displays and statistics
  std::array<ReflectorSegment, kMaxReflectorSegments> reflector_segments;

  /// Probability of an origin, which is not kUnknown, of detection i.
  [[nodiscard]] float& probability(Provenance origin, std::size_t i) {
    return origin_probability[index_of_origin(origin)][i];
  }
  [[nodiscard]] float probability(Provenance origin, std::size_t i) const {
    return origin_probability[index_of_origin(origin)][i];
  }
  /// Probability that a detection is no direct reflection at its true range rate and angle: 1 − moving − stationary,
  /// as the sum of the other origins, which rounds less. 0 for an unclassified detection.
  [[nodiscard]] float ghost_probability(std::size_t i) const {
    return probability(Provenance::kGhostType1, i) + probability(Provenance::kGhostType2, i) +
           probability(Provenance::kClutter, i) + probability(Provenance::kAmbiguity, i);
  }
  void set_probabilities(std::size_t i, const OriginProbabilities& probabilities) {
    for (std::size_t k = 0; k < kNumberOfOrigins; ++k) origin_probability[k][i] = probabilities[k];
  }
  /// Label, probability 1 and a certain ratio for one origin; kUnknown: unclassified.
  void set_certain(std::size_t i, Provenance origin) {
    provenance[i] = origin;
    set_probabilities(i, {});
    if (origin != Provenance::kUnknown) probability(origin, i) = 1.0F;
    moving_log_likelihood_ratio[i] = origin == Provenance::kUnknown  ? 0.0F
                                     : origin == Provenance::kMoving ? kCertain
                                                                     : -kCertain;
  }
};

static_assert(kIsPlainMessage<ClassifiedScan>);
static_assert(alignof(ClassifiedScan) == 64);
static_assert(offsetof(ClassifiedScan, x_vehicle_m) == 256);
static_assert(offsetof(ClassifiedScan, origin_probability) == 256 + 11 * 4096);
static_assert(sizeof(ClassifiedScan) ==
              256 + (12 + kNumberOfOrigins) * 4096 + 2048 + 1024 + kMaxReflectorSegments * 24);

}  // namespace boresight
