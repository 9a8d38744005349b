// Both methods of the ghost filter on the same simulated drives, in the closed loop with the tracker, by the truth of
// each detection.
#include <array>
#include <chrono>

#include <gtest/gtest.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/closed_loop/chain.hpp"

namespace boresight::closed_loop {
namespace {

constexpr std::size_t kClasses = 6;
constexpr std::array<const char*, kClasses> kNames{"unknown", "moving", "stationary", "type 1", "type 2", "clutter"};

/// Detections by truth (row) and verdict (column).
struct Confusion {
  std::array<std::array<std::size_t, kClasses>, kClasses> counts{};
  double mean_us = 0.0;

  [[nodiscard]] double share(Provenance truth, std::initializer_list<Provenance> verdicts) const {
    const auto& row = counts[static_cast<std::size_t>(truth)];
    std::size_t all = 0, chosen = 0;
    for (std::size_t k = 1; k < kClasses; ++k) all += row[k];  // what was rejected before is not judged
    for (const Provenance v : verdicts) chosen += row[static_cast<std::size_t>(v)];
    return all == 0 ? 1.0 : static_cast<double>(chosen) / static_cast<double>(all);
  }
  void print(const char* what) const {
    std::printf("%s (%.0f µs a scan)\n%12s %8s", what, mean_us, "truth", "count");
    for (std::size_t k = 1; k < kClasses; ++k) std::printf(" %10s", kNames[k]);
    std::printf("\n");
    for (std::size_t t = 1; t < kClasses; ++t) {
      std::size_t all = 0;
      for (std::size_t k = 1; k < kClasses; ++k) all += counts[t][k];
      std::printf("%12s %8zu", kNames[t], all);
      for (std::size_t k = 1; k < kClasses; ++k) {
        std::printf(" %9.2f%%", all == 0 ? 0.0 : 100.0 * static_cast<double>(counts[t][k]) / static_cast<double>(all));
      }
      std::printf("\n");
    }
  }
};

Confusion judge(const char* scenario, ghosts::MethodName method, std::uint64_t seed, double duration_s) {
  const VehicleConfig vehicle =
      config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
  simulator::Drive drive(simulator::scenario(scenario), vehicle, seed, duration_s);
  ghosts::Config config;
  config.method = method;
  Chain chain(vehicle, config);
  Confusion confusion;
  std::size_t scans = 0;
  while (const simulator::Event* event = drive.next()) {
    if (!chain.take(*event)) continue;
    ++scans;
    confusion.mean_us += chain.ghost_filter_us;
    if (event->t_s < 2.0) continue;
    for (std::size_t i = 0; i < event->truth->size(); ++i) {
      const auto truth = static_cast<std::size_t>((*event->truth)[i].provenance);
      ++confusion.counts[truth][static_cast<std::size_t>(chain.classified->provenance[i])];
    }
  }
  confusion.mean_us /= static_cast<double>(scans);
  return confusion;
}

class Ghosts : public testing::TestWithParam<const char*> {};

TEST_P(Ghosts, MirrorConsistencyTellsMoreThanThePublishedTests) {
  const Confusion published = judge(GetParam(), ghosts::MethodName::kPublished, 1, 20.0);
  const Confusion mirror = judge(GetParam(), ghosts::MethodName::kMirror, 1, 20.0);
  std::printf("%s\n", GetParam());
  published.print("published");
  mirror.print("mirror");
  const auto ghosts = {Provenance::kGhostType1, Provenance::kGhostType2};
  EXPECT_GE(mirror.share(Provenance::kMoving, {Provenance::kMoving}), 0.97);
  EXPECT_GE(mirror.share(Provenance::kStationary, {Provenance::kStationary}), 0.99);
  EXPECT_GE(mirror.share(Provenance::kGhostType2, ghosts), 0.9);
  // The simulator's type-1 ghosts are not exact on a winding road, and few.
  EXPECT_GT(mirror.share(Provenance::kGhostType1, ghosts), published.share(Provenance::kGhostType1, ghosts));
  EXPECT_LE(mirror.share(Provenance::kClutter, {Provenance::kMoving}), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Ghosts, testing::Values("demo_drive", "aligned_drive", "straight_rail"));

}  // namespace
}  // namespace boresight::closed_loop
