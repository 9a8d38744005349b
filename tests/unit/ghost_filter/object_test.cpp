// Where an object is thought to reflect.
#include "services/ghost_filter/core/classify/object.hpp"

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

}  // namespace
}  // namespace boresight::ghosts
