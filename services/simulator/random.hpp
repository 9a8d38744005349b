// Random numbers. Each effect has a stream of its own, so that adding one effect changes no draw of another.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

namespace boresight::simulator {

/// What the streams of an effect have in common: made once, it saves the time of the effect's name.
class StreamSeed {
 public:
  StreamSeed(std::uint64_t seed, std::string_view effect) {
    state_ = mix(seed ^ 0x9E3779B97F4A7C15ull);
    for (const char c : effect) state_ = mix(state_ ^ static_cast<unsigned char>(c));
  }
  [[nodiscard]] StreamSeed with(std::uint64_t index) const {
    StreamSeed next = *this;
    next.state_ = mix(state_ ^ index);
    return next;
  }
  [[nodiscard]] std::uint64_t state() const { return state_; }

  [[nodiscard]] static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

/// splitmix64, seeded by the run's seed, the effect's name and up to two indices.
class Stream {
 public:
  Stream(std::uint64_t seed, std::string_view effect, std::uint64_t index = 0, std::uint64_t sub_index = 0)
      : Stream(StreamSeed(seed, effect), index, sub_index) {}
  Stream(const StreamSeed& effect, std::uint64_t index, std::uint64_t sub_index)
      : state_(effect.with(index).with(sub_index).state()) {}
  [[nodiscard]] std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ull;
    return StreamSeed::mix(state_);
  }
  /// In [0, 1).
  [[nodiscard]] double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box–Muller). The second value is dropped, so that every call uses two draws.
  [[nodiscard]] double gaussian() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * M_PI * uniform());
  }
  [[nodiscard]] unsigned poisson(double mean) {
    const double limit = std::exp(-mean);
    unsigned count = 0;
    for (double product = uniform(); product > limit; product *= uniform()) ++count;
    return count;
  }

 private:
  std::uint64_t state_;
};

}  // namespace boresight::simulator
