// The moving detections of a simulated drive with the probabilities of several ghost filters, beside the truth.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/boresight/fit_evidence/lanes.hpp"
#include "services/ghost_filter/core/config.hpp"

namespace boresight::bench::ghosts_drives {

/// How a filter gets tracks: the lanes of the method `evidence` first, as for fits.
enum class Lane : std::uint8_t {
  kWithout = static_cast<std::uint8_t>(fit_evidence::Lane::kWithout),
  kPerfect = static_cast<std::uint8_t>(fit_evidence::Lane::kPerfect),
  kChain = static_cast<std::uint8_t>(fit_evidence::Lane::kChain),
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
inline constexpr std::size_t kEvidenceLanes = fit_evidence::kLanes;

struct DriveResult {
  std::vector<JudgedDetection> detections;
  fit_evidence::DriveEvidence evidence;  ///< of the same detections, for fits
};

/// Runs the drive through the corrector and all lanes.
[[nodiscard]] DriveResult run_drive(const DriveSpec& spec, const ghosts::Config& config);

}  // namespace boresight::bench::ghosts_drives
