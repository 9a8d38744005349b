// The map of reflectors: what it finds on a drive past structures whose truth is known.
#include "services/ghost_filter/core/reflectors/reflector_map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::ghosts {
namespace {

constexpr std::int64_t kScan_ns = 25'000'000;
constexpr double kSpeed_mps = 20.0;

double distance_m(const Segment& s, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = s.end_m - s.start_m;
  const double share = std::clamp((p - s.start_m).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - s.start_m - share * along).norm();
}

/// Drives along x and shows the map places within 60 m, a third of them in each scan.
class Drive {
 public:
  explicit Drive(unsigned seed, const MapConfig& config = {}) : map(config), random_(seed) {}

  void add(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double step_m) {
    const double length = (to - from).norm();
    for (double k = 0.0; k <= length; k += step_m) places.push_back(from + k / length * (to - from));
  }
  void run(
      double duration_s, const std::function<void()>& each = [] {}) {
    std::normal_distribution<double> noise(0.0, 0.08);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    const std::int64_t end_ns = time_ns_ + static_cast<std::int64_t>(duration_s * 1e9);
    for (; time_ns_ < end_ns; time_ns_ += kScan_ns) {
      static_cast<void>(odometry.advance(time_ns_, kSpeed_mps, 0.0));
      for (const Eigen::Vector2d& p : places) {
        if ((p - odometry.position_m()).norm() > 60.0 || chance(random_) > 0.33) continue;
        map.add(p + Eigen::Vector2d(noise(random_), noise(random_)), 0.08, time_ns_);
      }
      map.update(time_ns_);
      each();
    }
  }
  /// The nearest reflector of a place, or nullptr if none is within the tolerance.
  const Segment* at(const Eigen::Vector2d& place, double tolerance_m = 0.3) const {
    const Segment* best = nullptr;
    for (const Segment& s : map.reflectors()) {
      if (distance_m(s, place) < (best == nullptr ? tolerance_m : distance_m(*best, place))) best = &s;
    }
    return best;
  }
  ReflectorMap map;
  Odometry odometry;
  std::vector<Eigen::Vector2d> places;

 private:
  std::mt19937 random_;
  std::int64_t time_ns_ = 1'000'000'000;
};

double slope(const Segment& s) {
  const Eigen::Vector2d along = s.end_m - s.start_m;
  return along.y() / along.x();
}

TEST(ReflectorMap, FindsRailsAllAlong) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Drive drive(seed);
    drive.add({-100.0, 5.0}, {300.0, 5.0}, 2.0);
    drive.add({-100.0, -7.0}, {300.0, -7.0}, 2.0);
    drive.run(1.5);
    int looks = 0, gaps = 0;
    drive.run(6.0, [&] {
      const double x = drive.odometry.position_m().x();
      for (const double y : {5.0, -7.0}) {
        for (double ahead = -30.0; ahead <= 30.0; ahead += 7.5) {
          ++looks;
          const Segment* const s = drive.at({x + ahead, y}, 1.0);
          if (s == nullptr) {
            ++gaps;
            continue;
          }
          EXPECT_NEAR(slope(*s), 0.0, 0.03);
        }
      }
    });
    EXPECT_LT(gaps, 0.02 * looks) << "at the borders of tiles";
  }
}

TEST(ReflectorMap, KnowsHowFarAReflectorGoesOnInTheNextTiles) {
  Drive drive(2);
  drive.add({-100.0, 5.0}, {300.0, 5.0}, 1.5);
  drive.add({36.0, -9.0}, {46.0, -9.0}, 0.7);
  drive.run(2.0);
  const Segment* const rail = drive.at({40.0, 5.0});
  const Segment* const hedge = drive.at({40.0, -9.0});
  ASSERT_NE(rail, nullptr);
  ASSERT_NE(hedge, nullptr);
  EXPECT_GT(rail->continued_m, 50.0);
  EXPECT_NEAR(hedge->continued_m, 10.0, 1.5);
}

TEST(ReflectorMap, LeavesLargeGapsAndEndsOpen) {
  Drive drive(4);
  drive.add({-100.0, 6.0}, {55.0, 6.0}, 1.5);
  drive.add({64.5, 6.0}, {110.0, 6.0}, 1.5);
  drive.run(4.0);  // to x = 80
  EXPECT_NE(drive.at({52.0, 6.0}), nullptr);
  EXPECT_NE(drive.at({70.0, 6.0}), nullptr);
  EXPECT_EQ(drive.at({59.75, 6.0}, 3.0), nullptr);
  EXPECT_EQ(drive.at({113.0, 6.0}, 2.0), nullptr) << "behind its end";
}

TEST(ReflectorMap, TellsWallsAtARightAngleApart) {
  Drive drive(5);
  drive.add({-40.0, 8.0}, {40.0, 8.0}, 0.7);
  drive.add({40.0, 8.0}, {40.0, 30.0}, 0.7);
  drive.run(1.5);
  const Segment* const along = drive.at({20.0, 8.0});
  const Segment* const across = drive.at({40.0, 20.0});
  ASSERT_NE(along, nullptr);
  ASSERT_NE(across, nullptr);
  EXPECT_NEAR(slope(*along), 0.0, 0.05);
  EXPECT_NEAR(1.0 / slope(*across), 0.0, 0.05);
}

TEST(ReflectorMap, FollowsABend) {
  Drive drive(6);
  constexpr double kRadius_m = 70.0;
  for (double angle = -0.9; angle < 0.9; angle += 0.02) {
    drive.places.emplace_back(20.0 + kRadius_m * std::sin(angle), 78.0 - kRadius_m * std::cos(angle));
  }
  drive.run(1.5);
  for (const double angle : {-0.5, -0.2, 0.1, 0.4}) {
    const Eigen::Vector2d p(20.0 + kRadius_m * std::sin(angle), 78.0 - kRadius_m * std::cos(angle));
    const Segment* const s = drive.at(p, 0.6);
    ASSERT_NE(s, nullptr) << "angle " << angle;
    EXPECT_NEAR(std::atan(slope(*s)), angle, 0.15);
  }
}

TEST(ReflectorMap, TakesFewBushesForReflectors) {
  Drive drive(7);
  std::mt19937 random(7);
  std::normal_distribution<double> leaf(0.0, 1.5);
  for (int bush = 0; bush < 12; ++bush) {
    for (int i = 0; i < 40; ++i) drive.places.emplace_back(10.0 * bush - 20.0 + leaf(random), 12.0 + leaf(random));
  }
  std::size_t scans = 0, sum = 0;
  drive.run(4.0, [&] {
    ++scans;
    sum += drive.map.reflectors().size();
  });
  EXPECT_LT(static_cast<double>(sum) / static_cast<double>(scans), 3.0) << "in twelve bushes of forty leaves";
}

TEST(ReflectorMap, ForgetsWhatIsNoLongerThere) {
  Drive drive(8);
  drive.add({-100.0, 6.0}, {100.0, 6.0}, 1.5);
  drive.run(2.0);
  ASSERT_FALSE(drive.map.reflectors().empty());
  EXPECT_GT(drive.map.points(), 0U);
  drive.places.clear();
  drive.run(2.0);
  EXPECT_TRUE(drive.map.reflectors().empty());
}

TEST(ReflectorMap, UncertainDetectionsAreIgnored) {
  MapConfig config;
  ReflectorMap map(config);
  map.add({3.0, 3.0}, config.most_std_m + 0.01, 1);
  EXPECT_EQ(map.points(), 0U);
  map.add({3.0, 3.0}, config.most_std_m - 0.01, 1);
  EXPECT_EQ(map.points(), 1U);
}

TEST(ReflectorMap, SearchesFewPointsInAScan) {
  // Points everywhere, all new: the budget and one tile with its margin are the limit.
  MapConfig config;
  config.search_period_s = 0.0;
  ReflectorMap map(config);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-150.0, 150.0);
  for (int i = 0; i < 50'000; ++i) map.add({place(random), place(random)}, 0.1, 1'000'000'000);
  int scans = 0;
  for (; scans < 200 && map.reflectors().size() < kMaxReflectorSegments; ++scans) {
    map.update(1'000'000'000 + scans * 1'000'000);
    if (scans == 0) {
      EXPECT_LT(map.reflectors().size(), 20U) << "a few tiles of 144";
    }
  }
  EXPECT_GT(scans, 20);
}

TEST(ReflectorMap, SurvivesBadInputWithoutAllocation) {
  ReflectorMap map{MapConfig{}};
  std::mt19937 random(10);
  std::uniform_real_distribution<double> place(-80.0, 80.0);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (std::int64_t scan = 0; scan < 200; ++scan) {
      const std::int64_t now_ns = 1'000'000'000 + scan * kScan_ns;
      for (int i = 0; i < 200; ++i) {
        const double x = place(random);
        map.add({x, i % 2 == 0 ? 5.0 : place(random)}, 0.1, now_ns);
      }
      for (int i = 0; i < 300; ++i) map.add({4.0, 4.0}, 0.0, now_ns);  // all of them in one place
      map.add({nan, 0.0}, 0.01, now_ns);
      map.add({0.0, infinite}, 0.01, now_ns);
      map.add({0.0, 0.0}, nan, now_ns);
      map.add({1e9, -1e9}, 0.1, now_ns);
      map.update(now_ns);
      for (const Segment& s : map.reflectors()) ASSERT_TRUE(s.start_m.allFinite() && s.end_m.allFinite());
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  map.clear();
  EXPECT_EQ(map.points(), 0U);
  EXPECT_TRUE(map.reflectors().empty());
}

TEST(ReflectorSegments, ArePublishedInTheVehicleFrame) {
  Odometry odometry;
  static_cast<void>(odometry.advance(0, 10.0, 0.0));
  static_cast<void>(odometry.advance(1'000'000'000, 10.0, 0.0));
  const auto out = std::make_unique<ClassifiedScan>();
  out->number_of_reflector_segments = 7;  // of the scan before
  const std::vector<Segment> segments(1, {{15.0, 5.0}, {35.0, 5.0}, 0.25, 9, 90, 20.0});
  write_segments(segments, odometry, *out);
  ASSERT_EQ(out->number_of_reflector_segments, 1U);
  const ReflectorSegment& s = out->reflector_segments[0];
  EXPECT_NEAR(s.start_vehicle_m[0], 5.0, 1e-5);
  EXPECT_NEAR(s.end_vehicle_m[0], 25.0, 1e-5);
  EXPECT_NEAR(s.end_vehicle_m[1], 5.0, 1e-5);
  EXPECT_EQ(s.residual_std_m, 0.25F);
  EXPECT_EQ(s.number_of_detections, 90U);
  write_segments(std::vector<Segment>(kMaxReflectorSegments + 5, segments[0]), odometry, *out);
  EXPECT_EQ(out->number_of_reflector_segments, kMaxReflectorSegments);
}

}  // namespace
}  // namespace boresight::ghosts
