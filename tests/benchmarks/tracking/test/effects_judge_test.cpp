// Figures of recordings without truth, on hand-made lists.
#include <cmath>
#include <limits>

#include "tests/benchmarks/tracking/effects/judge/observed_list.hpp"
#include "tests/benchmarks/tracking/test/drives_scenes.hpp"

namespace boresight::bench::tracking {
namespace {

using made::track;

constexpr Rule kLikelyRule{0.5F, false};

TEST(EffectsJudge, DelayCountsFromTheFirstDetectionToTheFirstTrackAtTheObject) {
  const std::vector<ObservedList> lists = {{0.0, {track(1, 20.0, 0.0, 0.9)}, {}},
                                           {0.1, {}, {{20.0, 0.0}}},
                                           {0.2, {track(2, 60.0, 0.0, 0.9)}, {{20.0, 0.0}}},
                                           {0.3, {track(3, 20.0, 1.0, 0.4)}, {{20.0, 0.0}}},
                                           {0.4, {track(3, 20.0, 1.0, 0.6)}, {{20.0, 0.0}}}};
  EXPECT_NEAR(delay_s(lists, kLikelyRule), 0.3, 1e-9);
  EXPECT_NEAR(delay_s(lists, Rule{0.4F, false}), 0.2, 1e-9);
  EXPECT_TRUE(std::isinf(delay_s(lists, Rule{0.95F, false})));
  EXPECT_TRUE(std::isinf(delay_s({}, kLikelyRule)));
  EXPECT_TRUE(std::isinf(delay_s({{0.0, {track(1, 20.0, 0.0, 0.9)}, {}}}, kLikelyRule))) << "nothing moves";
}

TEST(EffectsJudge, TimesWithASecondTrackAddUp) {
  const ListedTrack truck = track(1, 60.0, 0.0, 1.0), beside = track(2, 60.0, 6.0, 0.6),
                    weak = track(3, 60.0, 9.0, 0.1);
  const std::vector<ObservedList> lists = {{0.0, {truck, weak}, {}},         {0.1, {truck, beside}, {}},
                                           {0.2, {truck, beside, weak}, {}}, {0.3, {truck}, {}},
                                           {0.4, {truck, beside}, {}},       {0.5, {truck}, {}}};
  const SecondTracks second = second_tracks(lists, kLikelyRule);
  EXPECT_NEAR(second.total_s, 0.3, 1e-9);
  EXPECT_NEAR(second.longest_s, 0.2, 1e-9);
  EXPECT_NEAR(second_tracks(lists, Rule{0.9F, false}).total_s, 0.0, 1e-9);
}

TEST(EffectsJudge, ShareOfListsCountsFromTheFirstDetectionOn) {
  const std::vector<ObservedList> lists = {
      {0.0, {}, {}}, {0.1, {}, {{20.0, 0.0}}}, {0.2, {track(1, 20.0, 0.0, 0.9)}, {}}};
  EXPECT_NEAR(tracked_percent(lists, kLikelyRule), 50.0, 1e-9);
  EXPECT_TRUE(std::isnan(tracked_percent({}, kLikelyRule)));
}

}  // namespace
}  // namespace boresight::bench::tracking
