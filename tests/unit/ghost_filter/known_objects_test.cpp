// Tracks predicted to a scan, and what they are expected to show there.
#include "services/ghost_filter/core/origins/known_objects.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/common/extended_object/detection_count.hpp"

namespace boresight::ghosts {
namespace {

Track& add_known(TrackList& list, const Eigen::Vector2d& position_m, const Eigen::Vector2d& velocity_mps) {
  Track& t = list.tracks[list.number_of_tracks++] = {};
  t.object_class = ObjectClass::kCar;
  t.existence_probability = 0.9F;
  t.heading_rad = 0.4F;
  t.length_m = 4.5F;
  t.width_m = 1.8F;
  t.position_vehicle_m = {static_cast<float>(position_m.x()), static_cast<float>(position_m.y()), 0.5F};
  t.velocity_over_ground_mps = {static_cast<float>(velocity_mps.x()), static_cast<float>(velocity_mps.y())};
  const auto set = [&t](std::size_t row, std::size_t column, float value) {
    t.covariance[row * kTrackStateSize + column] = t.covariance[column * kTrackStateSize + row] = value;
  };
  set(0, 0, 0.4F);
  set(0, 1, 0.1F);
  set(1, 1, 0.2F);
  set(2, 2, 1.0F);
  set(2, 3, -0.3F);
  set(3, 3, 0.5F);
  return t;
}

std::vector<KnownObject> predicted(const TrackList& list, double elapsed_s, double speed_mps, double yaw_rate_radps) {
  ScanGeometry geometry{};
  geometry.ego_speed_mps = static_cast<float>(speed_mps);
  geometry.ego_yaw_rate_radps = static_cast<float>(yaw_rate_radps);
  std::vector<KnownObject> objects;
  objects.reserve(kMaxTracks);
  predict_objects(list, elapsed_s, geometry, objects);
  return objects;
}

/// Where the vehicle is and heads after a time, by small steps.
Eigen::Vector3d driven(double speed_mps, double yaw_rate_radps, double elapsed_s) {
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  constexpr int kSteps = 2000;
  const double step_s = elapsed_s / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const double heading = pose.z() + 0.5 * yaw_rate_radps * step_s;
    pose += step_s * Eigen::Vector3d(speed_mps * std::cos(heading), speed_mps * std::sin(heading), yaw_rate_radps);
  }
  return pose;
}

TEST(PredictObjects, MovesThemAndTheVehicleUnderThem) {
  const Eigen::Vector2d position(30.0, -4.0), velocity(-12.0, 3.0);
  const auto list = std::make_unique<TrackList>();
  add_known(*list, position, velocity);
  struct Motion {
    double elapsed_s, speed_mps, yaw_rate_radps;
  };
  for (const Motion& m : {Motion{0.0, 20.0, 0.3}, Motion{0.1, 20.0, 0.0}, Motion{0.4, 15.0, 0.5},
                          Motion{0.3, -3.0, -0.4}, Motion{-0.2, 15.0, 0.5}, Motion{0.5, 0.0, 0.0}}) {
    const std::vector<KnownObject> objects = predicted(*list, m.elapsed_s, m.speed_mps, m.yaw_rate_radps);
    ASSERT_EQ(objects.size(), 1U);
    const KnownObject& o = objects[0];
    const Eigen::Vector3d pose = driven(m.speed_mps, m.yaw_rate_radps, m.elapsed_s);
    const Eigen::Matrix2d to_new = Eigen::Rotation2Dd(-pose.z()).toRotationMatrix();
    const Eigen::Vector2d place = position + m.elapsed_s * velocity;
    EXPECT_LT((o.observed.box.centre_m - to_new * (place - pose.head<2>())).norm(), 1e-4) << m.elapsed_s;
    EXPECT_LT((o.observed.velocity_mps - to_new * velocity).norm(), 1e-5) << m.elapsed_s;
    EXPECT_NEAR(o.observed.box.heading_rad, 0.4 - pose.z(), 1e-6);
    Eigen::Matrix2d of_position, of_velocity;
    of_position << 0.4, 0.1, 0.1, 0.2;
    of_velocity << 1.0, -0.3, -0.3, 0.5;
    const Eigen::Matrix2d later = of_position + m.elapsed_s * m.elapsed_s * of_velocity;
    EXPECT_LT((o.position_covariance_m2 - to_new * later * to_new.transpose()).norm(), 1e-5);
    EXPECT_LT((o.velocity_covariance_m2ps2 - to_new * of_velocity * to_new.transpose()).norm(), 1e-5);
    EXPECT_FLOAT_EQ(static_cast<float>(o.existence), 0.9F);
    EXPECT_EQ(o.range_rate_offset_mps, 0.0);
  }
}

TEST(PredictObjects, LeavesOutTracksThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto list = std::make_unique<TrackList>();
  add_known(*list, {10.0, 0.0}, {1.0, 0.0}).position_vehicle_m[1] = nan;
  add_known(*list, {11.0, 0.0}, {1.0, 0.0}).velocity_over_ground_mps[0] = std::numeric_limits<float>::infinity();
  add_known(*list, {12.0, 0.0}, {1.0, 0.0}).heading_rad = nan;
  add_known(*list, {13.0, 0.0}, {1.0, 0.0}).length_m = nan;
  add_known(*list, {14.0, 0.0}, {1.0, 0.0}).existence_probability = nan;
  add_known(*list, {15.0, 0.0}, {1.0, 0.0}).covariance[0] = nan;
  const std::vector<KnownObject> objects = predicted(*list, 0.0, 0.0, 0.0);
  ASSERT_EQ(objects.size(), 1U) << "one whose covariance alone is not known stays";
  EXPECT_NEAR(objects[0].observed.box.centre_m.x(), 15.0, 1e-9);
  EXPECT_TRUE(objects[0].position_covariance_m2.allFinite());
}

TEST(PredictObjects, BoundsWhatAMessageMayHold) {
  const auto list = std::make_unique<TrackList>();
  Track& t = add_known(*list, {10.0, 0.0}, {1.0, 0.0});
  t.existence_probability = 1.7F;
  t.length_m = 0.0F;
  t.width_m = -3.0F;
  const std::vector<KnownObject> objects = predicted(*list, 0.0, 0.0, 0.0);
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects[0].existence, 1.0);
  EXPECT_GT(objects[0].observed.box.length_m, 0.0);
  EXPECT_GT(objects[0].observed.box.width_m, 0.0);
  list->number_of_tracks = 100'000;
  EXPECT_LE(predicted(*list, 0.0, 0.0, 0.0).size(), kMaxTracks);
}

KnownObject car(const Eigen::Vector2d& centre_m, double heading_rad, double speed_mps) {
  KnownObject o;
  o.observed.box = {centre_m, heading_rad, 4.5, 1.8};
  o.observed.velocity_mps = speed_mps * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  o.position_covariance_m2 << 0.3, 0.05, 0.05, 0.2;
  o.velocity_covariance_m2ps2 << 0.2, 0.0, 0.0, 0.1;
  o.existence = 1.0;
  return o;
}

SeenDetection seen_from(const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& place_m, double range_rate_mps) {
  SeenDetection d;
  d.position_m = place_m;
  d.range_m = (place_m - sensor_m).norm();
  d.direction = (place_m - sensor_m) / d.range_m;
  d.range_rate_mps = range_rate_mps;
  const double range_std_m = 0.2, across_std_m = 0.008 * d.range_m;
  const Eigen::Vector2d across(-d.direction.y(), d.direction.x());
  d.covariance_m2 = range_std_m * range_std_m * d.direction * d.direction.transpose() +
                    across_std_m * across_std_m * across * across.transpose();
  d.range_rate_variance_m2ps2 = 0.15 * 0.15;
  d.reach_m = 4.0 * std::max(range_std_m, across_std_m);
  return d;
}

TEST(ObjectIntensity, SumsUpToTheExpectedNumberOfDetections) {
  const auto classes = extended_object::object_class_table_defaults();
  const IntensityConfig config;
  const Eigen::Vector2d sensor(3.6, 0.3);
  for (const KnownObject& o : {car({45.0, 4.0}, 0.2, 12.0), car({30.0, -20.0}, 1.9, 8.0)}) {
    ObjectIntensity intensity(o, false, sensor, classes, config);
    const Eigen::Vector2d to_object = (o.observed.box.centre_m - sensor).normalized();
    const double body_mps = to_object.dot(o.observed.velocity_mps);
    constexpr double kPlace_m = 0.35, kRate_mps = 0.25, kHalf_m = 7.0;
    const double half_width_mps = 0.5 * config.ambiguous_width_mps;
    double sum = 0.0;
    for (double x = -kHalf_m; x <= kHalf_m; x += kPlace_m) {
      for (double y = -kHalf_m; y <= kHalf_m; y += kPlace_m) {
        const Eigen::Vector2d place = o.observed.box.centre_m + Eigen::Vector2d(x, y);
        if (!intensity.reaches(seen_from(sensor, place, body_mps))) continue;
        for (double rate = -half_width_mps + 0.5 * kRate_mps; rate < half_width_mps; rate += kRate_mps) {
          sum += intensity.at(seen_from(sensor, place, body_mps + rate)) * kPlace_m * kPlace_m * kRate_mps;
        }
      }
    }
    const double range_m = (o.observed.box.centre_m - sensor).norm();
    const Eigen::Vector2d towards = Eigen::Rotation2Dd(-o.observed.box.heading_rad) * -to_object;
    const double n =
        extended_object::expected_detections(extended_object::model_of(classes, o.road_user).count, range_m, towards);
    EXPECT_NEAR(sum / n, 1.0, 0.04);
  }
}

TEST(ObjectIntensity, IsTheSameForASceneThatIsTurnedAsAWhole) {
  const auto classes = extended_object::object_class_table_defaults();
  const IntensityConfig config;
  const Eigen::Vector2d sensor(3.6, 0.3);
  KnownObject o = car({35.0, 6.0}, 0.3, 14.0);
  o.range_rate_offset_mps = -0.7;
  for (const double turn_rad : {0.9, M_PI, -2.2}) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(turn_rad).toRotationMatrix();
    KnownObject turned = o;
    turned.observed.box.centre_m = turn * o.observed.box.centre_m;
    turned.observed.box.heading_rad += turn_rad;
    turned.observed.velocity_mps = turn * o.observed.velocity_mps;
    turned.position_covariance_m2 = turn * o.position_covariance_m2 * turn.transpose();
    turned.velocity_covariance_m2ps2 = turn * o.velocity_covariance_m2ps2 * turn.transpose();
    ObjectIntensity a(o, false, sensor, classes, config), b(turned, false, turn * sensor, classes, config);
    for (const Eigen::Vector2d& offset :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(-2.0, 0.5), Eigen::Vector2d(1.0, 3.0)}) {
      const Eigen::Vector2d place = o.observed.box.centre_m + offset;
      for (const double rate : {12.0, 0.0, -20.0}) {
        const double value = a.at(seen_from(sensor, place, rate));
        EXPECT_GT(value, 0.0);
        EXPECT_NEAR(b.at(seen_from(turn * sensor, turn * place, rate)) / value, 1.0, 1e-6);
      }
    }
  }
}

TEST(ObjectIntensity, IsLargestAtTheBodyAndItsRangeRate) {
  const auto classes = extended_object::object_class_table_defaults();
  const IntensityConfig config;
  const Eigen::Vector2d sensor(0.0, 0.0), rear(37.75, 0.0);
  const KnownObject o = car({40.0, 0.0}, 0.0, 15.0);
  ObjectIntensity intensity(o, false, sensor, classes, config);
  const double best = intensity.at(seen_from(sensor, rear, 15.0));
  EXPECT_GT(best, 100.0 * intensity.at(seen_from(sensor, rear, -15.0))) << "another range rate";
  EXPECT_GT(best, 100.0 * intensity.at(seen_from(sensor, rear + Eigen::Vector2d(0.0, 4.5), 15.0))) << "another place";
  // A Doppler-ambiguous one has the share and width of these alone.
  const double flat = intensity.at(seen_from(sensor, rear, -30.0));
  EXPECT_NEAR(flat / intensity.at(seen_from(sensor, rear, -22.0)), 1.0, 1e-3);
  EXPECT_GT(flat, 0.0);
}

TEST(ObjectIntensity, AnImageHasNoAmbiguousDetectionsAndItsExistenceIsAFactor) {
  const auto classes = extended_object::object_class_table_defaults();
  const IntensityConfig config;
  const Eigen::Vector2d sensor(0.0, 0.0), rear(37.75, 0.0);
  KnownObject o = car({40.0, 0.0}, 0.0, 15.0);
  ObjectIntensity object(o, false, sensor, classes, config), image(o, true, sensor, classes, config);
  const SeenDetection fits = seen_from(sensor, rear, 15.0), wrong = seen_from(sensor, rear, -30.0);
  EXPECT_NEAR(image.at(fits) / object.at(fits), 1.0 / (1.0 - config.ambiguous_share), 1e-3);
  EXPECT_LT(image.at(wrong), 1e-9 * image.at(fits));
  EXPECT_GT(object.at(wrong), 1e-6 * object.at(fits));
  o.existence = 0.25;
  ObjectIntensity doubtful(o, true, sensor, classes, config);
  EXPECT_NEAR(doubtful.at(fits) / image.at(fits), 0.25, 1e-9);
}

TEST(ObjectIntensity, ReachesAsFarAsThereIsAnyIntensity) {
  const auto classes = extended_object::object_class_table_defaults();
  const IntensityConfig config;
  const Eigen::Vector2d sensor(0.0, 0.0);
  const KnownObject o = car({40.0, 0.0}, 0.0, 15.0);
  ObjectIntensity intensity(o, false, sensor, classes, config);
  const double best = intensity.at(seen_from(sensor, {37.75, 0.0}, 15.0));
  bool was_reached = false, was_left = false;
  for (double away = 0.0; away < 20.0; away += 0.25) {
    for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(-0.6, 0.8)}) {
      const SeenDetection d = seen_from(sensor, o.observed.box.centre_m + away * direction, 15.0);
      const bool reached = intensity.reaches(d);
      (reached ? was_reached : was_left) = true;
      if (!reached) {
        EXPECT_LT(intensity.at(d), 1e-6 * best) << away;
      }
      if (away <= 2.4) {
        EXPECT_TRUE(reached) << "within its circle";
      }
    }
  }
  EXPECT_TRUE(was_reached && was_left);
}

}  // namespace
}  // namespace boresight::ghosts
