// What the classified scan publishes of the reflectors.
#include "services/ghost_filter/core/reflector_map/segments.hpp"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

/// Seen from end to end.
Reflector reflector(double x_m, double y_m, double curvature_per_m, double length_m, std::uint32_t detections) {
  Reflector r{};
  r.curve = {{x_m, y_m}, {1.0, 0.0}, curvature_per_m};
  r.covariance = Eigen::Matrix3d::Identity();
  r.occupancy.reset(0.0, length_m - 0.5, 1.0);
  for (double arc = 0.5; arc < length_m; arc += 1.0) r.occupancy.hit(arc);
  r.occupancy.settle();
  r.log_odds = 1.0;
  r.detections = detections;
  return r;
}

TEST(ReflectorSegments, ARailIsOneAndAnArcIsChordsThatLeaveItByLittle) {
  const std::vector<Reflector> reflectors{reflector(0.0, 5.0, 0.0, 60.0, 100), reflector(0.0, -5.0, -0.05, 20.0, 50)};
  const auto out = std::make_unique<ClassifiedScan>();
  write_segments(reflectors, Odometry{}, *out);
  ASSERT_GT(out->number_of_reflector_segments, 3u);
  EXPECT_FLOAT_EQ(out->reflector_segments[0].start_vehicle_m[1], 5.0F);
  EXPECT_FLOAT_EQ(out->reflector_segments[0].end_vehicle_m[0], 60.0F);
  for (std::uint32_t i = 1; i < out->number_of_reflector_segments; ++i) {
    const ReflectorSegment& s = out->reflector_segments[i];
    const Eigen::Vector2d middle(0.5 * (s.start_vehicle_m[0] + s.end_vehicle_m[0]),
                                 0.5 * (s.start_vehicle_m[1] + s.end_vehicle_m[1]));
    EXPECT_LT(std::abs(reflectors[1].curve.distance(middle)), 0.21);
  }
}

TEST(ReflectorSegments, WhatIsLikelierNotThereIsLeftOut) {
  std::vector<Reflector> reflectors{reflector(0.0, 5.0, 0.0, 60.0, 100)};
  reflectors[0].log_odds = -0.1;
  const auto out = std::make_unique<ClassifiedScan>();
  out->number_of_reflector_segments = 7;  // of the scan before
  write_segments(reflectors, Odometry{}, *out);
  EXPECT_EQ(out->number_of_reflector_segments, 0u);
}

TEST(ReflectorSegments, WhereThereIsNoRoomForAllTheRailIsPublished) {
  std::vector<Reflector> reflectors;
  for (int bush = 0; bush < 30; ++bush) reflectors.push_back(reflector(3.0 * bush, 20.0, 0.05, 20.0, 20));
  reflectors.push_back(reflector(0.0, 5.0, 0.0, 60.0, 2000));
  const auto out = std::make_unique<ClassifiedScan>();
  write_segments(reflectors, Odometry{}, *out);
  EXPECT_EQ(out->number_of_reflector_segments, kMaxReflectorSegments);
  EXPECT_EQ(out->reflector_segments[0].number_of_detections, 2000u);
}

}  // namespace
}  // namespace boresight::ghosts
