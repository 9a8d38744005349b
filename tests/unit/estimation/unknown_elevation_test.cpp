#include "services/common/estimation/unknown_elevation.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"

namespace boresight {
namespace {

RadarConfig radar_of(double height_m, double half_view_deg) {
  RadarConfig radar;
  radar.mounting_pose.position_m = {3.6, 0.0, height_m};
  radar.field_of_view.elevation_min_rad = -half_view_deg * kRadiansPerDegree;
  radar.field_of_view.elevation_max_rad = half_view_deg * kRadiansPerDegree;
  return radar;
}

TEST(UnknownElevation, IsTheMeanOverObjectsOnTheRoad) {
  constexpr double kHeight_m = 0.5, kTop_m = 4.7;
  const UnknownElevation unknown(radar_of(kHeight_m, 12.0), 0.0);
  for (const double range_m : {5.0, 12.0, 30.0, 100.0}) {
    // Tops and reflection points below them, both evenly spaced.
    double sum = 0.0, square = 0.0, sine_sum = 0.0, count = 0.0;
    constexpr int kSteps = 1500;
    for (int i = 0; i < kSteps; ++i) {
      const double top = kTop_m * (i + 0.5) / kSteps;
      for (int j = 0; j < kSteps; ++j) {
        const double sine = (top * (j + 0.5) / kSteps - kHeight_m) / range_m;
        if (std::abs(sine) > std::sin(12.0 * kRadiansPerDegree)) continue;
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

TEST(UnknownElevation, IsFiniteForAllInputs) {
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

}  // namespace
}  // namespace boresight
