// Truth of one simulated detection.
#pragma once

#include <cstdint>
#include <string_view>

#include "interfaces/messages/classified_scan.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator {

/// Why a detection is false, or deviates from its object. kNone: neither, or thermal clutter.
enum class Cause : std::uint8_t {
  kNone,
  kDopplerAmbiguity,  ///< the range rate was resolved wrongly; the place is right
  kAzimuthAmbiguity,  ///< the azimuth was resolved wrongly
  kSideLobe,          ///< an antenna side lobe of a moving object
  kBurst,             ///< azimuth smear that lasts for seconds
  kFalseMover,        ///< a moving detection without an object
  kInterference,      ///< by another radar
  kMicroDoppler,      ///< a turning or swinging part of a moving object
  kRoadMirror,        ///< the road as a mirror changes the apparent elevation
};

/// Word of a cause in truth_detections.csv.
[[nodiscard]] constexpr std::string_view cause_word(Cause cause) {
  switch (cause) {
    case Cause::kNone:
      return "none";
    case Cause::kDopplerAmbiguity:
      return "doppler_ambiguity";
    case Cause::kAzimuthAmbiguity:
      return "azimuth_ambiguity";
    case Cause::kSideLobe:
      return "side_lobe";
    case Cause::kBurst:
      return "burst";
    case Cause::kFalseMover:
      return "false_mover";
    case Cause::kInterference:
      return "interference";
    case Cause::kMicroDoppler:
      return "micro_doppler";
    case Cause::kRoadMirror:
      return "road_mirror";
  }
  return "none";
}

struct DetectionTruth {
  Provenance provenance = Provenance::kUnknown;
  std::uint32_t object_id =
      0;                     ///< Body::id of the target, also for its ghosts; 0 for structures, scatterers and clutter
  Origin origin{};           ///< for structures and scatterers
  std::uint8_t bounces = 0;  ///< reflections from mirrors; 0: direct
  std::uint32_t mirror_body = 0;  ///< Body::id whose side mirrored; 0: a structure, or none
  Cause cause = Cause::kNone;
};

}  // namespace boresight::simulator
