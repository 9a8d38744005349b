// What was detected in the last second, found again.
#include "services/ghost_filter/core/classify/recent_movers.hpp"

#include <utility>

#include <gtest/gtest.h>

#include "interfaces/messages/header.hpp"

namespace boresight::ghosts {
namespace {

using Eigen::Vector2d;
constexpr std::int64_t kStart_ns = 1'000'000'000, kStep_ns = 50'000'000;

/// The `number`-th of many that are all apart.
Mover mover(std::size_t number, std::int64_t time_ns, double rate_mps = 0.0) {
  return {{3.0 * static_cast<double>(number), 0.0}, {1.0, 0.0}, rate_mps, 0.1, 1.0, time_ns, 0, 5.0, 0};
}

}  // namespace

TEST(RecentMovers, WhereThereAreTooManyTheOldestGoAndTheNewScanIsWhole) {
  Odometry odometry;
  RecentMovers movers;
  std::size_t number = 0;
  for (int scan = 0; scan < 12; ++scan) {
    const std::int64_t now_ns = kStart_ns + scan * kStep_ns;
    static_cast<void>(odometry.advance(now_ns, 0.0, 0.0));
    movers.forget(0, 0, odometry);
    const std::size_t earlier = movers.earlier();
    for (std::size_t i = 0; i < kMaxDetections; ++i) movers.add(mover(number++, now_ns), odometry);
    ASSERT_EQ(movers.size(), earlier + kMaxDetections) << "scan " << scan;
  }
  EXPECT_EQ(movers[0].time_ns, kStart_ns + 4 * kStep_ns) << "eight scans fit";
}

TEST(RecentMovers, WhatIsOldIsFoundWhereItMovedToButWeighsNothing) {
  Odometry odometry;
  RecentMovers movers;
  static_cast<void>(odometry.advance(kStart_ns, 0.0, 0.0));
  movers.add(mover(0, kStart_ns, 20.0), odometry);
  static_cast<void>(odometry.advance(kStart_ns + 10 * kStep_ns, 0.0, 0.0));
  const auto found = [&](std::int64_t oldest_source_ns) {
    movers.forget(0, oldest_source_ns, odometry);
    int moved = 0, weighing = 0;
    movers.near(Vector2d(10.0, 0.0), [&](const Mover&, std::uint32_t) { ++moved; });
    movers.visit_weighing([&](const MovedMover&) { ++weighing; });
    return std::pair(moved, weighing);
  };
  EXPECT_EQ(found(kStart_ns), std::pair(1, 1));
  EXPECT_EQ(found(kStart_ns + 1), std::pair(1, 0));
}

}  // namespace boresight::ghosts
