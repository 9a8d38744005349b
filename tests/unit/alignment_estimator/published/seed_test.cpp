// Effect of a static calibration on the published methods.
#include <limits>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/published/planar_world.hpp"

namespace boresight::alignment::published {
namespace {

constexpr Kind kThreeAxes[] = {Kind::kSteepestDescent, Kind::kLeastSquares, Kind::kTotalLeastSquares,
                               Kind::kNelderMead};
constexpr std::uint32_t kAngles =
    alignment_axis::kVehicleYaw | alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll;

/// d of R(actual) = Exp(d)·R(nominal) for a radar with these angles added.
Eigen::Vector3d turn_of(const MountingPose& nominal, const Eigen::Vector3d& angles_rad) {
  return geometry::so3_log(geometry::sensor_to_vehicle(nominal, angles_rad(0), angles_rad(1), angles_rad(2)) *
                           geometry::sensor_to_vehicle(nominal, 0.0, 0.0, 0.0).transpose());
}

/// 0.05° about the vehicle's y and z axes, 0.5° about x, correlated.
Eigen::Matrix3d plate_covariance() {
  const Eigen::Vector3d stds = Eigen::Vector3d(0.5, 0.05, 0.05) * kRadiansPerDegree;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
  correlation(0, 1) = correlation(1, 0) = 0.4;
  return stds.asDiagonal() * correlation * stds.asDiagonal();
}

TEST(PublishedSeed, IsTheStartOfTheMethod) {
  for (const Kind kind : kThreeAxes) {
    SCOPED_TRACE(static_cast<int>(kind));
    PlanarWorld world;
    world.vehicle.radars[1].mounting_pose.pitch_rad = 0.03;
    const auto method = make_published(kind, world.vehicle, as_published());
    const RadarEstimate other = method->estimate(0);
    const Eigen::Vector3d angles = Eigen::Vector3d(1.2, -0.7, 0.4) * kRadiansPerDegree;
    {
      const runtime::CountAllocations counting;
      ASSERT_TRUE(method->seed(1, turn_of(world.vehicle.radars[1].mounting_pose, angles), plate_covariance()));
    }
    EXPECT_EQ(runtime::counted_allocations(), 0u);
    EXPECT_LT((parameters(*method, 1).tail<3>() - angles).norm(), 1e-12);
    EXPECT_EQ(parameters(*method, 1)(0), 1.0) << "a plate does not measure the speed scale";

    const RadarEstimate seeded = method->estimate(1);
    EXPECT_EQ(seeded.observable, kAngles);
    // The prior of 4° adds next to nothing.
    EXPECT_LT((seeded.covariance.bottomRightCorner<3, 3>() - plate_covariance()).norm(),
              0.03 * plate_covariance().norm());
    EXPECT_EQ(method->estimate(0).sensor_to_vehicle, other.sensor_to_vehicle);
    EXPECT_EQ(method->estimate(0).covariance, other.covariance);
    EXPECT_EQ(method->estimate(0).observable, 0u);
  }
}

TEST(PublishedSeed, ReplacesTheEstimate) {
  PlanarWorld world;
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  world.drive(*method, 1'000);
  const Eigen::Vector3d angles = Eigen::Vector3d(-3.0, 2.0, 1.0) * kRadiansPerDegree;  // remounted at another angle
  ASSERT_TRUE(method->seed(2, turn_of(world.vehicle.radars[2].mounting_pose, angles), plate_covariance()));
  const RadarEstimate seeded = method->estimate(2);
  EXPECT_LT((parameters(*method, 2).tail<3>() - angles).norm(), 1e-12);
  EXPECT_EQ(seeded.seconds_of_drive, 0.0);
  EXPECT_LT((seeded.covariance.bottomRightCorner<3, 3>() - plate_covariance()).norm(),
            0.03 * plate_covariance().norm());
  EXPECT_GT(method->estimate(0).seconds_of_drive, 40.0);
}

TEST(PublishedSeed, SavesTheDrivingThatTheMethodWouldNeed) {
  // Nelder–Mead alone needs about five thousand scans for pitch and roll.
  PlanarWorld seeded_world, plain_world;
  seeded_world.noise_mps = plain_world.noise_mps = 0.03;
  const auto seeded = make_published(Kind::kNelderMead, seeded_world.vehicle, as_published());
  const auto plain = make_published(Kind::kNelderMead, plain_world.vehicle, as_published());
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Vector3d angles =
        seeded_world.truth[r].tail<3>() + Eigen::Vector3d(0.05, -0.05, 0.1) * kRadiansPerDegree;
    ASSERT_TRUE(seeded->seed(r, turn_of(seeded_world.vehicle.radars[r].mounting_pose, angles), plate_covariance()));
  }
  seeded_world.drive(*seeded, 1'000);
  plain_world.drive(*plain, 1'000);
  const auto worst_deg = [](const Method& method, const PlanarWorld& world) {
    double worst = 0.0;
    for (std::size_t r = 0; r < 4; ++r) {
      const Eigen::Vector3d error = (parameters(method, r) - world.truth[r]).tail<3>();
      worst = std::max(worst, error.cwiseAbs().maxCoeff() / kRadiansPerDegree);
    }
    return worst;
  };
  EXPECT_LT(worst_deg(*seeded, seeded_world), 0.4);
  EXPECT_GT(worst_deg(*plain, plain_world), 0.8);
}

TEST(PublishedSeed, DecaysLikeAnyScan) {
  // The steps do not weight by the seed, so its weight in the covariance must decay.
  PlanarWorld world;
  world.noise_mps = 0.03;
  const auto with_seed = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  ASSERT_TRUE(with_seed->seed(0, Eigen::Vector3d::Zero(), 1e-6 * plate_covariance()));
  world.drive(*with_seed, 200);  // ten of the sixty seconds of the window
  const double early = with_seed->estimate(0).covariance(2, 2);
  world.drive(*with_seed, 6'000);
  EXPECT_GT(with_seed->estimate(0).covariance(2, 2), 20.0 * early);
}

TEST(PublishedSeed, StaysIfTheSensorMeasuresNoElevation) {
  PlanarWorld world;
  world.measures_elevation = false;
  for (Eigen::Vector4d& truth : world.truth) truth(3) = 0.0;
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  const Eigen::Vector3d pitch_only(0.0, world.truth[0](2), 0.0);
  ASSERT_TRUE(method->seed(0, turn_of(world.vehicle.radars[0].mounting_pose, pitch_only), plate_covariance()));
  world.drive(*method, 4'000);
  EXPECT_NEAR(parameters(*method, 0)(2), world.truth[0](2), 1e-12);
  EXPECT_NEAR(parameters(*method, 0)(3), 0.0, 1e-12);
  EXPECT_NEAR(parameters(*method, 0)(1), world.truth[0](1), 0.05 * kRadiansPerDegree);
  EXPECT_NE(method->estimate(0).observable & alignment_axis::kVehiclePitch, 0u);
  EXPECT_EQ(method->estimate(1).observable & alignment_axis::kVehiclePitch, 0u) << "not seeded";
}

TEST(PublishedSeed, IsRefusedWhereItCannotBeUsed) {
  PlanarWorld world;
  const auto method = make_published(Kind::kNelderMead, world.vehicle, as_published());
  world.drive(*method, 100);
  const Eigen::Vector4d before = parameters(*method, 0);
  const Eigen::Matrix4d covariance_before = method->estimate(0).covariance;
  const Eigen::Matrix3d good = plate_covariance();
  const Eigen::Vector3d turn(0.0, 0.01, 0.02);
  EXPECT_FALSE(method->seed(4, turn, good)) << "unknown radar";
  EXPECT_FALSE(method->seed(0, Eigen::Vector3d(0.0, std::nan(""), 0.0), good));
  EXPECT_FALSE(method->seed(0, Eigen::Vector3d(0.0, 0.0, 0.5), good)) << "beyond the limits of the estimate";
  Eigen::Matrix3d bad = good;
  bad(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(method->seed(0, turn, bad));
  bad = good;
  bad(2, 2) = 0.0;
  EXPECT_FALSE(method->seed(0, turn, bad));
  bad = good;
  bad(0, 1) = bad(1, 0) = 2.0 * std::sqrt(good(0, 0) * good(1, 1));
  EXPECT_FALSE(method->seed(0, turn, bad)) << "no covariance";
  EXPECT_EQ(parameters(*method, 0), before);
  EXPECT_EQ(method->estimate(0).covariance, covariance_before);
}

TEST(PublishedSeed, IsRefusedByTheReferenceWhichHasNoPitch) {
  PlanarWorld world;
  const auto method = make_published(Kind::kAzimuth1d, world.vehicle, as_published());
  EXPECT_FALSE(method->seed(0, Eigen::Vector3d(0.0, 0.0, 0.01), plate_covariance()));
  EXPECT_EQ(parameters(*method, 0), Eigen::Vector4d(1.0, 0.0, 0.0, 0.0));
}

}  // namespace
}  // namespace boresight::alignment::published
