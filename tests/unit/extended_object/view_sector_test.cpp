// Moments of the reflections within a field of view that cuts the object: against draws, limits and derivatives.
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "services/common/extended_object/reflection_model.hpp"

namespace boresight::extended_object {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const ObjectClassTable kSectorTable = object_class_table_defaults();

struct SectorCase {
  RoadUserClass object_class = RoadUserClass::kTruck;
  double length_m = 12.0, width_m = 2.5;
  Vector2d sensor{0.0, 0.0};
  ViewSector sector;
};

Vector2d unit_vector(double angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

/// A sector whose edge points from the sensor to a place of the box, the rest of the box to the right of it in view.
SectorCase cut_at(RoadUserClass object_class, double length_m, const Vector2d& sensor, const Vector2d& place,
                  double half_angle_rad, double edge_rad) {
  const Vector2d way = place - sensor;
  return {object_class,
          length_m,
          model_of(kSectorTable, object_class).size.width_mean_m,
          sensor,
          {unit_vector(std::atan2(way.y(), way.x()) - half_angle_rad), half_angle_rad, edge_rad}};
}

ReflectionMoments moments_in(const SectorCase& c, double length_m) {
  return reflection_moments(model_of(kSectorTable, c.object_class).places, length_m, c.width_m, c.sensor, c.sector);
}
ReflectionMoments moments_in(const SectorCase& c) {
  return moments_in(c, c.length_m);
}

/// A truck and a car, abeam, from a corner and from behind, cut at the middle and nearer to either end.
std::vector<SectorCase> cut_boxes() {
  std::vector<SectorCase> cases;
  for (const double edge_rad : {0.02, 0.1}) {
    for (const double at : {-0.3, 0.0, 0.3}) {
      for (const Vector2d& sensor : {Vector2d(0.0, 12.0), Vector2d(-20.0, 15.0), Vector2d(15.0, -8.0)}) {
        cases.push_back(cut_at(RoadUserClass::kTruck, 12.0, sensor, {12.0 * at, 0.0}, 1.0, edge_rad));
      }
      for (const Vector2d& sensor : {Vector2d(0.0, 6.0), Vector2d(-8.0, 5.0), Vector2d(-12.0, 0.5)}) {
        cases.push_back(cut_at(RoadUserClass::kCar, 4.6, sensor, {4.6 * at, 0.0}, 1.0, edge_rad));
      }
    }
  }
  return cases;
}

struct DrawnMoments {
  double share = 0.0;
  Vector2d mean{0.0, 0.0};
  Matrix2d covariance = Matrix2d::Zero();
};

/// Of draws from the mixture, each seen with the probability that the soft sector gives its own bearing.
DrawnMoments draw_within(const SectorCase& c, int samples) {
  const ReflectionMixture mixture =
      reflection_mixture(model_of(kSectorTable, c.object_class).places, c.length_m, c.width_m, c.sensor);
  std::array<double, kReflectionComponents> weights{};
  for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = mixture[k].weight;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::discrete_distribution<std::size_t> part(weights.begin(), weights.end());
  const double facing_rad = std::atan2(c.sector.facing.y(), c.sector.facing.x());
  DrawnMoments m;
  double seen = 0.0;
  for (int i = 0; i < samples; ++i) {
    const ReflectionComponent& k = mixture[part(random)];
    const double x = normal(random), y = normal(random), edge = normal(random);
    const Vector2d at = k.mean_m + k.variance_m2.cwiseSqrt().cwiseProduct(Vector2d(x, y));
    const Vector2d way = at - c.sensor;
    const double off_rad = std::abs(std::remainder(std::atan2(way.y(), way.x()) - facing_rad, 2.0 * M_PI));
    if (off_rad > c.sector.half_angle_rad + c.sector.edge_rad * edge) continue;
    seen += 1.0;
    m.mean += at;
    m.covariance += at * at.transpose();
  }
  m.share = seen / samples;
  m.mean /= seen;
  m.covariance = m.covariance / seen - m.mean * m.mean.transpose();
  return m;
}

// The Gaussians are weighted, not cut: their own moments stay. A third of a box is small beside the box.
TEST(ViewSector, MomentsAreNearThoseOfDrawsWithinTheSector) {
  for (const SectorCase& c : cut_boxes()) {
    const DrawnMoments drawn = draw_within(c, 100'000);
    const ReflectionMoments m = moments_in(c);
    const Vector2d half(0.5 * c.length_m, 0.5 * c.width_m);
    EXPECT_NEAR(m.share_in_view, drawn.share, 0.02) << c.sensor.transpose();
    EXPECT_LT((m.mean_m - drawn.mean).norm(), 0.2 * half.norm()) << c.sensor.transpose();
    EXPECT_LT((m.scatter_m2 - drawn.covariance).norm(), 0.25 * half.squaredNorm()) << c.sensor.transpose();
  }
}

TEST(ViewSector, AllAroundGivesTheMomentsWithoutASector) {
  for (const SectorCase& cut : cut_boxes()) {
    const auto& places = model_of(kSectorTable, cut.object_class).places;
    const ReflectionMoments whole = reflection_moments(places, cut.length_m, cut.width_m, cut.sensor);
    for (const double half_angle_rad : {M_PI, 3.5, 7.0}) {
      const ReflectionMoments m =
          reflection_moments(places, cut.length_m, cut.width_m, cut.sensor, {cut.sector.facing, half_angle_rad, 0.1});
      EXPECT_EQ(m.share_in_view, 1.0);
      EXPECT_EQ(m.mean_m, whole.mean_m);
      EXPECT_EQ(m.scatter_m2, whole.scatter_m2);
      EXPECT_EQ(m.mean_by_length, whole.mean_by_length);
    }
  }
}

TEST(ViewSector, WideSectorTowardsTheBoxChangesNothing) {
  for (SectorCase c : cut_boxes()) {
    c.sector = {-c.sensor.normalized(), 2.5, 0.02};
    const ReflectionMoments m = moments_in(c);
    c.sector.half_angle_rad = M_PI;
    const ReflectionMoments whole = moments_in(c);
    EXPECT_NEAR(m.share_in_view, 1.0, 1e-3) << c.sensor.transpose();
    EXPECT_LT((m.mean_m - whole.mean_m).norm(), 5e-3) << c.sensor.transpose();
  }
}

TEST(ViewSector, DerivativeByLengthIsTheNumericalOne) {
  for (const SectorCase& c : cut_boxes()) {
    const ReflectionMoments m = moments_in(c);
    // Richardson: two step sizes, error of fourth order.
    const auto mean_slope = [&](double h) {
      return Vector2d((moments_in(c, c.length_m + h).mean_m - moments_in(c, c.length_m - h).mean_m) / (2.0 * h));
    };
    const Vector2d by_mean = (4.0 * mean_slope(0.02) - mean_slope(0.04)) / 3.0;
    EXPECT_LT((m.mean_by_length - by_mean).norm(), 1e-3) << c.sensor.transpose();
  }
}

TEST(ViewSector, EndInViewMovesByHalfTheLength) {
  ReflectionPlaces places = model_of(kSectorTable, RoadUserClass::kTruck).places;
  places.interior_share = 0.0;
  const ReflectionMoments m = reflection_moments(places, 12.0, 2.5, {60.0, 0.0}, {{-1.0, 0.0}, 1.0, 0.05});
  EXPECT_NEAR(m.mean_by_length.x(), 0.5, 1e-6);
  EXPECT_NEAR(m.mean_by_length.y(), 0.0, 1e-6);
}

TEST(ViewSector, ShareGrowsWithTheSectorFromNothingToAll) {
  for (const SectorCase& cut : cut_boxes()) {
    const ReflectionMixture mixture =
        reflection_mixture(model_of(kSectorTable, cut.object_class).places, cut.length_m, cut.width_m, cut.sensor);
    for (const double off_rad : {0.0, 0.5, 2.0, 3.1}) {
      const double facing_rad = std::atan2(-cut.sensor.y(), -cut.sensor.x()) + off_rad;
      double before = 0.0;
      for (double half = 0.0; half < 3.3; half += 0.02) {
        const SeenMixture seen = seen_in(mixture, cut.sensor, {unit_vector(facing_rad), half, cut.sector.edge_rad});
        EXPECT_GT(seen.share, 0.0);
        EXPECT_LE(seen.share, 1.0 + 1e-12);
        EXPECT_GE(seen.share, before - 1e-12) << half;
        double weights = 0.0;
        for (const ReflectionComponent& k : seen.mixture) weights += k.weight;
        EXPECT_NEAR(weights, seen.share, 1e-12);
        before = seen.share;
      }
      EXPECT_EQ(before, 1.0);
    }
  }
}

TEST(ViewSector, BoxCutInTheMiddleIsHalfInView) {
  // Abeam of the middle nothing along the box hides anything: front and rear are alike.
  const SectorCase left = cut_at(RoadUserClass::kTruck, 12.0, {0.0, 14.0}, {0.0, 0.0}, 1.0, 0.01);
  SectorCase right = left;
  right.sector.facing = Vector2d(-left.sector.facing.x(), left.sector.facing.y());
  const ReflectionMoments of_left = moments_in(left), of_right = moments_in(right);
  EXPECT_NEAR(of_left.share_in_view, 0.5, 1e-9);
  EXPECT_NEAR(of_right.share_in_view, 0.5, 1e-9);
  EXPECT_NEAR(of_left.mean_m.x(), -of_right.mean_m.x(), 1e-9);
  EXPECT_NEAR(of_left.mean_m.y(), of_right.mean_m.y(), 1e-9);
  EXPECT_GT(std::abs(of_left.mean_m.x()), 2.0) << "a half of 6 m has its middle at 3 m";
  EXPECT_LT(std::abs(of_left.mean_m.x()), 4.0);
}

TEST(ViewSector, TurnedSectorAndMirroredSceneGiveTheMirroredMoments) {
  for (const SectorCase& c : cut_boxes()) {
    const ReflectionMoments m = moments_in(c);
    for (const Vector2d& mirror : {Vector2d(1.0, -1.0), Vector2d(-1.0, 1.0), Vector2d(-1.0, -1.0)}) {
      SectorCase other = c;
      other.sensor = mirror.cwiseProduct(c.sensor);
      other.sector.facing = mirror.cwiseProduct(c.sector.facing);
      const ReflectionMoments n = moments_in(other);
      EXPECT_NEAR(n.share_in_view, m.share_in_view, 1e-12);
      EXPECT_LT((mirror.cwiseProduct(n.mean_m) - m.mean_m).norm(), 1e-9);
      EXPECT_LT((mirror.asDiagonal() * n.scatter_m2 * mirror.asDiagonal() - m.scatter_m2).norm(), 1e-9);
      EXPECT_LT((mirror.cwiseProduct(n.mean_by_length) - m.mean_by_length).norm(), 1e-6);
    }
  }
}

// Everything turned in the world: box axes turn with the box, so all that is seen stays the same.
TEST(ViewSector, IsInvariantToRotationOfTheScene) {
  for (const SectorCase& c : cut_boxes()) {
    const ReflectionMoments m = moments_in(c);
    for (const double turn_rad : {0.7, 2.9, -1.8}) {
      const OrientedBox box{{31.0, -12.0}, turn_rad, c.length_m, c.width_m};
      const Vector2d sensor_m = box.from_box(c.sensor);
      const Vector2d facing = box.rotation_to_box().transpose() * c.sector.facing;
      SectorCase turned = c;
      turned.sensor = box.to_box(sensor_m);
      turned.sector.facing = box.rotation_to_box() * facing;
      const ReflectionMoments n = moments_in(turned);
      EXPECT_NEAR(n.share_in_view, m.share_in_view, 1e-9);
      EXPECT_LT((n.mean_m - m.mean_m).norm(), 1e-9);
      EXPECT_LT((n.scatter_m2 - m.scatter_m2).norm(), 1e-8);
    }
  }
}

TEST(ViewSector, NothingInViewGivesFiniteMoments) {
  for (std::size_t k = 0; k < kRoadUserClasses; ++k) {
    const ObjectClassModel& m = kSectorTable[k];
    for (const Vector2d& sensor :
         {Vector2d(-30.0, 0.0), Vector2d(0.0, 5.0), Vector2d(0.0, 0.0), Vector2d(300.0, 1.0)}) {
      const double away_rad = std::atan2(sensor.y(), sensor.x());
      for (const double half_angle_rad : {0.0, 0.01, 1.0, 1.5}) {
        for (const double edge_rad : {0.0, 0.01, 0.1}) {
          const ReflectionMoments moments =
              reflection_moments(m.places, m.size.length_mean_m, m.size.width_mean_m, sensor,
                                 {unit_vector(away_rad), half_angle_rad, edge_rad});
          EXPECT_GT(moments.share_in_view, 0.0);
          EXPECT_LE(moments.share_in_view, 1.0);
          EXPECT_TRUE(moments.mean_m.allFinite() && moments.mean_by_length.allFinite());
          EXPECT_TRUE(moments.scatter_m2.allFinite());
          EXPECT_GT(moments.scatter_m2.determinant(), 0.0);
        }
      }
    }
  }
}

}  // namespace
}  // namespace boresight::extended_object
