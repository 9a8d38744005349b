// The whole filter on simulated drives with known truth.
#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/filter/bench.hpp"

namespace boresight::alignment {
namespace {

simulator::AlignmentSpec drive(std::uint64_t seed, double duration_s) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.seed = seed;
  spec.duration_s = duration_s;
  return spec;
}

TEST(RobustFilter, FindsFourCornerRadars) {
  Bench bench(drive(11, 60.0));
  bench.run(60.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const RadarEstimate estimate = bench.filter->estimate(r);
    const Eigen::Vector3d error = bench.error_rad(r) / kDegree;
    EXPECT_EQ(estimate.state, AlignmentState::kConverged) << r;
    EXPECT_NEAR(estimate.speed_scale, 1.01, 2e-4) << r;
    EXPECT_LT(std::abs(error.z()), 0.02) << r;
    EXPECT_LT(std::abs(error.y()), 0.1) << r;
    EXPECT_EQ(estimate.knock.count, 0u) << r;
  }
}

TEST(RobustFilter, AllocatesNothingWhileDriving) {
  Bench bench(drive(12, 6.0));
  bench.run(6.0, [&](const simulator::AlignmentEvent& event) {
    const std::uint64_t before = runtime::counted_allocations();
    {
      const runtime::CountAllocations counting;
      bench.filter->process(event.radar, *bench.scan, bench.ego);
      static_cast<void>(bench.filter->estimate(event.radar));
    }
    ASSERT_EQ(runtime::counted_allocations(), before);
  });
}

}  // namespace
}  // namespace boresight::alignment
