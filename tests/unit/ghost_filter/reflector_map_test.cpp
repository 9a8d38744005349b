// The map over time: what it makes of a drive past things of which the truth is known.
#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::ghosts {
namespace {

constexpr std::int64_t kScan_ns = 25'000'000;
constexpr double kSpeed_mps = 20.0;

/// Drives along x and shows the map what of a set of places is within 60 m, a third of it in each scan.
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
        map.add(p + Eigen::Vector2d(noise(random_), noise(random_)), 0.08 * 0.08, time_ns_);
        ++detections;
      }
      map.update(odometry, 0.02, 0.0005);
      each();
    }
  }
  /// The reflector of which a place is a part, or nullptr.
  const Reflector* at(const Eigen::Vector2d& place, double tolerance_m = 0.3) const {
    for (const Reflector& r : map.reflectors()) {
      const double arc = r.curve.arc(place);
      if (arc >= r.begin_m() && arc <= r.end_m() && std::abs(r.curve.distance(place)) < tolerance_m) return &r;
    }
    return nullptr;
  }
  double probability(const Eigen::Vector2d& place) const {
    double most = 0.0;
    for (const Reflector& r : map.reflectors()) {
      if (std::abs(r.curve.distance(place)) > 0.4) continue;
      most = std::max(most, r.existence() * r.occupancy.probability(r.curve.arc(place) + r.arc_shift_m, 0.5));
    }
    return most;
  }
  ReflectorMap map;
  Odometry odometry;
  std::vector<Eigen::Vector2d> places;
  std::size_t detections = 0;

 private:
  std::mt19937 random_;
  std::int64_t time_ns_ = 1'000'000'000;
};

TEST(ReflectorMap, FindsARailThatIsMeasuredWellAtLastInTheCloudThatWasMadeOfItBefore) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> along(0.0, 40.0);
    std::normal_distribution<double> noise(0.0, 1.0);
    ReflectorMap map{MapConfig{}};
    Odometry odometry;
    for (std::int64_t time_ns = 0; time_ns < 3'000'000'000; time_ns += kScan_ns) {
      static_cast<void>(odometry.advance(1'000'000'000 + time_ns, 0.0, 0.0));
      for (const double std_m : {0.08, 0.6}) {
        if (std_m < 0.1 && time_ns < 1'000'000'000) continue;
        for (int k = 0; k < 15; ++k) {
          const Eigen::Vector2d place(along(random), -9.0 + std_m * noise(random));
          map.add(place, std_m * std_m, 1'000'000'000 + time_ns);
        }
      }
      map.update(odometry, 0.02, 0.0005);
    }
    const auto runs_past = [](const Reflector& r, double x) {
      const double arc = r.curve.arc({x, -9.0});
      return arc >= r.begin_m() && arc <= r.end_m() && std::abs(r.curve.distance({x, -9.0})) < 0.2 &&
             std::abs(r.curve.tangent_at(arc).y()) < 0.05;
    };
    for (const double x : {5.0, 20.0, 35.0}) {
      EXPECT_TRUE(std::any_of(map.reflectors().begin(), map.reflectors().end(),
                              [&](const Reflector& r) { return r.log_odds > 0.0 && runs_past(r, x); }))
          << "seed " << seed << " at " << x;
    }
  }
}

TEST(ReflectorMap, FindsRailsAndKeepsThem) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Drive drive(seed);
    drive.add({-100.0, 5.0}, {300.0, 5.0}, 2.0);
    drive.add({-100.0, -7.0}, {300.0, -7.0}, 2.0);
    drive.run(1.5);
    ASSERT_EQ(drive.map.reflectors().size(), 2U) << "each of them as one, not in pieces";
    std::set<std::uint32_t> ids;
    drive.run(6.0, [&] {
      const double x = drive.odometry.position_m().x();
      for (const double y : {5.0, -7.0}) {
        for (const double ahead : {-30.0, 0.0, 30.0}) {
          const Reflector* const r = drive.at({x + ahead, y});
          ASSERT_NE(r, nullptr) << "seed " << seed << " at " << x + ahead << ", " << y;
          ids.insert(r->id);
          EXPECT_GT(r->existence(), 0.9);
          EXPECT_NEAR(r->curve.tangent_at(r->curve.arc({x + ahead, y})).y(), 0.0, 0.01);
        }
      }
    });
    EXPECT_EQ(ids.size(), 2U) << "seed " << seed << ": they stay the same";
  }
}

TEST(ReflectorMap, LeavesGapsAndEndsOpen) {
  Drive drive(4);
  drive.add({-100.0, 6.0}, {60.0, 6.0}, 1.5);
  drive.add({64.5, 6.0}, {110.0, 6.0}, 1.5);
  drive.run(4.0);  // to x = 80
  EXPECT_GT(drive.probability({55.0, 6.0}), 0.8);
  EXPECT_GT(drive.probability({70.0, 6.0}), 0.8);
  EXPECT_LT(drive.probability({62.9, 6.0}), 0.35) << "a gap of 4.5 m";
  EXPECT_GT(drive.probability({108.0, 6.0}), 0.6);
  EXPECT_LT(drive.probability({116.0, 6.0}), 0.05) << "behind its end";
}

TEST(ReflectorMap, TellsWallsAtARightAngleApart) {
  Drive drive(5);
  drive.add({-40.0, 8.0}, {40.0, 8.0}, 0.7);
  drive.add({40.0, 8.0}, {40.0, 30.0}, 0.7);
  drive.run(1.5);
  const Reflector* const along = drive.at({20.0, 8.0});
  const Reflector* const across = drive.at({40.0, 20.0});
  ASSERT_NE(along, nullptr);
  ASSERT_NE(across, nullptr);
  EXPECT_NE(along, across);
  EXPECT_NEAR(along->curve.tangent_at(along->curve.arc({20.0, 8.0})).y(), 0.0, 0.03);
  EXPECT_NEAR(across->curve.tangent_at(across->curve.arc({40.0, 20.0})).x(), 0.0, 0.03);
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
    const Reflector* const r = drive.at(p);
    ASSERT_NE(r, nullptr) << "angle " << angle;
    const Eigen::Vector2d tangent = r->curve.tangent_at(r->curve.arc(p));
    EXPECT_NEAR(std::abs(tangent.x() * std::sin(angle) - tangent.y() * std::cos(angle)), 0.0, 0.03);
  }
  EXPECT_LE(drive.map.reflectors().size(), 2U);
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
    for (const Reflector& r : drive.map.reflectors()) sum += r.existence() > 0.6 ? 1 : 0;
  });
  EXPECT_LT(static_cast<double>(sum) / static_cast<double>(scans), 6.0) << "in twelve bushes of forty leaves";
}

TEST(ReflectorMap, ForgetsWhatIsNotThereAnyMore) {
  Drive drive(8);
  drive.add({-100.0, 6.0}, {100.0, 6.0}, 1.5);
  drive.run(2.0);
  ASSERT_FALSE(drive.map.reflectors().empty());
  EXPECT_GT(drive.map.grid().size(), 0U);
  drive.places.clear();
  drive.run(12.0);
  EXPECT_TRUE(drive.map.reflectors().empty());
  EXPECT_EQ(drive.map.grid().size(), 0U);
}

TEST(ReflectorMap, KnowsHowSureItIs) {
  // The offset beside the vehicle, over seeds: its error squared by its variance. What detections have in common is
  // allowed for, here they have nothing: so it may be too careful, but not too sure.
  double nees = 0.0;
  int runs = 0;
  for (unsigned seed = 100; seed < 140; ++seed) {
    Drive drive(seed);
    drive.add({-100.0, 5.0}, {200.0, 5.0}, 2.0);
    drive.run(2.0);
    const Eigen::Vector2d beside(drive.odometry.position_m().x(), 5.0);
    const Reflector* const r = drive.at(beside);
    ASSERT_NE(r, nullptr) << "seed " << seed;
    nees += std::pow(r->curve.distance(beside), 2) / r->variance_at(r->curve.arc(beside));
    ++runs;
  }
  nees /= runs;
  EXPECT_LT(nees, 1.4);
  EXPECT_GT(nees, 0.02);
}

TEST(ReflectorMap, WorkGrowsAsTheDetections) {
  // The same again and again side by side: what is looked at for each detection does not grow with the map.
  const auto work_per_detection = [](int lanes) {
    MapConfig config;
    config.capacity = 32768;
    Drive drive(9, config);
    std::mt19937 random(9);
    std::normal_distribution<double> leaf(0.0, 1.5);
    for (int lane = 0; lane < lanes; ++lane) {
      const double y = 5.0 + 6.0 * lane;
      drive.add({-80.0, y}, {80.0, y}, 2.0);
      for (double x = -80.0; x < 80.0; x += 2.0) drive.places.emplace_back(x + leaf(random), y + 3.0 + leaf(random));
    }
    drive.run(2.0);
    return static_cast<double>(drive.map.points_searched()) / static_cast<double>(drive.detections);
  };
  const double few = work_per_detection(2), many = work_per_detection(8);
  EXPECT_LT(few, 3.0);
  EXPECT_LT(many, 1.3 * few);
}

TEST(ReflectorMap, SurvivesBadInputAndAFullMapWithoutAllocation) {
  MapConfig config;
  config.capacity = 300;
  ReflectorMap map(config);
  Odometry odometry;
  std::mt19937 random(10);
  std::uniform_real_distribution<double> place(-80.0, 80.0);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (std::int64_t scan = 0; scan < 200; ++scan) {
      const std::int64_t now_ns = 1'000'000'000 + scan * kScan_ns;
      static_cast<void>(odometry.advance(now_ns, 10.0, 0.1));
      for (int i = 0; i < 200; ++i) {
        const double x = place(random);
        map.add({x, i % 2 == 0 ? 5.0 : place(random)}, i % 7 == 0 ? 0.0 : 0.01, now_ns);
      }
      for (int i = 0; i < 40; ++i) map.add({4.0, 4.0}, 0.0, now_ns);  // all of them in one place
      map.add({nan, 0.0}, 0.01, now_ns);
      map.add({0.0, infinite}, 0.01, now_ns);
      map.add({0.0, 0.0}, nan, now_ns);
      map.add({0.0, 0.0}, -1.0, now_ns);
      map.update(odometry, 0.1, 0.01);
      ASSERT_LE(map.grid().size(), 300U);
      for (const Reflector& r : map.reflectors()) {
        ASSERT_TRUE(r.curve.origin_m.allFinite() && r.curve.tangent.allFinite() && r.covariance.allFinite());
        ASSERT_GE(r.covariance.diagonal().minCoeff(), 0.0);
      }
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  map.clear();
  EXPECT_EQ(map.grid().size(), 0U);
  EXPECT_TRUE(map.reflectors().empty());
}

}  // namespace
}  // namespace boresight::ghosts
