// The moving detections of a simulated drive with the probabilities of several ghost filters, beside the truth.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/ghost_filter/core/config.hpp"
#include "services/ghost_filter/core/evidence/fit.hpp"
#include "services/ghost_filter/core/evidence/weights.hpp"

namespace boresight::bench::ghosts_drives {

/// How a filter gets tracks.
enum class Lane : std::uint8_t {
  kWithout,    ///< none
  kPerfect,    ///< the true objects that radars have detected (true_tracks.hpp)
  kChain,      ///< of the tracker behind the filter
  kPublished,  ///< the published method, in a chain of its own
};
inline constexpr std::size_t kLanes = 4;
inline constexpr std::array<std::string_view, kLanes> kLaneNames = {"without", "perfect", "chain", "published"};

/// A detection that the corrector calls moving.
struct JudgedDetection {
  std::array<float, kLanes> p_moving{};
  float base_rate = 0.0F;  ///< share of real ones among the radar's moving detections of the past (base_rate.hpp)
  float known_s = -1.0F;   ///< since when the object is known; negative: not known, or not real
  Provenance truth = Provenance::kUnknown;
  bool is_real = false;       ///< a direct echo of a moving object, its range rate right or ambiguous
  bool is_ambiguous = false;  ///< … ambiguous
};

struct DriveSpec {
  std::string scenario, profile;
  std::uint64_t seed = 1;
  double longest_s = 25.0;
};

/// The lanes of the method `evidence`: the first ones.
inline constexpr std::size_t kEvidenceLanes = 3;

struct DriveResult {
  std::vector<JudgedDetection> detections;
  /// The same detections with their evidence, by lane, for fits.
  std::array<std::vector<ghosts::LabelledEvidence>, kEvidenceLanes> evidence;
  [[nodiscard]] std::vector<ghosts::LabelledEvidence>& evidence_of(Lane lane) {
    return evidence[static_cast<std::size_t>(lane)];
  }
};

/// Runs the drive through the corrector and all lanes.
[[nodiscard]] DriveResult run_drive(const DriveSpec& spec, const ghosts::Config& config);

}  // namespace boresight::bench::ghosts_drives
