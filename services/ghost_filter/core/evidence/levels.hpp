// The kinds of evidence of a detection, each reduced to one of a few levels. A level has a weight (weights.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace boresight::ghosts {

enum class EvidenceKind : std::uint8_t {
  kPast,     ///< earlier scans with a detection where this one would have been
  kCompany,  ///< detections of the scan beside it
  kRing,     ///< share of its own place among all detections of its range and range rate
  kRange,
  kWideRing,    ///< detections of nearly its range and range rate at other azimuths
  kBurst,       ///< moving detections of the scan
  kVerdict,     ///< the sensor's flags: invalid, ambiguous
  kExistence,   ///< the sensor's probability of existence
  kImageType1,  ///< share of type-1 mirror images in what the tracks let expect at its place and range rate
  kImageType2,  ///< the same of type-2 mirror images
};
inline constexpr std::size_t kEvidences = 10;
inline constexpr std::size_t kScanEvidences = 8;  ///< the first ones, which need no tracks
inline constexpr std::size_t kMostLevels = 6;

/// Name in a radar profile, and number of levels. The lowest level of the existence is: not stated.
struct EvidenceSpec {
  std::string_view key;
  std::size_t levels;
};
inline constexpr std::array<EvidenceSpec, kEvidences> kEvidenceSpecs = {{{"past", 6},
                                                                         {"company", 4},
                                                                         {"ring", 4},
                                                                         {"range", 4},
                                                                         {"wide_ring", 4},
                                                                         {"burst", 4},
                                                                         {"verdict", 4},
                                                                         {"existence", 5},
                                                                         {"image_type_1", 6},
                                                                         {"image_type_2", 6}}};

/// Levels of the expected intensity of known objects at a detection.
inline constexpr std::size_t kTrackLevels = 5;

/// The evidence of one detection.
struct Levels {
  std::array<std::uint8_t, kEvidences> of{};
  std::uint8_t track = 0;
  float sure = 0.0F;        ///< 0…1: how surely the object of `track` exists
  bool has_tracks = false;  ///< tracks were known; otherwise `track` says nothing
};

/// The same of one detection of a scan.
struct JudgedEvidence {
  std::uint32_t index = 0;
  Levels levels;
};

}  // namespace boresight::ghosts
