// Random draws of the statistical effects. They depend on seed, radar, thing and cycle only, never on earlier calls.
#pragma once

#include <cstdint>
#include <string_view>

#include "services/simulator/radar/key.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator::radar {

struct Draws {
  std::uint64_t seed;
  std::uint32_t radar, cycle;

  /// A stream that is new in each cycle.
  [[nodiscard]] Stream once(std::string_view effect, std::uint64_t thing = 0) const { return once(of(effect), thing); }
  [[nodiscard]] Stream once(const StreamSeed& effect, std::uint64_t thing) const {
    return {effect, cycle_key(radar, cycle), thing};
  }
  /// What the streams of an effect have in common, for loops.
  [[nodiscard]] StreamSeed of(std::string_view effect) const { return {seed, effect}; }
  /// A stream that stays the same for the whole drive.
  [[nodiscard]] Stream always(std::string_view effect, std::uint64_t thing = 0) const {
    return {seed, effect, radar, thing};
  }
  /// A stream that is renewed in each cycle with probability 1 − `keep`. What is drawn from it keeps its distribution,
  /// and its correlation over n cycles is keepⁿ. The cycle of the last renewal is found backwards, so there is no
  /// state.
  [[nodiscard]] Stream held(std::string_view effect, std::uint64_t thing, double keep) const {
    return held(of(effect), thing, keep);
  }
  [[nodiscard]] Stream held(const StreamSeed& effect, std::uint64_t thing, double keep) const {
    constexpr std::uint64_t kOldest = 400;  // cycles; 0.97⁴⁰⁰ = 5e-6
    const std::uint64_t key = key_of(radar, thing);
    for (std::uint64_t age = 0; age < kOldest; ++age) {
      Stream stream(effect, key, kBefore + cycle - age);
      if (stream.uniform() >= keep) return stream;
    }
    return {effect, key, kBefore + cycle - kOldest};
  }

  /// Cycles before the drive: what is held in cycle 0 may have been drawn before.
  static constexpr std::uint64_t kBefore = 1000;
};

}  // namespace boresight::simulator::radar
