// The moving detections of a simulated drive with the probabilities of several ghost filters, beside the truth.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/ghost_filter/core/evidence/fit.hpp"
#include "services/ghost_filter/core/evidence/weights.hpp"
#include "services/ghost_filter/core/config.hpp"

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
  float base_rate = 0.0F;      ///< share of real ones among the radar's moving detections of the past (base_rate.hpp)
  float known_s = -1.0F;       ///< since when the object is known; negative: not known, or not real
  bool is_real = false;        ///< a direct echo of a moving object, its range rate right or ambiguous
  bool is_ambiguous = false;   ///< … ambiguous
};

struct DriveSpec {
  std::string scenario, profile;
  std::uint64_t seed = 1;
  double longest_s = 25.0;
};

/// With the evidence of the lanes kWithout, kPerfect and kChain, for fits.
struct DriveResult {
  std::vector<JudgedDetection> detections;
  std::vector<ghosts::LabelledEvidence> evidence;
};

/// Runs the drive through the corrector and all lanes.
[[nodiscard]] DriveResult run_drive(const DriveSpec& spec, const ghosts::Config& config);

}  // namespace boresight::bench::ghosts_drives
