// Radars that measure no elevation: what they may see, and that k_v and yaw are as wrong as they say.
#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "interfaces/messages/alignment_estimate.hpp"
#include "tests/unit/alignment_estimator/filter/bench.hpp"

namespace boresight::alignment {
namespace {

RadarConfig radar_of(double height_m, double half_view_deg) {
  RadarConfig radar;
  radar.mounting_pose.position_m = {3.6, 0.0, height_m};
  radar.field_of_view.elevation_min_rad = -half_view_deg * kDegree;
  radar.field_of_view.elevation_max_rad = half_view_deg * kDegree;
  return radar;
}

TEST(UnknownElevation, IsTheMeanOverThingsThatStandOnTheRoad) {
  constexpr double kHeight_m = 0.5, kTop_m = 4.7;
  const UnknownElevation unknown(radar_of(kHeight_m, 12.0), 0.0);
  for (const double range_m : {5.0, 12.0, 30.0, 100.0}) {
    // Tops and reflecting points below them, both evenly spaced.
    double sum = 0.0, square = 0.0, sine_sum = 0.0, count = 0.0;
    constexpr int kSteps = 1500;
    for (int i = 0; i < kSteps; ++i) {
      const double top = kTop_m * (i + 0.5) / kSteps;
      for (int j = 0; j < kSteps; ++j) {
        const double sine = (top * (j + 0.5) / kSteps - kHeight_m) / range_m;
        if (std::abs(sine) > std::sin(12.0 * kDegree)) continue;
        const double cosine = std::sqrt(1.0 - sine * sine);
        sum += cosine;
        square += cosine * cosine;
        sine_sum += sine;
        count += 1.0;
      }
    }
    const double mean = sum / count;
    const UnknownElevation::Cosine at = unknown.at(range_m);
    EXPECT_NEAR(at.lowering, 1.0 - mean, 0.01 * (1.0 - mean)) << range_m;
    EXPECT_NEAR(at.relative_variance, square / count / (mean * mean) - 1.0, 0.02 * at.relative_variance + 1e-12)
        << range_m;
    EXPECT_NEAR(at.mean_sine, sine_sum / count, 0.01 * std::abs(at.mean_sine) + 1e-6) << range_m;
  }
}

TEST(UnknownElevation, IsFiniteWhateverIsSent) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  RadarConfig upwards = radar_of(0.5, 2.0);
  upwards.field_of_view.elevation_min_rad = 0.6;
  upwards.field_of_view.elevation_max_rad = 0.7;
  RadarConfig unknown_view = radar_of(0.5, 2.0);
  unknown_view.field_of_view.elevation_max_rad = kNaN;
  for (const RadarConfig& radar :
       {radar_of(0.5, 18.0), radar_of(0.0, 5.0), radar_of(4.0, 0.0), upwards, unknown_view}) {
    const UnknownElevation unknown(radar, 0.07);
    for (const double range_m : {kNaN, -5.0, 0.0, 0.3, 20.0, 1e9, kInf}) {
      const UnknownElevation::Cosine at = unknown.at(range_m);
      EXPECT_GE(at.lowering, 0.0) << range_m;
      EXPECT_LT(at.lowering, 0.5) << range_m;
      EXPECT_GE(at.relative_variance, 0.0) << range_m;
      EXPECT_LE(std::abs(at.mean_sine), 1.0) << range_m;
    }
  }
}

simulator::AlignmentSpec without_elevation(std::uint64_t seed) {
  simulator::AlignmentSpec spec = simulator::four_corner_radars();
  spec.seed = seed;
  spec.duration_s = 30.0;
  simulator::draw_truth(spec);
  for (simulator::AlignmentRadar& radar : spec.radars) radar.measures_elevation = false;
  return spec;
}

TEST(UnknownElevation, FourRadarsWithoutElevationKnowTheSpeedAndYawAsWellAsTheySay) {
  double speed_nees = 0.0, worst_speed = 0.0, yaw_nees = 0.0, worst_yaw = 0.0;
  constexpr std::uint64_t kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const simulator::AlignmentSpec spec = without_elevation(seed);
    Bench bench(spec);
    bench.run(30.0);
    for (std::size_t r = 0; r < 4; ++r) {
      const RadarEstimate e = bench.filter->estimate(r);
      ASSERT_TRUE((e.observable & alignment_axis::kVehicleYaw) != 0) << r;
      const double yaw = bench.error_rad(r).z();
      yaw_nees += yaw * yaw / e.covariance(3, 3) / (4.0 * kSeeds);
      worst_yaw = std::max(worst_yaw, std::abs(yaw));
    }
    const RadarEstimate e = bench.filter->estimate(0);
    const double off = e.speed_scale - spec.speed_scale;
    speed_nees += off * off / e.covariance(0, 0) / kSeeds;
    worst_speed = std::max(worst_speed, std::abs(off));
    EXPECT_LT(std::sqrt(e.covariance(0, 0)), 1e-3);
  }
  EXPECT_LT(speed_nees, 2.0);
  EXPECT_LT(worst_speed, 2e-3) << "a uniform elevation over the field of view was wrong by a hundredth";
  EXPECT_LT(yaw_nees, 1.5);
  EXPECT_LT(worst_yaw, 0.3 * kDegree);
}

TEST(UnknownElevation, YawIsSurerWhereRollAndPitchAreKnownFromElsewhere) {
  const simulator::AlignmentSpec spec = without_elevation(1);
  Bench alone(spec), seeded(spec);
  const Eigen::Matrix3d known = Eigen::Vector3d(1e-6, 1e-6, 1e-4).asDiagonal();
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(spec.radars[r].config.mounting_pose, 0.0, 0.0, 0.0);
    const Eigen::Vector3d turn = geometry::so3_log(seeded.drive.sensor_to_vehicle(r, 1.0) * nominal.transpose());
    ASSERT_TRUE(seeded.filter->seed(r, turn, known)) << r;
  }
  alone.run(30.0);
  seeded.run(30.0);
  for (std::size_t r = 0; r < 4; ++r) {
    const double alone_std = std::sqrt(alone.filter->estimate(r).covariance(3, 3));
    const double seeded_std = std::sqrt(seeded.filter->estimate(r).covariance(3, 3));
    EXPECT_GT(alone_std, 0.1 * kDegree) << r << ": however long it drives";
    EXPECT_LT(seeded_std, 0.05 * kDegree) << r;
  }
}

}  // namespace
}  // namespace boresight::alignment
