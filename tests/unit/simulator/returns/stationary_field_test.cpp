// The field of weak reflectors has the stated density by range, neighbours and flicker.
#include "services/simulator/radar/returns/stationary_field.hpp"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/simulator/returns/statistics.hpp"

namespace boresight::simulator::returns_test {
namespace {

constexpr double kHalfView_rad = 70.0 / 180.0 * M_PI;

std::vector<radar::FieldPoint> points_at(const Eigen::Vector2d& place, const radar::Draws& draws,
                                         double heading_rad = 0.0) {
  static const radar::Antenna antenna(FieldOfView{-kHalfView_rad, kHalfView_rad, -0.3, 0.3, 100.0});
  radar::StationaryWorldSpec spec = series().stationary_world;
  spec.path_half_width_m = 0.0;
  const radar::StationaryField field(spec);
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  Eigen::Matrix3d turned;
  turned << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  const radar::Viewpoint view{{place.x(), place.y(), 0.6}, Eigen::Vector3d::Zero(), turned};
  std::vector<radar::FieldPoint> points;
  field.look(view, antenna, {place, heading_rad, 0.0, 0.0, 0.0}, draws, points);
  return points;
}

TEST(StationaryField, HasTheStatedNumberInEachRing) {
  std::array<double, radar::kRings> number{};
  constexpr int kPlaces = 400;
  for (int i = 0; i < kPlaces; ++i) {
    const Eigen::Vector2d here(137.0 * i, -59.0 * i);
    for (const radar::FieldPoint& p : points_at(here, at_cycle(static_cast<std::uint32_t>(7 * i)))) {
      const double range = (p.position_m.head<2>() - here).norm();
      if (range < 100.0) number.at(static_cast<std::size_t>(range / radar::kRing_m)) += 1.0 / kPlaces;
    }
  }
  for (std::size_t k = 0; k < radar::kRings; ++k) {
    const double stated = series().stationary_world.per_ring[k];
    EXPECT_NEAR(number[k], stated, 0.08 * stated + 0.35) << "ring " << k;
  }
}

TEST(StationaryField, ReflectorsAreFixedToTheWorldAndFlicker) {
  std::size_t all = 0, again = 0, later = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Eigen::Vector2d here(137.0 * i, 20.0);
    const auto key_set = [&](std::uint32_t cycle, double moved_m) {
      std::set<std::pair<double, double>> places;
      for (const radar::FieldPoint& p : points_at(here + Eigen::Vector2d(moved_m, 0.0), at_cycle(cycle))) {
        places.emplace(p.position_m.x(), p.position_m.y());
      }
      return places;
    };
    const auto now = key_set(10 * i, 0.0), next = key_set(10 * i + 1, 1.0), much_later = key_set(10 * i + 13, 1.0);
    all += now.size();
    for (const auto& place : now) {
      again += next.contains(place) ? 1 : 0;
      later += much_later.contains(place) ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(again) / static_cast<double>(all), 0.45, 0.04);
  EXPECT_LT(static_cast<double>(later) / static_cast<double>(all), 0.02);
}

TEST(StationaryField, PointsHaveNeighboursAndEachRadarSeesItsOwnFlicker) {
  std::size_t all = 0, with_two = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<radar::FieldPoint> points = points_at({91.0 * i, 5.0 * i}, at_cycle(3));
    for (const radar::FieldPoint& p : points) {
      int near = -1;
      for (const radar::FieldPoint& q : points) near += (p.position_m - q.position_m).head<2>().norm() < 1.0 ? 1 : 0;
      ++all;
      with_two += near >= 2 ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(with_two) / static_cast<double>(all), 0.62, 0.12);
  const auto one = points_at({0.0, 0.0}, at_cycle(3, 1)), two = points_at({0.0, 0.0}, at_cycle(3, 2));
  ASSERT_FALSE(one.empty());
  EXPECT_NE(one.front().position_m, two.empty() ? Eigen::Vector3d(0, 0, 0) : two.front().position_m);
}

}  // namespace
}  // namespace boresight::simulator::returns_test
