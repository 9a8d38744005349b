// Where an object is thought to reflect.
#include "services/ghost_filter/core/classify/object.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const Vector2d kSensor{0.0, 0.0};

/// Ahead on the right: the sensor sees its rear and its left flank.
Object vehicle(double length_m, double width_m) {
  Object o;
  o.position_m = {30.0, -6.0};
  o.half_length_m = 0.5 * length_m;
  o.half_width_m = 0.5 * width_m;
  o.position_covariance = 0.01 * Matrix2d::Identity();
  return o;
}

Reflections at(const Object& o, double along_m, double across_m) {
  return reflections_at(o, o.position_m + Vector2d(along_m, across_m), 0.01 * Matrix2d::Identity(), kSensor, kSensor);
}

TEST(ObjectReflections, AreAsManyForEachMetreOfItsFaces) {
  const Object truck = vehicle(16.0, 2.5);
  const double flank = at(truck, 0.0, 1.25).body, rear = at(truck, -8.0, 0.0).body;
  EXPECT_NEAR(flank / rear, 1.0, 0.05);
  EXPECT_LT(at(truck, 8.0, 0.0).body, 0.1 * rear) << "its front is not seen";
  EXPECT_LT(at(truck, 0.0, -1.25).body, 0.1 * flank) << "nor is its right flank";
}

TEST(ObjectReflections, OfWheelsAreAtTheFlankOfWhatIsAsLongAsACar) {
  const Object truck = vehicle(16.0, 2.5), cycle = vehicle(1.8, 0.7);
  EXPECT_GT(at(truck, 0.0, 1.25).wheel, 3.0 * at(truck, 0.0, 0.0).wheel);
  EXPECT_GT(at(truck, 0.0, 0.0).wheel, 0.0) << "the other flank's, under the floor";
  EXPECT_NEAR(at(cycle, 0.0, 0.2).wheel / at(cycle, 0.0, 0.0).wheel, 1.0, 1e-3);
}

TEST(ObjectReflections, OfWheelsAreAnywhereWhereNoFlankIsSeen) {
  Object ahead = vehicle(4.5, 1.8);
  ahead.position_m = {30.0, 0.0};
  EXPECT_NEAR(at(ahead, -2.0, 0.5).wheel / at(ahead, 0.0, 0.0).wheel, 1.0, 1e-3);
}

TEST(ObjectReflections, NothingIsOfWhatIsTooFarInAnyDirection) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> off(-40.0, 40.0), angle(-3.15, 3.15), std_m(0.1, 3.0);
  std::size_t beyond = 0, nothing = 0;
  for (int run = 0; run < 20000; ++run) {
    Object o = vehicle(4.5, 1.9);
    const double heading = angle(random), sight = angle(random);
    o.axis = {std::cos(heading), std::sin(heading)};
    const Vector2d place = o.position_m + Vector2d(off(random), off(random));
    const Vector2d along(std::cos(sight), std::sin(sight)), across(-along.y(), along.x());
    const double along2 = std::pow(std_m(random), 2), across2 = std::pow(std_m(random), 2);
    const Matrix2d covariance = along2 * along * along.transpose() + across2 * across * across.transpose();
    const bool is_nothing = reflections_at(o, place, covariance, kSensor, kSensor).body <= 0.0;
    const bool is_too_far = is_beyond(o, place, along, along2);
    EXPECT_LE(is_too_far, is_nothing) << "run " << run;
    beyond += is_too_far ? 1 : 0;
    nothing += is_nothing ? 1 : 0;
  }
  EXPECT_GT(beyond, nothing / 2) << "or it saves nothing";
}

}  // namespace
}  // namespace boresight::ghosts
