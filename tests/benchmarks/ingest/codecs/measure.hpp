// Measures the decoding of all kinds of input in the same way, in relation to two references: copying the same frames,
// and converting every four bytes of them from network to host order.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "services/common/recording/frame.hpp"
#include "services/common/someip/big_endian.hpp"

namespace boresight::bench {

using Frames = std::span<const recording::Frame>;
using Clock = std::chrono::steady_clock;

inline double ns_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

inline void copy(Frames frames) {
  alignas(64) static std::array<std::uint8_t, 65536> to;
  for (const recording::Frame& frame : frames) {
    recording::Frame header = frame;
    benchmark::DoNotOptimize(header);
    std::memcpy(to.data(), frame.payload.data(), std::min(frame.payload.size(), to.size()));
    benchmark::ClobberMemory();
  }
}

inline void swap_words(Frames frames) {
  alignas(64) static std::array<float, 16384> to;
  for (const recording::Frame& frame : frames) {
    const std::size_t words = std::min(frame.payload.size() / 4, to.size());
    for (std::size_t i = 0; i < words; ++i) to[i] = boresight::read_f32(frame.payload.data() + 4 * i);
    benchmark::ClobberMemory();
  }
}

inline double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// ns per call.
template <typename Reference>
double reference_ns(Reference&& reference) {
  constexpr int kRounds = 50, kCalls = 20;
  std::vector<double> rounds_ns;
  for (int round = 0; round < kRounds; ++round) {
    const auto begin = Clock::now();
    for (int call = 0; call < kCalls; ++call) reference();
    rounds_ns.push_back(ns_since(begin) / kCalls);
  }
  return median(rounds_ns);
}

/// Measures `take()`, once after each unmeasured `prepare()`; `frames` are the input of take(). Reports the ns per
/// item, for `items` items per iteration (the benchmark's name states their kind), and two ratios of the time. These
/// figures use the median iteration, which other load on the machine hardly affects; Google Benchmark's own columns use
/// the mean.
template <typename Prepare, typename Take>
void measure(benchmark::State& state, double items, Frames frames, Prepare&& prepare, Take&& take) {
  std::vector<double> each_ns;
  for ([[maybe_unused]] auto iteration : state) {
    prepare();
    const auto begin = Clock::now();
    take();
    const double ns = ns_since(begin);
    each_ns.push_back(ns);
    state.SetIterationTime(ns * 1e-9);
  }
  const double typical_ns = median(each_ns);
  state.counters["ns/item"] = typical_ns / items;
  state.counters["x_copy"] = typical_ns / reference_ns([&] { copy(frames); });
  state.counters["x_bswap"] = typical_ns / reference_ns([&] { swap_words(frames); });
}

}  // namespace boresight::bench
