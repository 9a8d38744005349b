// Mirror images against paths that are found independently: by mirroring a point, and by the shortest way.
#include "services/ghost_filter/core/origins/mirror_images.hpp"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

Mirror mirror_of(const Segment& segment) {
  IntensityConfig config;
  config.mirror_share_per_m = 1.0;
  config.most_mirror_share = 0.5;
  std::vector<Mirror> mirrors;
  mirrors.reserve(1);
  place_mirrors({&segment, 1}, Odometry{}, config, mirrors);
  return mirrors.at(0);
}

struct MirrorScene {
  Eigen::Vector2d begin_m{-50.0, 8.0}, end_m{70.0, 8.0};  // of the mirror
  Eigen::Vector2d sensor_m{0.0, 0.0}, sensor_velocity_mps{0.0, 0.0};
  Eigen::Vector2d object_m{0.0, 0.0}, velocity_mps{0.0, 0.0};
};

Segment segment_of(const MirrorScene& s) {
  const double length_m = (s.end_m - s.begin_m).norm();
  return {s.begin_m, s.end_m, 0.4, 16, 100, length_m};
}

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
  SightOfImages sight{s.sensor_m, s.sensor_velocity_mps, {}, 0.0};
  for (double x = 0.0; x < 512.0; x += 4.0) {
    for (double y = 0.0; y < 512.0; y += 4.0) sight.places.add({x, y});
  }
  return sight;
}

std::vector<MirrorImage> images_of(const MirrorScene& s, double least_existence = 0.5) {
  const Mirror mirror = mirror_of(segment_of(s));
  const KnownObject object = object_of(s);
  std::vector<MirrorImage> images;
  images.reserve(16);
  place_images({&object, 1}, {&mirror, 1}, sight_of(s), least_existence, images);
  return images;
}

/// Shortest way from a sensor over the mirror to an object, and the direction in which it departs.
struct Way {
  double length_m;
  Eigen::Vector2d departure;
};
Way shortest(const MirrorScene& s, const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& object_m) {
  const auto point = [&](double share) { return Eigen::Vector2d(s.begin_m + share * (s.end_m - s.begin_m)); };
  const auto length = [&](double share) { return (point(share) - sensor_m).norm() + (object_m - point(share)).norm(); };
  double from = 0.0, to = 1.0;
  for (int round = 0; round < 200; ++round) {
    const double a = from + (to - from) / 3.0, b = to - (to - from) / 3.0;
    (length(a) < length(b) ? to : from) = length(a) < length(b) ? b : a;
  }
  return {length(0.5 * (from + to)), (point(0.5 * (from + to)) - sensor_m).normalized()};
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
    const double over_mirror = shortest(s, sensor, object).length_m, direct = (object - sensor).norm();
    return bounces == Bounces::kThree ? over_mirror : 0.5 * (over_mirror + direct);
  };
  const Eigen::Vector2d direction = bounces == Bounces::kTwoLastOnObject
                                        ? Eigen::Vector2d((s.object_m - s.sensor_m).normalized())
                                        : shortest(s, s.sensor_m, s.object_m).departure;
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
  s.sensor_m = {3.6, 0.5};
  s.object_m = {30.0, 2.0};
  s.velocity_mps = {-9.0, 1.5};
  return s;
}

MirrorScene turned(const MirrorScene& s, double turn_rad, const Eigen::Vector2d& shift_m) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(turn_rad).toRotationMatrix();
  MirrorScene t = s;
  t.begin_m = turn * s.begin_m + shift_m;
  t.end_m = turn * s.end_m + shift_m;
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

TEST(MirrorImages, ExistAsSurelyAsObjectAndMirror) {
  const std::vector<MirrorImage> images = images_of(beside_a_wall());
  ASSERT_EQ(images.size(), 3U);
  for (const MirrorImage& image : images) EXPECT_NEAR(image.object.existence, 0.9 * 0.5, 1e-12);
}

TEST(MirrorImages, AreLessSureOfTheirPlaceThanTheObject) {
  for (const MirrorImage& image : images_of(beside_a_wall())) {
    EXPECT_GT(image.object.position_covariance_m2.trace(), 0.5 + 8.0 * 0.4 * 0.4 / 16.0)
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
  s.end_m = {12.0, 8.0};  // the wave turns at x = 18
  EXPECT_TRUE(images_of(s).empty());
}

TEST(MirrorImages, OfDoubtfulObjectsThereAreNone) {
  EXPECT_TRUE(images_of(beside_a_wall(), 0.95).empty());
}

TEST(MirrorImages, AreWorkedOutOnlyWhereDetectionsAre) {
  const MirrorScene s = beside_a_wall();
  const std::vector<MirrorImage> all = images_of(s);
  ASSERT_EQ(all.size(), 3U);
  const Mirror mirror = mirror_of(segment_of(s));
  const KnownObject object = object_of(s);
  std::vector<MirrorImage> images;
  images.reserve(16);
  const auto with_detection_at = [&](const Eigen::Vector2d& place_m) {
    SightOfImages sight{s.sensor_m, s.sensor_velocity_mps, {}, 0.0};
    sight.places.add(place_m);
    place_images({&object, 1}, {&mirror, 1}, sight, 0.5, images);
    return images.size();
  };
  EXPECT_GE(with_detection_at(all.front().object.observed.box.centre_m), 1U);
  EXPECT_EQ(with_detection_at(s.sensor_m - 3.0 * (s.object_m - s.sensor_m)), 0U) << "opposite";
}

TEST(OccupiedPlaces, HoldWhatIsWithinAWidthOfADetection) {
  OccupiedPlaces none;
  EXPECT_FALSE(none.may_hold({10.0, 0.0}, 5.0)) << "no detection at all";
  EXPECT_TRUE(none.may_hold({10.0, 0.0}, 300.0)) << "wider than the grid: not known";
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> at(-200.0, 200.0), width(0.1, 20.0);
  int held = 0;
  for (int i = 0; i < 5000; ++i) {
    OccupiedPlaces one;
    const Eigen::Vector2d detection(at(random), at(random)), place(at(random), at(random));
    const double half_width = width(random), apart = (detection - place).lpNorm<Eigen::Infinity>();
    one.add(detection);
    const bool holds = one.may_hold(place, half_width);
    held += holds ? 1 : 0;
    if (apart <= half_width) {
      EXPECT_TRUE(holds);
    }
    if (apart > half_width + 8.0) {
      EXPECT_FALSE(holds);
    }
  }
  EXPECT_GT(held, 10);
}

TEST(MirrorImages, StopAtTheRoomThatThereIs) {
  const MirrorScene s = beside_a_wall();
  const Mirror mirror = mirror_of(segment_of(s));
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
  const std::vector<Segment> reflectors = {{{0.0, 0.0}, {10.0, 0.0}, 0.1, 9, 90, 10.0},
                                           {{0.0, 5.0}, {20.0, 5.0}, 0.1, 9, 90, 100.0}};
  place_mirrors(reflectors, Odometry{}, config, mirrors);
  ASSERT_EQ(mirrors.size(), 2U);
  EXPECT_NEAR(mirrors[0].probability, 0.1, 1e-9);
  EXPECT_NEAR(mirrors[1].probability, 0.6, 1e-9);
  config.least_mirror_share = 0.2;
  place_mirrors(reflectors, Odometry{}, config, mirrors);
  ASSERT_EQ(mirrors.size(), 1U) << "the short one is no mirror";
  EXPECT_NEAR(mirrors[0].probability, 0.6, 1e-9);
}

TEST(PlaceMirrors, TheVarianceIsThatOfALineThroughScatteredPoints) {
  // Against lines fitted to points with known noise.
  constexpr double kScatter_m = 0.3, kLength_m = 20.0;
  constexpr int kPoints = 24, kRuns = 4000;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, kScatter_m);
  double at_middle = 0.0, at_end = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Eigen::Matrix<double, kPoints, 2> design;
    Eigen::Matrix<double, kPoints, 1> across;
    for (int k = 0; k < kPoints; ++k) {
      design.row(k) << 1.0, kLength_m * ((k + 0.5) / kPoints - 0.5);
      across(k) = noise(random);
    }
    const Eigen::Vector2d line = (design.transpose() * design).ldlt().solve(design.transpose() * across);
    at_middle += line(0) * line(0) / kRuns;
    at_end += std::pow(line(0) + 0.5 * kLength_m * line(1), 2) / kRuns;
  }
  const Mirror mirror = mirror_of({{0.0, 0.0}, {kLength_m, 0.0}, kScatter_m, kPoints, 100, kLength_m});
  EXPECT_NEAR(mirror.offset_variance_m2(0.5 * kLength_m), at_middle, 0.1 * at_middle);
  EXPECT_NEAR(mirror.offset_variance_m2(kLength_m), at_end, 0.1 * at_end);
}

}  // namespace
}  // namespace boresight::ghosts
