// Drives with what real cars add to the model: each effect alone, and all together. Sizes are those that were measured
// or are plausible (config/schema/scenario.md); where a span is known, each drive draws its size from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "services/simulator/alignment/spec.hpp"
#include "tests/benchmarks/common/options.hpp"

namespace boresight::bench {

/// All effects of the preset `real_car` but load, with body pitch as in disturbed_drive(). Load has drives of its own.
[[nodiscard]] simulator::AlignmentSpec real_car_drive(simulator::RoadKind road, double duration_s, std::uint64_t seed);

/// Mixed, city and motorway roads in turn.
inline constexpr std::size_t kRoadsInTurn = 3;
[[nodiscard]] simulator::RoadKind road_in_turn(std::size_t drive);

/// Time of a sudden change, of the seed: 60…120 s after the first message.
[[nodiscard]] double draw_change_s(std::uint64_t seed);

struct RealCarKind {
  std::string name;
  void (*add)(simulator::AlignmentSpec& spec);  ///< its effect; sizes are of the spec's seed
  bool is_whole_car = false;                    ///< bars of yaw and pitch rms apply
  bool covers = true;                           ///< bar of 95 % intervals applies
  bool is_compared = true;                      ///< with the published methods
};
[[nodiscard]] const std::vector<RealCarKind>& real_car_kinds();

/// Drives of a kind, with roads in turn.
[[nodiscard]] std::vector<simulator::AlignmentSpec> drives_of(const RealCarKind& kind, std::size_t drives,
                                                              double duration_s, std::uint64_t first_seed);

/// Groups with fresh seeds have ranges of their own, so that no two of them use the same drive.
enum class FreshSeeds : std::uint64_t { kKinds, kDrift, kNoChange, kChanges, kLoad };
/// Kinds of drive have as many seeds of their own each.
inline constexpr std::uint64_t kSeedsOfAKind = 1000;
[[nodiscard]] std::uint64_t first_seed_of(FreshSeeds group, const Options& options);
/// "12 drives of 180 s, seeds from 7000000 on"
[[nodiscard]] std::string drives_text(std::size_t drives, double duration_s, std::uint64_t first_seed);

}  // namespace boresight::bench
