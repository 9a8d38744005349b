// Mirror images against paths that are found independently: by mirroring a point, and by the shortest way over an arc.
#include "services/ghost_filter/core/origins/mirror_images.hpp"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

/// A reflector that was seen from end to end.
Reflector seen_reflector(const Curve& curve, double begin_m, double end_m) {
  Reflector r{};
  r.curve = curve;
  r.covariance = Eigen::Vector3d(0.01, 1e-5, 1e-8).asDiagonal();
  r.occupancy.reset(begin_m, end_m - 0.01, 1.0);
  for (int round = 0; round < 6; ++round) {
    for (double arc = begin_m + 0.5; arc < end_m; arc += 1.0) r.occupancy.hit(arc);
    r.occupancy.settle();
  }
  r.log_odds = 30.0;
  return r;
}

Mirror mirror_of(const Reflector& r) {
  IntensityConfig config;
  config.mirror_share_per_m = 1.0;
  config.most_mirror_share = 0.5;
  std::vector<Mirror> mirrors;
  mirrors.reserve(1);
  place_mirrors({&r, 1}, Odometry{}, config, mirrors);
  return mirrors.at(0);
}

struct MirrorScene {
  Curve curve;
  Eigen::Vector2d sensor_m{0.0, 0.0}, sensor_velocity_mps{0.0, 0.0};
  Eigen::Vector2d object_m{0.0, 0.0}, velocity_mps{0.0, 0.0};
  double begin_m = -60.0, end_m = 60.0;
};

KnownObject object_of(const MirrorScene& s) {
  KnownObject o;
  o.observed.box = {s.object_m, 0.3, 4.5, 1.8};
  o.observed.velocity_mps = s.velocity_mps;
  o.position_covariance_m2 << 0.3, 0.1, 0.1, 0.2;
  o.velocity_covariance_m2ps2 << 0.4, -0.1, -0.1, 0.3;
  o.existence = 0.9;
  return o;
}

/// Of a scan with detections everywhere.
SightOfImages sight_of(const MirrorScene& s) {
  SightOfImages sight{s.sensor_m, s.sensor_velocity_mps, {}, 1e3, 0.0};
  for (double azimuth = -3.14; azimuth < 3.15; azimuth += 0.01) sight.directions.add(azimuth);
  return sight;
}

std::vector<MirrorImage> images_of(const MirrorScene& s, double least_existence = 0.5) {
  const Reflector reflector = seen_reflector(s.curve, s.begin_m, s.end_m);
  const Mirror mirror = mirror_of(reflector);
  const KnownObject object = object_of(s);
  std::vector<MirrorImage> images;
  images.reserve(16);
  place_images({&object, 1}, {&mirror, 1}, sight_of(s), least_existence, images);
  return images;
}

/// Shortest way from a sensor over the curve to an object, and the direction in which it departs.
struct Way {
  double length_m;
  Eigen::Vector2d departure;
};
Way shortest(const Curve& curve, const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& object_m) {
  const auto point = [&](double arc) {
    const double angle = curve.curvature_per_m * arc;
    if (curve.curvature_per_m == 0.0) return Eigen::Vector2d(curve.origin_m + arc * curve.tangent);
    const Eigen::Vector2d normal(-curve.tangent.y(), curve.tangent.x());
    const double radius = 1.0 / curve.curvature_per_m;
    return Eigen::Vector2d(curve.origin_m + radius * normal +
                           radius * (std::sin(angle) * curve.tangent - std::cos(angle) * normal));
  };
  const auto length = [&](double arc) { return (point(arc) - sensor_m).norm() + (object_m - point(arc)).norm(); };
  double from = -60.0, to = 60.0;
  for (int round = 0; round < 200; ++round) {
    const double a = from + (to - from) / 3.0, b = to - (to - from) / 3.0;
    (length(a) < length(b) ? to : from) = length(a) < length(b) ? b : a;
  }
  const double arc = 0.5 * (from + to);
  return {length(arc), (point(arc) - sensor_m).normalized()};
}

/// Range and direction at which a path shows the object, and its range rate over ground: as measured, by the change of
/// the range, less that of a stationary reflector in the same direction.
struct SeenPath {
  Eigen::Vector2d place_m;
  double range_rate_mps;
};
enum class Bounces { kThree, kTwoLastOnMirror, kTwoLastOnObject };
SeenPath seen_path(const MirrorScene& s, Bounces bounces) {
  const auto range_after = [&](double t) {
    const Eigen::Vector2d sensor = s.sensor_m + t * s.sensor_velocity_mps, object = s.object_m + t * s.velocity_mps;
    const double over_mirror = shortest(s.curve, sensor, object).length_m, direct = (object - sensor).norm();
    return bounces == Bounces::kThree ? over_mirror : 0.5 * (over_mirror + direct);
  };
  const Eigen::Vector2d direction = bounces == Bounces::kTwoLastOnObject
                                        ? Eigen::Vector2d((s.object_m - s.sensor_m).normalized())
                                        : shortest(s.curve, s.sensor_m, s.object_m).departure;
  constexpr double kStep_s = 1e-3;
  const double measured_mps = (range_after(kStep_s) - range_after(-kStep_s)) / (2.0 * kStep_s);
  return {s.sensor_m + range_after(0.0) * direction, measured_mps + direction.dot(s.sensor_velocity_mps)};
}

/// What the image says of its centre.
double range_rate_of(const MirrorImage& image, const Eigen::Vector2d& sensor_m) {
  const extended_object::ObservedObject& o = image.object.observed;
  return (o.box.centre_m - sensor_m).normalized().dot(o.velocity_mps) + image.object.range_rate_offset_mps;
}

/// The three images in the order: three bounces, two with the last on the mirror, two with the last on the object.
void expect_paths(const MirrorScene& s, double place_tolerance_m, double rate_tolerance_mps) {
  const std::vector<MirrorImage> images = images_of(s);
  ASSERT_EQ(images.size(), 3U);
  const Bounces bounces[] = {Bounces::kThree, Bounces::kTwoLastOnMirror, Bounces::kTwoLastOnObject};
  for (std::size_t k = 0; k < 3; ++k) {
    const SeenPath path = seen_path(s, bounces[k]);
    EXPECT_EQ(images[k].is_type1, bounces[k] == Bounces::kTwoLastOnObject);
    EXPECT_LT((images[k].object.observed.box.centre_m - path.place_m).norm(), place_tolerance_m) << "path " << k;
    EXPECT_NEAR(range_rate_of(images[k], s.sensor_m), path.range_rate_mps, rate_tolerance_mps) << "path " << k;
  }
}

MirrorScene beside_a_wall() {
  MirrorScene s;
  s.curve = {{10.0, 8.0}, {1.0, 0.0}, 0.0};
  s.sensor_m = {3.6, 0.5};
  s.object_m = {30.0, 2.0};
  s.velocity_mps = {-9.0, 1.5};
  return s;
}

MirrorScene turned(const MirrorScene& s, double turn_rad, const Eigen::Vector2d& shift_m) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(turn_rad).toRotationMatrix();
  MirrorScene t = s;
  t.curve.origin_m = turn * s.curve.origin_m + shift_m;
  t.curve.tangent = turn * s.curve.tangent;
  t.sensor_m = turn * s.sensor_m + shift_m;
  t.object_m = turn * s.object_m + shift_m;
  t.sensor_velocity_mps = turn * s.sensor_velocity_mps;
  t.velocity_mps = turn * s.velocity_mps;
  return t;
}

TEST(MirrorImages, OfAWallLieWhereTheMirroredPointDoes) {
  const MirrorScene s = beside_a_wall();
  const std::vector<MirrorImage> images = images_of(s);
  ASSERT_EQ(images.size(), 3U);
  const Eigen::Vector2d mirrored(30.0, 14.0);  // y = 2 mirrored at y = 8
  const extended_object::ObservedObject& image = images[0].object.observed;
  EXPECT_LT((image.box.centre_m - mirrored).norm(), 1e-6);
  EXPECT_LT((image.velocity_mps - Eigen::Vector2d(-9.0, -1.5)).norm(), 1e-9);
  EXPECT_NEAR(std::remainder(image.box.heading_rad + 0.3, 2.0 * M_PI), 0.0, 1e-9);
  EXPECT_EQ(image.box.length_m, 4.5);
  EXPECT_EQ(images[0].object.range_rate_offset_mps, 0.0);
}

TEST(MirrorImages, OfAWallHaveTheRangesAndRangeRatesOfTheirPaths) {
  MirrorScene s = beside_a_wall();
  expect_paths(s, 1e-6, 1e-4);
  s.sensor_velocity_mps = {18.0, 1.0};
  expect_paths(s, 1e-6, 1e-4);
  s.velocity_mps = {0.0, 0.0};
  expect_paths(s, 1e-6, 1e-4);
}

TEST(MirrorImages, OfATurnedSceneAreTurned) {
  MirrorScene s = beside_a_wall();
  s.sensor_velocity_mps = {15.0, -2.0};
  const std::vector<MirrorImage> as_it_is = images_of(s);
  for (const double turn_rad : {0.6, 2.5, -1.9}) {
    const Eigen::Vector2d shift(-20.0, 35.0);
    const MirrorScene t = turned(s, turn_rad, shift);
    expect_paths(t, 1e-6, 1e-4);
    const std::vector<MirrorImage> images = images_of(t);
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(turn_rad).toRotationMatrix();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d expected = turn * as_it_is[k].object.observed.box.centre_m + shift;
      EXPECT_LT((images[k].object.observed.box.centre_m - expected).norm(), 1e-6);
    }
  }
}

TEST(MirrorImages, OfAnArcHaveTheRangesAndRangeRatesOfTheirPaths) {
  // The specular point is known to 5 mm of the path's length: at these ranges some 0.02 rad of direction.
  for (const double curvature_per_m : {0.01, 0.02, -0.005, -0.01}) {
    for (const double turn_rad : {0.0, 1.2}) {
      MirrorScene s = beside_a_wall();
      s.curve.curvature_per_m = curvature_per_m;
      s.sensor_velocity_mps = {15.0, 0.0};
      expect_paths(turned(s, turn_rad, {4.0, -3.0}), 0.6, 0.4);
    }
  }
}

TEST(MirrorImages, OfAnArcHaveTheLengthOfTheShortestWay) {
  for (const double curvature_per_m : {0.01, 0.02, -0.005, -0.01}) {
    MirrorScene s = beside_a_wall();
    s.curve.curvature_per_m = curvature_per_m;
    const std::vector<MirrorImage> images = images_of(s);
    ASSERT_EQ(images.size(), 3U);
    const double over_mirror = shortest(s.curve, s.sensor_m, s.object_m).length_m;
    const double direct = (s.object_m - s.sensor_m).norm();
    const auto range = [&](std::size_t k) { return (images[k].object.observed.box.centre_m - s.sensor_m).norm(); };
    EXPECT_NEAR(range(0), over_mirror, 0.01);
    EXPECT_NEAR(range(1), 0.5 * (over_mirror + direct), 0.01);
    EXPECT_NEAR(range(2), 0.5 * (over_mirror + direct), 0.01);
  }
}

TEST(MirrorImages, ExistAsSurelyAsObjectAndMirror) {
  const std::vector<MirrorImage> images = images_of(beside_a_wall());
  ASSERT_EQ(images.size(), 3U);
  // The reflector mirrors with 0.5; it is there with nearly 1.
  for (const MirrorImage& image : images) EXPECT_NEAR(image.object.existence, 0.9 * 0.5, 0.02);
}

TEST(MirrorImages, AreLessSureOfTheirPlaceThanTheObject) {
  for (const MirrorImage& image : images_of(beside_a_wall())) {
    EXPECT_GT(image.object.position_covariance_m2.trace(), 0.5 + 8.0 * 0.01)
        << "twice the mirror's shift, in each axis";
    EXPECT_NEAR(image.object.velocity_covariance_m2ps2.trace(), 0.7, 1e-9);
  }
}

TEST(MirrorImages, OfAnObjectBehindTheMirrorThereAreNone) {
  MirrorScene s = beside_a_wall();
  s.object_m = {30.0, 9.0};
  EXPECT_TRUE(images_of(s).empty());
  s.object_m = {30.0, 8.0};
  EXPECT_TRUE(images_of(s).empty()) << "on it";
}

TEST(MirrorImages, BeyondTheEndsOfTheMirrorThereAreNone) {
  MirrorScene s = beside_a_wall();
  s.begin_m = -60.0;
  s.end_m = 2.0;  // the wave turns at x = 18: 8 m along
  EXPECT_TRUE(images_of(s).empty());
}

TEST(MirrorImages, OfDoubtfulObjectsThereAreNone) {
  EXPECT_TRUE(images_of(beside_a_wall(), 0.95).empty());
}

TEST(MirrorImages, AreWorkedOutOnlyWhereDetectionsAre) {
  const MirrorScene s = beside_a_wall();
  const std::vector<MirrorImage> all = images_of(s);
  ASSERT_EQ(all.size(), 3U);
  const Reflector reflector = seen_reflector(s.curve, s.begin_m, s.end_m);
  const Mirror mirror = mirror_of(reflector);
  const KnownObject object = object_of(s);
  std::vector<MirrorImage> images;
  images.reserve(16);
  const auto towards = [&](const Eigen::Vector2d& place_m, double farthest_m) {
    SightOfImages sight{s.sensor_m, s.sensor_velocity_mps, {}, farthest_m, 0.0};
    const Eigen::Vector2d way = place_m - s.sensor_m;
    sight.directions.add(std::atan2(way.y(), way.x()));
    place_images({&object, 1}, {&mirror, 1}, sight, 0.5, images);
    return images.size();
  };
  EXPECT_EQ(towards(all.front().object.observed.box.centre_m, 1e3) >= 2U, true) << "both images of type 2";
  EXPECT_EQ(towards(s.sensor_m - (s.object_m - s.sensor_m), 1e3), 0U) << "opposite";
  EXPECT_EQ(towards(all.front().object.observed.box.centre_m, 1.0), 0U) << "all detections are nearer";
}

TEST(Directions, HoldWhatIsWithinAWidthOfADetection) {
  Directions directions;
  EXPECT_FALSE(directions.may_hold({10.0, 0.0}, 5.0)) << "no detection at all";
  directions.add(M_PI - 0.01);
  EXPECT_TRUE(directions.may_hold({-10.0, -0.01}, 1.0)) << "across the turn from π to −π";
  EXPECT_FALSE(directions.may_hold({10.0, 0.0}, 1.0));
  EXPECT_TRUE(directions.may_hold({0.5, 0.0}, 1.0)) << "the sensor is within the width";
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), width(0.1, 5.0);
  for (int i = 0; i < 1000; ++i) {
    Directions one;
    const double at = angle(random), about = angle(random), w = width(random), range = 20.0;
    one.add(at);
    const Eigen::Vector2d place(range * std::cos(about), range * std::sin(about));
    const double apart = std::abs(std::remainder(at - about, 2.0 * M_PI));
    if (apart < std::asin(w / range)) {
      EXPECT_TRUE(one.may_hold(place, w)) << at << " " << about;
    }
    if (apart > std::asin(w / range) + 0.2) {
      EXPECT_FALSE(one.may_hold(place, w)) << at << " " << about;
    }
  }
}

TEST(MirrorImages, StopAtTheRoomThatThereIs) {
  const MirrorScene s = beside_a_wall();
  const Reflector reflector = seen_reflector(s.curve, s.begin_m, s.end_m);
  const Mirror mirror = mirror_of(reflector);
  const std::vector<KnownObject> objects(5, object_of(s));
  std::vector<MirrorImage> images;
  images.reserve(7);
  const std::size_t room = images.capacity();
  place_images(objects, {&mirror, 1}, sight_of(s), 0.5, images);
  EXPECT_EQ(images.size(), room);
  EXPECT_EQ(images.capacity(), room);
}

TEST(PlaceMirrors, LongReflectorsMirrorMoreOftenUpToALimit) {
  IntensityConfig config;
  config.mirror_share_per_m = 0.01;
  config.most_mirror_share = 0.6;
  config.least_mirror_share = 0.0;
  std::vector<Mirror> mirrors;
  mirrors.reserve(4);
  const std::vector<Reflector> reflectors = {seen_reflector({}, 0.0, 10.0), seen_reflector({}, 0.0, 100.0)};
  place_mirrors(reflectors, Odometry{}, config, mirrors);
  ASSERT_EQ(mirrors.size(), 2U);
  EXPECT_NEAR(mirrors[0].probability, 0.1, 1e-9);
  EXPECT_NEAR(mirrors[1].probability, 0.6, 1e-9);
  config.least_mirror_share = 0.2;
  place_mirrors(reflectors, Odometry{}, config, mirrors);
  ASSERT_EQ(mirrors.size(), 1U) << "the short one is no mirror";
  EXPECT_NEAR(mirrors[0].probability, 0.6, 1e-9);
}

}  // namespace
}  // namespace boresight::ghosts
