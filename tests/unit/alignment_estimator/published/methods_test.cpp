// The published methods: their results, the parameters that they leave unchanged, and invalid inputs.
#include <limits>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/alignment_estimator/published/planar_world.hpp"

namespace boresight::alignment::published {
namespace {

constexpr Kind kAll[] = {Kind::kSteepestDescent, Kind::kLeastSquares, Kind::kTotalLeastSquares, Kind::kNelderMead,
                         Kind::kAzimuth1d};

double worst_angle_deg(const Method& method, const PlanarWorld& world, int first = 1, int last = 3) {
  double worst = 0.0;
  for (std::size_t r = 0; r < world.vehicle.radars.size(); ++r) {
    const Eigen::Vector4d error = parameters(method, r) - world.truth[r];
    for (int p = first; p <= last; ++p) worst = std::max(worst, std::abs(error(p)) / kRadiansPerDegree);
  }
  return worst;
}

TEST(PublishedMethods, LeastSquaresFindsTheTruthWithItsPublishedConstants) {
  PlanarWorld world;
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  world.drive(*method, 12'000);
  EXPECT_NEAR(parameters(*method, 0)(0), 1.01, 1e-5);
  EXPECT_LT(worst_angle_deg(*method, world), 0.005);
}

TEST(PublishedMethods, SteepestDescentFindsTheAnglesAndApproachesTheSpeedScale) {
  // η = 1e-6 of k_v times a mean square gradient of some 60 (m/s)²: 95 % of the distance needs about 50,000 scans.
  PlanarWorld world;
  world.detections = 16;
  const auto method = make_published(Kind::kSteepestDescent, world.vehicle, as_published());
  double before = 0.01;
  for (int part = 0; part < 4; ++part) {
    world.drive(*method, 5'000);
    const double error = std::abs(parameters(*method, 0)(0) - 1.01);
    EXPECT_LT(error, 0.95 * before);
    before = error;
  }
  EXPECT_LT(worst_angle_deg(*method, world, 1, 1), 0.2);
}

TEST(PublishedMethods, SteepestDescentFindsTheTruthWithALargerRate) {
  PlanarWorld world;
  PublishedConfig config = as_published();
  config.steepest_descent_rate = {1e-4, 1e-3, 1e-2, 1e-2};
  const auto method = make_published(Kind::kSteepestDescent, world.vehicle, config);
  world.drive(*method, 8'000);
  EXPECT_NEAR(parameters(*method, 0)(0), 1.01, 1e-5);
  EXPECT_LT(worst_angle_deg(*method, world), 0.02);
}

TEST(PublishedMethods, TotalLeastSquaresFindsTheTruth) {
  PlanarWorld world;
  world.detections = 24;
  const auto method = make_published(Kind::kTotalLeastSquares, world.vehicle, as_published());
  world.drive(*method, 30'000);
  EXPECT_NEAR(parameters(*method, 0)(0), 1.01, 1e-4);
  EXPECT_LT(worst_angle_deg(*method, world), 0.05);
}

TEST(PublishedMethods, NelderMeadFindsTheTruthInNoise) {
  // Without noise it stops where no vertex of the simplex is better than the estimate, within about a quarter of the
  // edge. Noise moves the estimate in both directions, in proportion to its error.
  PlanarWorld world;
  world.noise_mps = 0.03;
  const auto method = make_published(Kind::kNelderMead, world.vehicle, as_published());
  world.drive(*method, 15'000);
  EXPECT_NEAR(parameters(*method, 0)(0), 1.01, 4e-4);
  EXPECT_LT(worst_angle_deg(*method, world, 1, 1), 0.05);
  EXPECT_LT(worst_angle_deg(*method, world), 0.3);
}

TEST(PublishedMethods, TheReferenceFindsTheYawOfARadarWithoutPitchAndRoll) {
  PlanarWorld world;
  for (Eigen::Vector4d& truth : world.truth) truth(2) = truth(3) = 0.0;
  const auto method = make_published(Kind::kAzimuth1d, world.vehicle, as_published());
  world.drive(*method, 12'000);
  EXPECT_NEAR(parameters(*method, 0)(0), 1.01, 1e-5);
  EXPECT_LT(worst_angle_deg(*method, world), 0.005);
  EXPECT_EQ(parameters(*method, 2)(2), 0.0);
  EXPECT_EQ(parameters(*method, 2)(3), 0.0);
  const RadarEstimate estimate = method->estimate(0);
  EXPECT_EQ(estimate.observable & (alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll), 0u);
  EXPECT_NE(estimate.observable & alignment_axis::kVehicleYaw, 0u);
}

TEST(PublishedMethods, TheEstimateIsTheMountingWithTheAnglesAdded) {
  PlanarWorld world;
  world.vehicle.radars[2].mounting_pose.pitch_rad = 0.05;
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  world.drive(*method, 8'000);
  for (std::size_t r = 0; r < 4; ++r) {
    const RadarEstimate estimate = method->estimate(r);
    const Eigen::Vector4d& b = world.truth[r];
    EXPECT_LT((estimate.sensor_to_vehicle -
               geometry::sensor_to_vehicle(world.vehicle.radars[r].mounting_pose, b(1), b(2), b(3)))
                  .norm(),
              1e-3);
    EXPECT_EQ(estimate.state, AlignmentState::kConverged);
    EXPECT_EQ(estimate.scans_used, 8'000u);
    EXPECT_EQ(estimate.detections_used, 8'000u * 40u);
    EXPECT_NEAR(estimate.seconds_of_drive, 7'999 * 0.05, 1e-6);
    EXPECT_NEAR(estimate.inlier_ratio, 1.0, 1e-12);
    EXPECT_TRUE(estimate.covariance.allFinite());
    EXPECT_GT(estimate.covariance.diagonal().minCoeff(), 0.0);
  }
}

TEST(PublishedMethods, UnsynchronisedRadarsGiveTheSameResult) {
  for (const Kind kind : {Kind::kLeastSquares, Kind::kSteepestDescent}) {
    PlanarWorld together, apart;
    const auto a = make_published(kind, together.vehicle, as_published());
    const auto b = make_published(kind, apart.vehicle, as_published());
    together.drive(*a, 3'000);
    apart.drive(*b, 3'000, 0.0123);
    for (std::size_t r = 0; r < 4; ++r) {
      const Eigen::Vector4d difference = parameters(*a, r) - parameters(*b, r);
      EXPECT_LT(std::abs(difference(0)), 1e-5);
      EXPECT_LT(difference.tail<3>().norm(), 0.01 * kRadiansPerDegree);
    }
  }
}

TEST(PublishedMethods, ARadarOfHalfTheRateSharesTheSpeedScale) {
  PlanarWorld world;
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  for (int i = 0; i < 12'000; ++i) {
    for (std::size_t r = 0; r < 4; ++r) {
      if (r == 1 && i % 2 == 0) continue;
      world.look(r, 0.05 * i);
      method->process(r, *world.scan, world.ego);
    }
  }
  EXPECT_NEAR(parameters(*method, 1)(0), 1.01, 2e-5);
  EXPECT_LT(worst_angle_deg(*method, world), 0.01);
  EXPECT_EQ(method->estimate(1).scans_used, 6'000u);
}

TEST(PublishedMethods, ASingleRadarTakesTheWholeStep) {
  // As fast as with the others: 1 − exp(−3) after 3 / η scans, whatever the number of radars in the vehicle file.
  PlanarWorld world;
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  for (int i = 0; i < 4'000; ++i) {
    world.look(3, 0.05 * i);
    method->process(3, *world.scan, world.ego);
  }
  EXPECT_NEAR(parameters(*method, 3)(0), 1.01, 5e-4);
  EXPECT_EQ(parameters(*method, 0).tail<3>(), Eigen::Vector3d::Zero());
  EXPECT_EQ(method->estimate(0).state, AlignmentState::kNoData);
}

TEST(PublishedMethods, TheGateRejectsMovingObjects) {
  for (const bool gate : {false, true}) {
    PlanarWorld world;
    world.movers = 0.3;
    world.noise_mps = 0.03;
    PublishedConfig config;
    config.gate = gate;
    const auto method = make_published(Kind::kLeastSquares, world.vehicle, config);
    world.drive(*method, 6'000);
    if (gate) {
      // Not zero: in some scans half of the few detections move, and the median deviation moves with them.
      EXPECT_LT(worst_angle_deg(*method, world, 1, 1), 0.1);
      EXPECT_LT(worst_angle_deg(*method, world), 0.8);
      EXPECT_NEAR(method->estimate(0).inlier_ratio, 0.7, 0.05);
    } else {
      EXPECT_GT(worst_angle_deg(*method, world), 3.0);
    }
  }
}

TEST(PublishedMethods, WithoutElevationPitchAndRollStayAsTheyWere) {
  for (const Kind kind : kAll) {
    PlanarWorld world;
    world.measures_elevation = false;
    for (Eigen::Vector4d& truth : world.truth) truth(2) = truth(3) = 0.0;
    const auto method = make_published(kind, world.vehicle, as_published());
    world.drive(*method, 4'000);
    EXPECT_EQ(parameters(*method, 0)(2), 0.0);
    EXPECT_EQ(parameters(*method, 0)(3), 0.0);
    const Eigen::Vector4d start(1.0, 0.0, 0.0, 0.0);
    EXPECT_LT((parameters(*method, 0) - world.truth[0]).norm(), 0.7 * (start - world.truth[0]).norm());
    EXPECT_EQ(method->estimate(0).observable & (alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll), 0u);
  }
}

TEST(PublishedMethods, AliasedRangeRatesAreComparedModuloTheirInterval) {
  PlanarWorld world;
  world.ambiguity_mps = 10.0;  // half of the detections are folded
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  world.drive(*method, 12'000);
  EXPECT_NEAR(parameters(*method, 0)(0), 1.01, 2e-5);
  EXPECT_LT(worst_angle_deg(*method, world), 0.01);
}

TEST(PublishedMethods, TheStraightModelIsWrongInCurvesAndRightWhereItIsUsedOnStraightsOnly) {
  const auto yaw_error = [](RoadModel model) {
    PlanarWorld world;
    PublishedConfig config = as_published();
    config.road_model = model;
    config.straight_yaw_rate_radps = 0.002;
    const auto method = make_published(Kind::kLeastSquares, world.vehicle, config);
    world.drive(*method, 12'000);
    return std::max(worst_angle_deg(*method, world), std::abs(parameters(*method, 0)(0) - 1.01) / kRadiansPerDegree);
  };
  EXPECT_GT(yaw_error(RoadModel::kStraight), 0.05);
  EXPECT_LT(yaw_error(RoadModel::kStraightWhereSlow), 0.02);
  PlanarWorld straight;
  straight.turning_radps = 0.0;
  PublishedConfig config = as_published();
  config.road_model = RoadModel::kStraight;
  const auto method = make_published(Kind::kLeastSquares, straight.vehicle, config);
  straight.drive(*method, 12'000);
  EXPECT_LT(worst_angle_deg(*method, straight), 0.02);
}

TEST(PublishedMethods, PredictsTheMeasuredRangeRatesOnceConverged) {
  PlanarWorld world;
  const auto method = make_published(Kind::kLeastSquares, world.vehicle, as_published());
  world.drive(*method, 12'000);
  std::vector<double> predicted(world.detections);
  for (std::size_t r = 0; r < 4; ++r) {
    world.look(r, world.time_s);
    method->predict(r, *world.scan, world.ego, predicted);
    for (std::size_t i = 0; i < world.detections; ++i) EXPECT_NEAR(predicted[i], world.scan->range_rate_mps[i], 2e-3);
  }
}

TEST(PublishedMethods, IgnoreScansWithoutInformation) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Kind kind : kAll) {
    PlanarWorld world;
    const auto method = make_published(kind, world.vehicle);
    const auto untouched = [&] { return parameters(*method, 0) == Eigen::Vector4d(1.0, 0.0, 0.0, 0.0); };
    EXPECT_EQ(method->estimate(0).state, AlignmentState::kNoData);
    world.look(0, 0.0);
    EgoSample ego = world.ego;
    ego.valid = false;
    method->process(0, *world.scan, ego);
    ego = world.ego;
    ego.stale = true;
    method->process(0, *world.scan, ego);
    ego = world.ego;
    ego.speed_mps = kNan;
    method->process(0, *world.scan, ego);
    ego = world.ego;
    ego.yaw_rate_radps = kNan;
    method->process(0, *world.scan, ego);
    for (const double speed : {-12.0, 0.0, 4.9}) {
      ego = world.ego;
      ego.speed_mps = speed;
      method->process(0, *world.scan, ego);
    }
    world.scan->count = 0;
    method->process(0, *world.scan, world.ego);
    EXPECT_TRUE(untouched());
    EXPECT_EQ(method->estimate(0).state, AlignmentState::kWaiting);
    EXPECT_EQ(method->estimate(0).scans_used, 0u);
    EXPECT_EQ(method->estimate(0).observable, 0u);
    world.look(0, 0.05);
    world.scan->range_rate_mps.fill(kNan);
    method->process(0, *world.scan, world.ego);
    EXPECT_TRUE(untouched());
    world.look(0, 0.05);
    method->process(4, *world.scan, world.ego);  // unknown radar
    EXPECT_TRUE(untouched());
    EXPECT_EQ(method->estimate(4).state, AlignmentState::kNoData);
  }
}

TEST(PublishedMethods, ADetectionThatIsNotANumberDoesNotAffectItsScan) {
  for (const Kind kind : kAll) {
    PlanarWorld world;
    const auto method = make_published(kind, world.vehicle, as_published());
    for (int i = 0; i < 200; ++i) {
      world.look(0, 0.05 * i);
      world.scan->azimuth_rad[3] = std::numeric_limits<double>::infinity();
      world.scan->range_rate_mps[5] = std::numeric_limits<double>::quiet_NaN();
      method->process(0, *world.scan, world.ego);
    }
    EXPECT_TRUE(parameters(*method, 0).allFinite());
    EXPECT_NE(parameters(*method, 0)(1), 0.0);
    EXPECT_EQ(method->estimate(0).scans_used, 200u);
    EXPECT_TRUE(method->estimate(0).covariance.allFinite());
  }
}

TEST(PublishedMethods, OneAzimuthDoesNotDetermineFourParameters) {
  for (const Kind kind : kAll) {
    PlanarWorld world;
    world.one_azimuth = true;
    world.turning_radps = 0.0;
    const auto method = make_published(kind, world.vehicle);
    world.drive(*method, 2'000);
    const RadarEstimate estimate = method->estimate(0);
    EXPECT_TRUE(parameters(*method, 0).allFinite());
    EXPECT_TRUE(estimate.covariance.allFinite());
    EXPECT_EQ(estimate.observable & (alignment_axis::kVehiclePitch | alignment_axis::kVehicleRoll), 0u);
    EXPECT_NE(estimate.state, AlignmentState::kConverged);
  }
}

TEST(PublishedMethods, ADivergentStepStaysWithinItsLimits) {
  PlanarWorld world;
  PublishedConfig config = as_published();
  config.steepest_descent_rate = {1.0, 1.0, 1.0, 1.0};
  const auto method = make_published(Kind::kSteepestDescent, world.vehicle, config);
  world.drive(*method, 500);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_LE(std::abs(parameters(*method, r)(0) - 1.0), config.max_speed_scale_error + 1e-12);
    EXPECT_LE(parameters(*method, r).tail<3>().cwiseAbs().maxCoeff(), config.max_angle_rad);
    EXPECT_NE(method->estimate(r).state, AlignmentState::kConverged);
  }
}

TEST(PublishedMethods, ContinueFromTheLastIgnitionCycle) {
  for (const Kind kind : kAll) {
    PlanarWorld world;
    world.vehicle.radars[1].mounting_pose.roll_rad = M_PI;  // upside down
    const auto first = make_published(kind, world.vehicle, as_published());
    world.drive(*first, 1'000);
    Memory memory;
    first->save(memory);
    EXPECT_EQ(memory.number_of_radars, 4u);
    EXPECT_GT(memory.variance(Memory::kSpeedScale, Memory::kSpeedScale), 0.0);
    const auto second = make_published(kind, world.vehicle, as_published());
    second->restore(memory, std::numeric_limits<double>::infinity());
    for (std::size_t r = 0; r < 4; ++r) EXPECT_LT((parameters(*second, r) - parameters(*first, r)).norm(), 1e-9) << r;
    EXPECT_EQ(second->estimate(2).state, AlignmentState::kNoData);
    memory.radars[3].id = 9;  // another radar is mounted there now
    memory.radars[2].rotation_vehicle_rad[0] = std::numeric_limits<double>::quiet_NaN();
    memory.speed_scale = std::numeric_limits<double>::quiet_NaN();
    const auto third = make_published(kind, world.vehicle, as_published());
    third->restore(memory, std::numeric_limits<double>::infinity());
    EXPECT_EQ(parameters(*third, 3), Eigen::Vector4d(1.0, 0.0, 0.0, 0.0));
    EXPECT_EQ(parameters(*third, 2), Eigen::Vector4d(1.0, 0.0, 0.0, 0.0));
    EXPECT_NE(parameters(*third, 1)(1), 0.0);
    memory.number_of_radars = 3;
    const auto fourth = make_published(kind, world.vehicle, as_published());
    fourth->restore(memory, std::numeric_limits<double>::infinity());
    EXPECT_EQ(parameters(*fourth, 1), Eigen::Vector4d(1.0, 0.0, 0.0, 0.0));
  }
}

TEST(PublishedMethods, AllocateNothingInTheDataPath) {
  for (const Kind kind : kAll) {
    PlanarWorld world;
    const auto method = make_published(kind, world.vehicle);
    std::vector<double> predicted(world.detections);
    std::uint64_t allocations = 0;
    for (int i = 0; i < 20; ++i) {
      for (std::size_t r = 0; r < 4; ++r) {
        world.look(r, 0.05 * i);
        const runtime::CountAllocations counting;
        const std::uint64_t before = runtime::counted_allocations();
        method->process(r, *world.scan, world.ego);
        method->predict(r, *world.scan, world.ego, predicted);
        const RadarEstimate estimate = method->estimate(r);
        allocations += runtime::counted_allocations() - before;
        ASSERT_TRUE(estimate.covariance.allFinite());
      }
    }
    EXPECT_EQ(allocations, 0u);
  }
}

TEST(PublishedMethods, RunTheSameTwice) {
  PlanarWorld first, second;
  const auto a = make_published(Kind::kNelderMead, first.vehicle);
  const auto b = make_published(Kind::kNelderMead, second.vehicle);
  first.drive(*a, 300);
  second.drive(*b, 300);
  for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(parameters(*a, r), parameters(*b, r));
}

}  // namespace
}  // namespace boresight::alignment::published
