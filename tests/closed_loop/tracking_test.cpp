// Tracks of the whole chain on simulated drives: objects found, delay, accuracy and false tracks.
#include <array>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "tests/closed_loop/figures.hpp"

namespace boresight::closed_loop {
namespace {

Figures judge_and_print(const DriveOfFigures& of) {
  const Figures f = judge_drive(of);
  const auto false_tracks = [](const judge::FigureList& list, const char* name) {
    return list.value(std::string("tracks.false.all_ranges.") + name);
  };
  std::printf(
      "%s, %s, %s, seed %llu: %.0f of %.0f stays in view found, longest delay %.2f s; tracked %.1f %% of the time,"
      " %.0f id switches; rms error along %.2f m, across %.2f m, speed %.2f m/s, heading %.1f deg, length %.2f m,"
      " width %.2f m; %zu tracks, %.0f false; at a time: %.3f false, %.3f duplicate; before alignment: %.0f false"
      " tracks (%.3f at a time); GOSPA %.2f m\n",
      of.scenario.c_str(), of.profile.c_str(), of.method == ghosts::MethodName::kMirror ? "mirror" : "published",
      static_cast<unsigned long long>(of.seed), f.of_objects("stays_found"), f.of_objects("stays"),
      f.of_objects("delay_max_s"), 100.0 * f.of_objects("tracked_share"), f.of_objects("identity_switches"),
      f.of_objects("along_rms_m"), f.of_objects("across_rms_m"), f.of_objects("speed_rms_mps"),
      f.of_objects("heading_rms_deg"), f.of_objects("length_rms_m"), f.of_objects("width_rms_m"), f.ids,
      false_tracks(f.afterwards, "tracks"), false_tracks(f.afterwards, "mean_at_a_time"),
      f.drive.value("tracks.duplicates.mean_at_a_time"), false_tracks(f.before_aligned, "tracks"),
      false_tracks(f.before_aligned, "mean_at_a_time"), f.drive.value("tracks.gospa.root.total"));
  return f;
}

void expect_objects(const Figures& figures) {
  EXPECT_EQ(figures.of_objects("stays_found"), figures.of_objects("stays"));
  EXPECT_GT(figures.of_objects("stays"), 0.0);
  // In the remaining scans an object is new, half hidden, or crosses the line of sight and has no range rate over
  // ground.
  EXPECT_GT(figures.of_objects("tracked_share"), 0.97);
  // From behind, a car's length is not visible; its track lies at the visible end.
  EXPECT_LT(figures.of_objects("along_rms_m"), 0.6);
  EXPECT_LT(figures.of_objects("across_rms_m"), 0.55);
  EXPECT_LT(figures.of_objects("speed_rms_mps"), 2.2);
  EXPECT_LT(figures.of_objects("heading_rms_deg"), 6.8);
}

class Tracking : public testing::TestWithParam<const char*> {};

TEST_P(Tracking, FindsEveryVehicleSoonWithFewFalseTracks) {
  constexpr std::array<std::uint64_t, 3> kSeeds{1, 2, 3};
  double duplicates = 0.0;
  for (const std::uint64_t seed : kSeeds) {
    const Figures figures = judge_and_print({.scenario = GetParam(), .profile = "ideal", .seed = seed});
    expect_objects(figures);
    const double stays = figures.of_objects("stays");
    EXPECT_LT(figures.of_objects("delay_max_s"), 0.5);
    EXPECT_LE(figures.of_objects("identity_switches"), 2.0 * stays);
    EXPECT_LE(static_cast<double>(figures.ids), 3.0 * stays);
    duplicates += figures.drive.value("tracks.duplicates.mean_at_a_time") / kSeeds.size();
    EXPECT_LT(figures.afterwards.value("tracks.false.all_ranges.mean_at_a_time"), 0.2);
    EXPECT_LE(figures.afterwards.value("tracks.false.all_ranges.tracks"), 6.0);
    EXPECT_LE(figures.before_aligned.value("tracks.false.all_ranges.tracks"), 2.0);
  }
  // Any change of the mounting estimate changes those of one drive: over eight seeds of demo_drive they are 0.083 in
  // the mean, with a std of 0.047 from drive to drive.
  EXPECT_LT(duplicates, 0.16);
}

// The published method (Le Ba Thanh 2023) is the baseline. Its test for stationary objects is a constant threshold, and
// it detects no ghosts beside an object, so both cause false tracks. It still loses no object.
TEST_P(Tracking, FindsEveryVehicleWithThePublishedGhostFilterToo) {
  const Figures figures =
      judge_and_print({.scenario = GetParam(), .profile = "ideal", .method = ghosts::MethodName::kPublished});
  expect_objects(figures);
  EXPECT_LT(figures.afterwards.value("tracks.false.all_ranges.mean_at_a_time"), 4.0);
}

// Real radars have no limits yet: the figures are printed beside those of the ideal ones.
TEST_P(Tracking, IsJudgedWithTheStatisticsOfARealRadarToo) {
  const Figures figures = judge_and_print({.scenario = GetParam(), .profile = "series_77ghz", .duration_s = 20.0});
  EXPECT_GT(figures.of_objects("objects_found"), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Tracking, testing::Values("demo_drive", "aligned_drive", "straight_rail"));

}  // namespace
}  // namespace boresight::closed_loop
