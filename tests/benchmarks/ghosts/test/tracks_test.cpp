// What counts as a lost object.
#include <memory>

#include <gtest/gtest.h>

#include "tests/benchmarks/ghosts/common/lost_objects.hpp"

namespace boresight::bench {
namespace {

using closed_loop::Object;

TEST(Tracks, AnObjectIsLostWhenOnlyPerfectLabelsHaveIt) {
  const std::vector<Object> objects = {{1, {20.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8},
                                       {2, {60.0, 0.0}, {0.0, 0.0}, 0.0, 4.5, 1.8}};
  // Never the second car, and the first in `share` of ten scans.
  const auto second_with = [&objects](int share) {
    const auto tracks = std::make_unique<TrackList>();
    tracks->tracks[0].position_vehicle_m = {20.0F, 0.0F, 0.0F};
    TrackedObjects tracked;
    for (int scan = 0; scan < 10; ++scan) tracked.add(match(*tracks, scan < share ? 1 : 0, objects), objects);
    return tracked;
  };
  LostObjects lost;
  lost.add_second(1.0, second_with(10), second_with(4));
  // The second car has no track with perfect labels either.
  EXPECT_EQ(lost.object_seconds, 1u);
  EXPECT_EQ(lost.lost.size(), 1u);
  lost.add_second(1.0, second_with(10), second_with(10));
  EXPECT_EQ(lost.object_seconds, 2u);
  EXPECT_EQ(lost.lost.size(), 1u);
}

}  // namespace
}  // namespace boresight::bench
