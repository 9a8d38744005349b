// What is told of a way without following it must hold of the way that is followed.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/ghost_filter/core/density/exponential.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"

namespace boresight::ghosts {
namespace {

TEST(Approach, HoldsOfEveryWayThatIsFound) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-70.0, 70.0), angle(-3.15, 3.15), half(2.0, 50.0), bend(-0.05, 0.05),
      range(5.0, 120.0);
  std::size_t met = 0, known = 0, none = 0, missed = 0, farther = 0;
  for (int run = 0; run < 100000; ++run) {
    Mirror m;
    const double heading = angle(random);
    const bool gentle = run % 3 != 0;  // as walls and rails are
    m.curve = {{place(random), place(random)},
               {std::cos(heading), std::sin(heading)},
               run % 3 == 2 ? 0.0 : (gentle ? 0.01 : 1.0) * bend(random)};
    m.end_m = half(random);
    if (std::abs(m.curve.curvature_per_m) * m.end_m > 1.2) m.end_m = 1.2 / std::abs(m.curve.curvature_per_m);
    m.begin_m = -m.end_m;
    m.covariance = Eigen::Vector3d(0.01, 1e-5, 1e-9).asDiagonal();
    m.existence = 1.0;
    const Eigen::Vector2d sensor(3.6, 0.7);
    const double azimuth = angle(random);
    const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
    const Eigen::Vector2d from = run % 2 == 0 ? sensor : Eigen::Vector2d(0.5 * place(random), 0.5 * place(random));
    const double length = (from - sensor).norm() + 2.0 * range(random);
    const auto way = approach(m, sensor, from, direction, length);
    none += way ? 0 : 1;
    const auto there = meet(m, sensor, from, direction, length, 0.5);
    if (!there) continue;
    ++met;
    EXPECT_TRUE(way || !gentle) << "run " << run;
    missed += way ? 0 : 1;
    if (!way || !std::isfinite(way->error_m)) continue;
    ++known;
    const bool is_off = std::abs(way->rest_m - there->rest_m) > way->error_m + 0.5;
    EXPECT_FALSE(is_off && gentle) << "run " << run;
    farther += is_off ? 1 : 0;
    EXPECT_LE(there->metres_per_m * there->detour.length_std_m, 1.2 * way->metres_per_m * way->length_std_m + 3.0);
  }
  EXPECT_GT(met, 3000U);
  EXPECT_GT(known, met / 2);
  EXPECT_GT(none, 20000U) << "or it saves nothing";
  // Of mirrors that are bent to a quarter of a circle some are hard to foretell.
  EXPECT_LT(missed, met / 500);
  EXPECT_LT(farther, known / 2000);
}

TEST(Exponential, HasNineDigits) {
  for (double x = -700.0; x <= 700.0; x += 0.0137) {
    ASSERT_NEAR(exponential(x) / std::exp(x), 1.0, 1e-9) << x;
  }
  EXPECT_LT(exponential(-1e300), 1e-300);
  EXPECT_TRUE(std::isnan(exponential(std::nan(""))));
}

}  // namespace
}  // namespace boresight::ghosts
