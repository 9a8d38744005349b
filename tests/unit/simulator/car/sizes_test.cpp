// Each effect of a real car alone has its stated size in both simulators, by the same least squares.
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/simulator/car/body.hpp"
#include "services/simulator/car/radar_of_car.hpp"
#include "tests/unit/simulator/car/observed_drive.hpp"

namespace boresight::simulator {
namespace {

using car::RealCar;
using Detection = Observed::Detection;
using Row1 = Eigen::Matrix<double, 1, 1>;

car::RadarOfCar drawn(const RealCar& car, const Observed& observed, std::uint32_t radar) {
  return car::radar_of_car(car, kSeed, radar, observed.vehicle.radar(radar)->field_of_view);
}

const auto kAll = [](const Detection&) { return true; };
auto of_radar(std::uint32_t radar) {
  return [radar](const Detection& d) { return d.radar == radar; };
}

Row1 scale_column(const Detection& d, const Motion2& m, const std::array<double, 3>& place_m) {
  return Row1(-d.sight.dot(nominal_velocity(m, place_m)));
}

TEST(RealCarSizes, WithoutEffectsRangeRatesAreThoseOfTheNominalCar) {
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, {}, 10.0);
    ASSERT_GT(o.detections.size(), 10'000U);
    double square = 0.0;
    for (const Detection& d : o.detections) {
      const double left = d.range_rate_mps + d.sight.dot(nominal_velocity(o.motion(d.stamp_s), o.position_m(d.radar)));
      square += left * left;
    }
    EXPECT_LT(std::sqrt(square / static_cast<double>(o.detections.size())), 2e-3) << "the reference of all fits below";
  }
}

TEST(RealCarSizes, RangeRateScaleIsEachRadarsOwn) {
  RealCar car;
  car.range_rate_scale = 0.0025;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, car, 10.0);
    std::vector<double> scales;
    for (const RadarConfig& radar : o.vehicle.radars) {
      const auto column = [&](const Detection& d, const Motion2& m) {
        return scale_column(d, m, radar.mounting_pose.position_m);
      };
      scales.push_back(fit<1>(o, column, of_radar(radar.id))(0));
      EXPECT_NEAR(scales.back(), drawn(car, o, radar.id).range_rate_scale - 1.0, 5e-5);
      EXPECT_LE(std::abs(scales.back()), 0.0026);
    }
    const auto [least, most] = std::minmax_element(scales.begin(), scales.end());
    EXPECT_GT(*most - *least, 0.001);
  }
}

TEST(RealCarSizes, PositionErrorActsAsALeverInBends) {
  RealCar car;
  car.position_error_m = 0.05;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, car);
    for (const RadarConfig& radar : o.vehicle.radars) {
      const auto column = [](const Detection& d, const Motion2& m) {
        return Eigen::Vector2d(-d.sight.y() * m.yaw_rate_radps, d.sight.x() * m.yaw_rate_radps);
      };
      const Eigen::Vector2d error_m = fit<2>(o, column, of_radar(radar.id));
      EXPECT_NEAR(error_m.norm(), 0.05, 0.005);
      const car::RadarOfCar truth = drawn(car, o, radar.id);
      EXPECT_NEAR(error_m.x(), truth.position_error_m[0], 0.005);
      EXPECT_NEAR(error_m.y(), truth.position_error_m[1], 0.005);
    }
  }
}

TEST(RealCarSizes, StampsAreLateByAConstantOfEachRadar) {
  RealCar car;
  car.stamp_offset_s = 0.02;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, car);
    for (const RadarConfig& radar : o.vehicle.radars) {
      const std::array<double, 3> place_m = radar.mounting_pose.position_m;
      const auto column = [&](const Detection& d, const Motion2& m) {
        const double w = m.yaw_acceleration_radps2;
        return Row1(d.sight.x() * (m.acceleration_mps2 - w * place_m[1]) + d.sight.y() * w * place_m[0]);
      };
      const double offset_s = fit<1>(o, column, of_radar(radar.id))(0);
      EXPECT_NEAR(offset_s, drawn(car, o, radar.id).stamp_offset_s, 0.001);
      EXPECT_GT(offset_s, 0.009);
      EXPECT_LT(offset_s, 0.021);
    }
  }
}

TEST(RealCarSizes, RearAxleSlipsOutwardsInBends) {
  RealCar car;
  car.slip_coefficient_radps2pm = 0.0045;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, car);
    const auto column = [](const Detection& d, const Motion2& m) {
      return Row1(d.sight.y() * m.speed_mps * m.speed_mps * m.yaw_rate_radps);
    };
    EXPECT_NEAR(fit<1>(o, column, kAll)(0), 0.0045, 0.00015);
  }
}

TEST(RealCarSizes, SideSlipHasItsSizeAndIsTheSameForAllRadars) {
  RealCar car;
  car.side_slip_std_rad = 0.3 * kRadiansPerDegree;
  car.side_slip_correlation_s = 2.0;
  constexpr double kDuration_s = 60.0;
  const car::SideSlip expected(car, kSeed, kDuration_s);
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, car, kDuration_s);
    const double start_s = o.signals.front().t_s;
    const auto column = [](const Detection& d, const Motion2& m) { return Row1(-d.sight.y() * m.speed_mps); };
    double square = 0.0, difference = 0.0;
    int n = 0;
    for (double t = 1.0; t < kDuration_s - 1.0; t += 1.0, ++n) {
      const auto now = [&](const Detection& d) { return std::abs(d.stamp_s - start_s - t) < 0.051; };
      const double slip_rad = fit<1>(o, column, now)(0);
      square += slip_rad * slip_rad;
      difference += std::pow(slip_rad - expected.at(t), 2);
    }
    const double std_rad = std::sqrt(square / n);
    EXPECT_NEAR(std_rad / car.side_slip_std_rad, 1.0, 0.35) << "some 15 independent values";
    EXPECT_LT(std::sqrt(difference / n), 0.1 * car.side_slip_std_rad);
  }
}

TEST(RealCarSizes, LoadPitchesAllRadarsFromItsTimeOn) {
  RealCar car;
  car.load_pitch_rad = 0.5 * kRadiansPerDegree;
  car.load_time_s = 10.0;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, car, 20.0);
    const double change_s = o.signals.front().t_s + car.load_time_s;
    // The second column takes what is of second order, 1 − cos(pitch).
    const auto column = [](const Detection& d, const Motion2& m) {
      return Eigen::Vector2d(d.sight.z() * m.speed_mps, d.sight.x() * m.speed_mps);
    };
    for (const RadarConfig& radar : o.vehicle.radars) {
      const auto pitch_rad = [&](bool later) {
        return fit<2>(o, column,
                      [&](const Detection& d) { return d.radar == radar.id && (d.stamp_s >= change_s) == later; })(0);
      };
      EXPECT_NEAR(pitch_rad(false) * kDegreesPerRadian, 0.0, 0.01);
      EXPECT_NEAR(pitch_rad(true) * kDegreesPerRadian, 0.5, 0.02) << "nose up: the radars look up";
    }
  }
}

TEST(RealCarSizes, AzimuthErrorFollowsASmoothCurveOfItsSize) {
  RealCar car;
  car.azimuth_curve_rms_rad = 0.4 * kRadiansPerDegree;
  constexpr double kBin_rad = 10.0 * kRadiansPerDegree;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed o = observe(simulator, car, 20.0);
    for (const RadarConfig& radar : o.vehicle.radars) {
      const Eigen::Matrix3d rotation = geometry::sensor_to_vehicle(radar.mounting_pose, 0.0, 0.0, 0.0);
      const auto column = [&](const Detection& d, const Motion2& m) {
        // The measured azimuth is too large by e: the range rate differs from its expectation by −e·∂ṙ/∂α.
        const Eigen::Vector3d by_azimuth = rotation *
                                           Eigen::Vector3d(-std::sin(d.azimuth_rad), std::cos(d.azimuth_rad), 0.0) *
                                           std::cos(d.elevation_rad);
        return Row1(by_azimuth.dot(nominal_velocity(m, radar.mounting_pose.position_m)));
      };
      const car::RadarOfCar truth = drawn(car, o, radar.id);
      double square = 0.0;
      int n = 0;
      for (double middle = -60.0 * kRadiansPerDegree; middle < 61.0 * kRadiansPerDegree; middle += kBin_rad, ++n) {
        const auto in_bin = [&](const Detection& d) {
          return d.radar == radar.id && std::abs(d.azimuth_rad - middle) < 0.25 * kBin_rad;
        };
        const double error_rad = fit<1>(o, column, in_bin)(0);
        square += error_rad * error_rad;
        // Along the direction of travel the range rate does not depend on the azimuth.
        const double aspect_rad = radar.mounting_pose.yaw_rad + middle;
        if (std::abs(std::sin(aspect_rad)) < 0.3) continue;
        EXPECT_NEAR(error_rad * kDegreesPerRadian, truth.curve.error_rad(middle) * kDegreesPerRadian, 0.12);
      }
      EXPECT_NEAR(std::sqrt(square / n) * kDegreesPerRadian, 0.4, 0.12);
    }
  }
}

TEST(RealCarSizes, RoadMirrorsTheStatedShareOfLowDetections) {
  RealCar car;
  car.road_mirror_share = 0.15;
  constexpr double kLow_m = 1.0, kBorder_m = 1e-3;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed plain = observe(simulator, {}, 10.0), mirrored = observe(simulator, car, 10.0);
    ASSERT_EQ(plain.detections.size(), mirrored.detections.size());
    double low = 0.0, changed = 0.0;
    for (std::size_t i = 0; i < plain.detections.size(); ++i) {
      const Detection &a = plain.detections[i], &b = mirrored.detections[i];
      ASSERT_EQ(a.range_rate_mps, b.range_rate_mps);
      ASSERT_EQ(a.range_m, b.range_m);
      ASSERT_NEAR(a.azimuth_rad, b.azimuth_rad, 1e-6);
      const double sensor_m = plain.position_m(a.radar)[2];
      const double height_m = sensor_m + a.range_m * std::sin(a.elevation_rad);
      const double image_sine = -(height_m + sensor_m) / a.range_m;
      const double view_rad = plain.vehicle.radar(a.radar)->field_of_view.elevation_min_rad;
      const bool is_low =
          height_m > kBorder_m && height_m < kLow_m - kBorder_m && image_sine > std::sin(view_rad) + 1e-3;
      const bool is_changed = std::abs(a.elevation_rad - b.elevation_rad) > 1e-5;
      if (is_changed) {
        ASSERT_NEAR(std::sin(b.elevation_rad), image_sine, 1e-4)
            << "the mirror image lies as deep as the reflector is high";
        ASSERT_LT(height_m, kLow_m + kBorder_m);
      }
      low += is_low ? 1.0 : 0.0;
      changed += is_low && is_changed ? 1.0 : 0.0;
    }
    ASSERT_GT(low, 1000.0);
    EXPECT_NEAR(changed / low, 0.15, 4.0 * std::sqrt(0.15 * 0.85 / low));
  }
}

TEST(RealCarSizes, YawRateSignalHasGainAndBias) {
  RealCar car;
  car.yaw_rate_gain = 0.01;
  car.yaw_rate_bias_radps = 0.1 * kRadiansPerDegree;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed plain = observe(simulator, {}, 20.0), o = observe(simulator, car, 20.0);
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d score = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < plain.signals.size(); ++i) {
      const Eigen::Vector2d row(plain.signals[i].yaw_rate_radps, 1.0);
      information += row * row.transpose();
      score += row * (o.signals[i].yaw_rate_radps - plain.signals[i].yaw_rate_radps);
      ASSERT_EQ(o.signals[i].speed_mps, plain.signals[i].speed_mps);
    }
    const Eigen::Vector2d found = information.ldlt().solve(score);
    EXPECT_NEAR(found.x(), 0.01, 1e-5);
    EXPECT_NEAR(found.y() * kDegreesPerRadian, 0.1, 1e-4);
  }
}

TEST(RealCarSizes, SpeedSignalComesInSteps) {
  RealCar car;
  car.speed_step_mps = 0.028;
  for (const Simulator simulator : kSimulators) {
    SCOPED_TRACE(name_of(simulator));
    const Observed plain = observe(simulator, {}, 20.0), o = observe(simulator, car, 20.0);
    double square = 0.0;
    for (std::size_t i = 0; i < plain.signals.size(); ++i) {
      const double error = o.signals[i].speed_mps - plain.signals[i].speed_mps;
      ASSERT_LT(std::abs(error), 0.5 * car.speed_step_mps + 1e-5);
      ASSERT_NEAR(std::remainder(o.signals[i].speed_mps, car.speed_step_mps), 0.0, 1e-5);
      square += error * error;
    }
    const double rms = std::sqrt(square / static_cast<double>(plain.signals.size()));
    EXPECT_NEAR(rms / (car.speed_step_mps / std::sqrt(12.0)), 1.0, 0.15) << "evenly distributed within a step";
  }
}

}  // namespace
}  // namespace boresight::simulator
