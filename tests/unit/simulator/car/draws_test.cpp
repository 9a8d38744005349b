// What is drawn for a real car: sizes, and independence of each effect from the others.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/car/body.hpp"
#include "services/simulator/car/radar_of_car.hpp"
#include "services/simulator/car/signals.hpp"
#include "services/simulator/car/truth.hpp"

namespace boresight::simulator::car {
namespace {

constexpr FieldOfView kView{-1.2, 1.0, -0.3, 0.3, 100.0};

TEST(RealCarDraws, ZeroSizesChangeNothing) {
  RealCar off;
  off.side_slip_correlation_s = 3.0;
  off.load_time_s = 0.0;
  const RadarOfCar radar = radar_of_car(off, 1, 2, kView);
  EXPECT_EQ(radar.range_rate_scale, 1.0);
  EXPECT_EQ(radar.curve.error_rad(0.3), 0.0);
  EXPECT_EQ(radar.position_error_m, (std::array<double, 3>{}));
  EXPECT_EQ(radar.stamp_offset_ns(), 0);
  EXPECT_EQ(SideSlip(off, 1, 100.0).at(50.0), 0.0);
  EXPECT_EQ(load_pitch_rad(off, 1.0), 0.0);
  EXPECT_EQ(signalled_yaw_rate(off, 0.123), 0.123);
  EXPECT_EQ(quantised_speed(off, 12.345678), 12.345678);
  EXPECT_TRUE(truth_of_car(off).empty());
  EXPECT_TRUE(truth_of_radar(off, radar, 2).empty());
}

TEST(RealCarDraws, SideSlipHasItsStandardDeviationAndCorrelationTime) {
  RealCar car;
  car.side_slip_std_rad = 0.1;
  car.side_slip_correlation_s = 5.0;
  constexpr double kDuration_s = 36000.0;
  const SideSlip slip(car, 3, kDuration_s);
  double square = 0.0, product = 0.0, n = 0.0;
  for (double t = 0.0; t < kDuration_s - 5.0; t += 0.25, n += 1.0) {
    square += slip.at(t) * slip.at(t);
    product += slip.at(t) * slip.at(t + 5.0);
  }
  EXPECT_NEAR(std::sqrt(square / n), 0.1, 0.005);
  EXPECT_NEAR(product / square, std::exp(-1.0), 0.04);
}

TEST(RealCarDraws, ALongerDriveBeginsWithTheSideSlipOfAShorterOne) {
  RealCar car;
  car.side_slip_std_rad = 0.002;
  const SideSlip shorter(car, 3, 30.0), longer(car, 3, 300.0);
  for (double t = 0.0; t <= 30.0; t += 0.37) ASSERT_EQ(shorter.at(t), longer.at(t));
}

TEST(RealCarDraws, AzimuthCurveHasItsRmsAndNoMeanOverTheFieldOfView) {
  RealCar car;
  car.azimuth_curve_rms_rad = 0.005;
  for (const std::uint32_t id : {1U, 2U, 3U}) {
    const AzimuthCurve curve = radar_of_car(car, 9, id, kView).curve;
    constexpr int kSteps = 1000;
    double sum = 0.0, square = 0.0, steepest = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double width = (kView.azimuth_max_rad - kView.azimuth_min_rad) / kSteps;
      const double azimuth = kView.azimuth_min_rad + (i + 0.5) * width;
      const double error = curve.error_rad(azimuth);
      sum += error;
      square += error * error;
      steepest = std::max(steepest, std::abs(curve.error_rad(azimuth + 0.5 * width) - error) / (0.5 * width));
    }
    EXPECT_NEAR(std::sqrt(square / kSteps), 0.005, 1e-5);
    EXPECT_NEAR(sum / kSteps, 0.0, 1e-6);
    EXPECT_LT(steepest, 0.1) << "smooth: no two targets change places";
    EXPECT_EQ(curve.error_rad(1.5), curve.error_rad(kView.azimuth_max_rad));
  }
}

TEST(RealCarDraws, StampsAndScalesLieWithinTheirSpans) {
  RealCar car;
  car.stamp_offset_s = 0.02;
  car.range_rate_scale = 0.0025;
  std::set<double> offsets;
  double least = 1.0, most = 0.0, scale_least = 2.0, scale_most = 0.0;
  for (std::uint32_t id = 1; id <= 16; ++id) {
    const RadarOfCar radar = radar_of_car(car, 4, id, kView);
    offsets.insert(radar.stamp_offset_s);
    least = std::min(least, radar.stamp_offset_s);
    most = std::max(most, radar.stamp_offset_s);
    scale_least = std::min(scale_least, radar.range_rate_scale);
    scale_most = std::max(scale_most, radar.range_rate_scale);
    EXPECT_EQ(radar.stamp_offset_ns() % 100'000, 0) << "tables of an alignment drive resolve 0.1 ms";
  }
  EXPECT_GT(offsets.size(), 10U);
  EXPECT_GE(least, 0.01);
  EXPECT_LE(most, 0.02);
  EXPECT_GT(most - least, 0.005);
  EXPECT_GE(scale_least, 0.9975);
  EXPECT_LE(scale_most, 1.0025);
  EXPECT_GT(scale_most - scale_least, 0.0025);
}

TEST(RealCarDraws, NoEffectChangesWhatIsDrawnForAnother) {
  const RealCar all = real_car_preset();
  const RadarOfCar together = radar_of_car(all, 5, 1, kView);
  RealCar one;
  one.range_rate_scale = all.range_rate_scale;
  EXPECT_EQ(radar_of_car(one, 5, 1, kView).range_rate_scale, together.range_rate_scale);
  one = {};
  one.azimuth_curve_rms_rad = all.azimuth_curve_rms_rad;
  EXPECT_EQ(radar_of_car(one, 5, 1, kView).curve.cos_rad, together.curve.cos_rad);
  EXPECT_EQ(radar_of_car(one, 5, 1, kView).curve.sin_rad, together.curve.sin_rad);
  one = {};
  one.position_error_m = all.position_error_m;
  EXPECT_EQ(radar_of_car(one, 5, 1, kView).position_error_m, together.position_error_m);
  one = {};
  one.stamp_offset_s = all.stamp_offset_s;
  EXPECT_EQ(radar_of_car(one, 5, 1, kView).stamp_offset_ns(), together.stamp_offset_ns());
  one = {};
  one.side_slip_std_rad = all.side_slip_std_rad;
  EXPECT_EQ(SideSlip(one, 5, 60.0).at(31.0), SideSlip(all, 5, 60.0).at(31.0));
}

TEST(RealCarDraws, RoadMirrorsLowReflectorsOnly) {
  const Eigen::Vector3d to_kerb = Eigen::Vector3d(20.0, 3.0, -0.4).normalized();
  const double range_m = Eigen::Vector3d(20.0, 3.0, -0.4).norm();
  const auto image = mirrored_by_road(to_kerb, range_m, 0.5);
  ASSERT_TRUE(image.has_value());
  EXPECT_NEAR(image->norm(), 1.0, 1e-12);
  EXPECT_NEAR(image->z() * range_m, -0.6, 1e-9) << "0.1 m below the road";
  EXPECT_NEAR(image->y() / image->x(), 3.0 / 20.0, 1e-12) << "the same azimuth";
  const Eigen::Vector3d to_sign(20.0, 3.0, 2.0), to_pit(20.0, 3.0, -0.6);
  EXPECT_FALSE(mirrored_by_road(to_sign.normalized(), to_sign.norm(), 0.5).has_value());
  EXPECT_FALSE(mirrored_by_road(to_pit.normalized(), to_pit.norm(), 0.5).has_value());
}

}  // namespace
}  // namespace boresight::simulator::car
