// Keys of random draws. A target or path has the same key whatever else is in the scene.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace boresight::simulator::radar {

[[nodiscard]] inline std::uint64_t key_of(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a * 0x9E3779B97F4A7C15ull + b + 0x632BE59BD9B4E019ull;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  return z ^ (z >> 27);
}

/// Key of a stationary reflector: its place, rounded to a millimetre, since its index changes from scene to scene.
[[nodiscard]] inline std::uint64_t key_of(const Eigen::Vector3d& place_m) {
  std::uint64_t key = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    key = key_of(key, static_cast<std::uint64_t>(std::llround(place_m(i) * 1000.0)));
  }
  return key;
}

/// Key of all random draws of one radar in one cycle.
[[nodiscard]] inline std::uint64_t cycle_key(std::uint32_t radar, std::uint32_t cycle) {
  return (static_cast<std::uint64_t>(radar) << 32) | cycle;
}

}  // namespace boresight::simulator::radar
