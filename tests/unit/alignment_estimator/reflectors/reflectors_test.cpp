// Corner reflectors: errors against the truth for various mountings, against the Cramér–Rao bound, and against the σ.
#include "services/alignment_estimator/core/reflectors/reflectors.hpp"

#include <limits>
#include <random>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::reflectors {
namespace {

using testing::DoubleNear;

constexpr double kDeg = M_PI / 180.0;

RadarConfig mounted(double yaw_deg, double roll_deg = 0.0) {
  RadarConfig radar;
  radar.id = 3;
  radar.mounting_pose = {{3.6, 0.0, 0.6}, yaw_deg * kDeg, 0.0, roll_deg * kDeg};
  radar.noise = {.range_std_m = 0.1, .azimuth_std_rad = 0.2 * kDeg, .elevation_std_rad = 0.4 * kDeg};
  return radar;
}

/// A field of reflectors and a radar with a mounting error.
struct Field {
  RadarConfig radar = mounted(0.0);
  Eigen::Vector3d truth_deg{1.2, -0.7, 0.5};  ///< yaw, pitch, roll; actual − nominal
  std::vector<Eigen::Vector3d> places;
  bool noise = true;
  double survey_std_m = 0.0, height_std_m = 0.0, mounting_std_m = 0.0;

  [[nodiscard]] Eigen::Matrix3d actual() const {
    const MountingPose& pose = radar.mounting_pose;
    return geometry::sensor_to_vehicle(pose.yaw_rad + truth_deg[0] * kDeg, pose.pitch_rad + truth_deg[1] * kDeg,
                                       pose.roll_rad + truth_deg[2] * kDeg);
  }

  [[nodiscard]] std::vector<Position> seen(std::uint64_t seed = 1) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const auto noisy = [&](double value, double std) { return value + (noise ? std * normal(random) : 0.0); };
    Eigen::Vector3d place(radar.mounting_pose.position_m.data());
    for (double& x : place) x = noisy(x, mounting_std_m);
    std::vector<Position> positions;
    for (const Eigen::Vector3d& surveyed : places) {
      const Eigen::Vector3d real(noisy(surveyed.x(), survey_std_m), noisy(surveyed.y(), survey_std_m),
                                 noisy(surveyed.z(), height_std_m));
      const Eigen::Vector3d way = actual().transpose() * (real - place);
      positions.push_back({surveyed, noisy(way.norm(), radar.noise.range_std_m),
                           noisy(std::atan2(way.y(), way.x()), radar.noise.azimuth_std_rad),
                           noisy(std::asin(way.z() / way.norm()), radar.noise.elevation_std_rad), 1});
    }
    return positions;
  }
};

/// Along the driving direction, `beside_m` to the left of the middle.
std::vector<Eigen::Vector3d> along(double beside_m = 1.0, int count = 12, double height_m = 0.6) {
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < count; ++i) places.emplace_back(10.0 + 40.0 * i / (count - 1), beside_m, height_m);
  return places;
}
/// Square to the driving direction, `ahead_m` ahead of the rear axle.
std::vector<Eigen::Vector3d> across(double ahead_m = 15.0, int count = 12) {
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < count; ++i) places.emplace_back(ahead_m, -8.0 + 16.0 * i / (count - 1), 0.6);
  return places;
}

/// The right stds if only the radar's angles are noisy.
Config only_angle_noise() {
  Config config;
  config.survey_std_m = config.height_std_m = config.mounting_std_m = 0.0;
  return config;
}

TEST(Directions, find_the_rotation_of_a_radar_in_any_mounting) {
  for (const double yaw_deg : {0.0, 45.0, -60.0}) {
    for (const double roll_deg : {0.0, 180.0, 30.0}) {
      SCOPED_TRACE(testing::Message() << "yaw " << yaw_deg << " roll " << roll_deg);
      Field field;
      field.radar = mounted(yaw_deg, roll_deg);
      field.noise = false;
      // A line along the driving direction, seen by a corner radar far from its boresight.
      field.places = along(yaw_deg < 0.0 ? -6.0 : 6.0);
      Config config = only_angle_noise();
      config.prior_roll_std_rad = 10.0;  // practically no prior: the estimate is not pulled towards 0
      config.prior_yaw_std_rad = config.prior_pitch_std_rad = 10.0;
      const Result result = fit_directions(field.seen(), field.radar, config);
      ASSERT_TRUE(result.ok()) << explain(result.problem);
      EXPECT_THAT(result.yaw_rad / kDeg, DoubleNear(1.2, 1e-3));
      EXPECT_THAT(result.pitch_rad / kDeg, DoubleNear(-0.7, 1e-3));
      EXPECT_THAT(result.roll_rad / kDeg, DoubleNear(0.5, 5e-3));
      EXPECT_EQ(result.positions_used, 12u);
      const Eigen::Matrix3d nominal = geometry::sensor_to_vehicle(field.radar.mounting_pose, 0.0, 0.0, 0.0);
      const Eigen::Matrix3d found = geometry::so3_exp(result.rotation.rotation_vehicle_rad) * nominal;
      EXPECT_LT(geometry::so3_log(found * field.actual().transpose()).norm() / kDeg, 5e-3);
      EXPECT_EQ(result.rotation.radar_id, 3u);
    }
  }
}

/// Fisher information of (yaw, pitch, roll) by finite differences of the measured angles.
Eigen::Matrix3d cramer_rao(const Field& field, const Config& config) {
  const auto angles = [&](const Eigen::Vector3d& place, const Eigen::Vector3d& alignment) {
    const MountingPose& pose = field.radar.mounting_pose;
    const Eigen::Matrix3d rotation = geometry::sensor_to_vehicle(
        pose.yaw_rad + alignment[0], pose.pitch_rad + alignment[1], pose.roll_rad + alignment[2]);
    const Eigen::Vector3d way = rotation.transpose() * (place - Eigen::Vector3d(pose.position_m.data()));
    return Eigen::Vector2d(std::atan2(way.y(), way.x()), std::asin(way.z() / way.norm()));
  };
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.diagonal() << std::pow(config.prior_yaw_std_rad, -2.0), std::pow(config.prior_pitch_std_rad, -2.0),
      std::pow(config.prior_roll_std_rad, -2.0);
  for (const Eigen::Vector3d& place : field.places) {
    Eigen::Matrix<double, 2, 3> gradient;
    const Eigen::Vector3d truth = field.truth_deg * kDeg;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = 1e-5 * Eigen::Vector3d::Unit(axis);
      gradient.col(axis) = (angles(place, truth + step) - angles(place, truth - step)) / 2e-5;
    }
    const Eigen::Vector2d weights(std::pow(field.radar.noise.azimuth_std_rad, -2.0),
                                  std::pow(field.radar.noise.elevation_std_rad, -2.0));
    information += gradient.transpose() * weights.asDiagonal() * gradient;
  }
  return information.inverse();
}

TEST(Directions, reach_the_bound_and_state_its_std) {
  for (const bool is_across : {false, true}) {
    for (const double yaw_deg : {0.0, 45.0}) {
      SCOPED_TRACE(testing::Message() << (is_across ? "across " : "along ") << yaw_deg);
      Field field;
      field.radar = mounted(yaw_deg);
      field.truth_deg = {1.2, -0.7, 0.0};  // the roll's prior is centred on the truth
      field.places = is_across ? across() : along(4.0);
      if (is_across && yaw_deg == 45.0) {
        for (Eigen::Vector3d& place : field.places) place.y() += 9.5;
      }
      const Config config = only_angle_noise();
      const Eigen::Matrix3d bound = cramer_rao(field, config);
      Eigen::Vector3d squares = Eigen::Vector3d::Zero(), stds = Eigen::Vector3d::Zero();
      constexpr int kRuns = 400;
      for (int run = 0; run < kRuns; ++run) {
        const Result result = fit_directions(field.seen(static_cast<std::uint64_t>(run)), field.radar, config);
        ASSERT_TRUE(result.ok());
        const Eigen::Vector3d error =
            Eigen::Vector3d(result.yaw_rad, result.pitch_rad, result.roll_rad) - field.truth_deg * kDeg;
        squares += error.cwiseAbs2() / kRuns;
        stds += Eigen::Vector3d(result.yaw_std_rad, result.pitch_std_rad, result.roll_std_rad) / kRuns;
      }
      for (int axis = 0; axis < (is_across ? 3 : 2); ++axis) {
        const double limit = std::sqrt(bound(axis, axis));
        EXPECT_THAT(std::sqrt(squares[axis]) / limit, DoubleNear(1.04, 0.12)) << axis;
        EXPECT_THAT(stds[axis] / limit, DoubleNear(1.1, 0.15)) << axis;
      }
    }
  }
}

TEST(Directions, state_stds_that_cover_survey_and_mounting_errors) {
  Field field;
  field.places = along(2.0);
  field.survey_std_m = 0.02;
  field.height_std_m = field.mounting_std_m = 0.01;
  field.radar.noise = {.range_std_m = 0.05, .azimuth_std_rad = 0.02 * kDeg, .elevation_std_rad = 0.02 * kDeg};
  field.truth_deg[2] = 0.0;
  double yaw = 0.0, pitch = 0.0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    const Result result = fit_directions(field.seen(static_cast<std::uint64_t>(run)), field.radar, Config{});
    yaw += std::pow((result.yaw_rad - 1.2 * kDeg) / result.yaw_std_rad, 2.0) / kRuns;
    pitch += std::pow((result.pitch_rad + 0.7 * kDeg) / result.pitch_std_rad, 2.0) / kRuns;
  }
  EXPECT_THAT(yaw, DoubleNear(0.95, 0.25));
  EXPECT_THAT(pitch, DoubleNear(0.95, 0.25));
}

TEST(Directions, reject_other_reflectors) {
  Field field;
  field.places = across();
  std::vector<Position> positions = field.seen(5);
  positions[1].azimuth_rad += 0.1;     // the neighbour's direction
  positions[7].elevation_rad += 0.08;  // a reflection by the ground
  positions[10].range_m += 3.0;        // a post behind the reflector
  const Result result = fit_directions(positions, field.radar, Config{});
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.positions_used, 9u);
  EXPECT_FALSE(result.used[1] || result.used[7] || result.used[10]);
  EXPECT_THAT(result.yaw_rad / kDeg, DoubleNear(1.2, 0.25));
  EXPECT_THAT(result.pitch_rad / kDeg, DoubleNear(-0.7, 0.4));
  EXPECT_NEAR(result.residual_azimuth_rad[1], 0.1, 0.02);
  const LineResult line = fit_line(positions, field.radar, Config{});
  ASSERT_TRUE(line.ok());
  EXPECT_THAT(line.yaw_rad / kDeg, DoubleNear(1.2, 0.7));
}

TEST(Directions, without_elevation_determine_only_yaw) {
  Field field;
  field.truth_deg = {1.2, 0.0, 0.0};
  field.places = along(2.0);
  std::vector<Position> positions = field.seen(6);
  for (Position& position : positions) position.elevation_rad = std::numeric_limits<double>::quiet_NaN();
  Config config;
  config.has_elevation = false;
  const Result result = fit_directions(positions, field.radar, config);
  ASSERT_TRUE(result.ok());
  EXPECT_THAT(result.yaw_rad / kDeg, DoubleNear(1.2, 0.2));
  EXPECT_FALSE(result.pitch_observable);
  EXPECT_FALSE(result.roll_observable);
  EXPECT_GT(result.pitch_std_rad, 5.0 * kDeg);
  const LineResult line = fit_line(positions, field.radar, config);
  ASSERT_TRUE(line.ok());
  EXPECT_EQ(line.pitch_std_rad, 0.0);
}

TEST(Directions, roll_is_observable_with_spread_reflectors_and_not_on_a_narrow_line) {
  Field field;
  field.places = along(0.2);
  EXPECT_FALSE(fit_directions(field.seen(), field.radar, Config{}).roll_observable);
  field.places = across();
  const Result wide = fit_directions(field.seen(), field.radar, Config{});
  EXPECT_TRUE(wide.roll_observable);
  EXPECT_THAT(wide.roll_rad, DoubleNear(0.5 * kDeg, 3.0 * wide.roll_std_rad));
}

TEST(Directions, more_scans_per_position_get_more_weight) {
  Field field;
  field.places = along();
  std::vector<Position> positions = field.seen();
  const Config config = only_angle_noise();
  const double once = fit_directions(positions, field.radar, config).yaw_std_rad;
  for (Position& position : positions) position.scans = 100;
  const Result often = fit_directions(positions, field.radar, config);
  // The same scatter contradicts the smaller std and widens it again.
  EXPECT_GT(often.noise_scale, 4.0);
  EXPECT_NEAR(often.yaw_std_rad / once, 1.0, 0.6);
}

TEST(Line, has_the_yaw_of_the_slope_and_the_pitch_of_the_elevations) {
  for (const bool is_across : {false, true}) {
    Field field;
    field.truth_deg = {1.2, -0.7, 0.0};
    field.noise = false;
    field.places = is_across ? across() : along(0.0);
    const LineResult result = fit_line(field.seen(), field.radar, Config{});
    ASSERT_TRUE(result.ok()) << explain(result.problem);
    EXPECT_EQ(result.across, is_across);
    EXPECT_THAT(result.yaw_rad / kDeg, DoubleNear(1.2, 0.001));
    // Seen from the side, a pitch error counts only by the cosine, up to 35° here.
    EXPECT_THAT(result.pitch_rad / kDeg, DoubleNear(-0.7, is_across ? 0.1 : 0.001));
  }
}

TEST(Line, has_the_std_that_its_errors_have) {
  for (const bool is_across : {false, true}) {
    SCOPED_TRACE(is_across ? "across" : "along");
    Field field;
    field.truth_deg = {1.2, -0.7, 0.0};
    field.places = is_across ? across() : along(0.0);
    field.survey_std_m = 0.02;
    field.height_std_m = 0.01;
    double nees = 0.0, line_squares = 0.0, own_squares = 0.0;
    constexpr int kRuns = 400;
    for (int run = 0; run < kRuns; ++run) {
      const std::vector<Position> positions = field.seen(static_cast<std::uint64_t>(run));
      const LineResult line = fit_line(positions, field.radar, Config{});
      const Result own = fit_directions(positions, field.radar, Config{});
      ASSERT_TRUE(line.ok() && own.ok());
      nees += std::pow((line.yaw_rad - 1.2 * kDeg) / line.yaw_std_rad, 2.0) / kRuns;
      line_squares += std::pow(line.yaw_rad - 1.2 * kDeg, 2.0);
      own_squares += std::pow(own.yaw_rad - 1.2 * kDeg, 2.0);
    }
    EXPECT_THAT(nees, DoubleNear(0.95, 0.3));
    // The fit of directions also uses the position of the line, not only its slope.
    EXPECT_LT(own_squares, 0.7 * line_squares);
  }
}

TEST(Line, of_a_corner_radar_mixes_pitch_and_roll_where_directions_do_not) {
  Field field;
  field.radar = mounted(45.0);
  field.noise = false;
  field.truth_deg = {1.0, 0.8, 0.6};
  field.places = along(5.0);
  Config config;
  config.prior_roll_std_rad = 10.0;
  const std::vector<Position> positions = field.seen();
  const LineResult line = fit_line(positions, field.radar, config);
  const Result own = fit_directions(positions, field.radar, config);
  ASSERT_TRUE(line.ok() && own.ok());
  EXPECT_GT(std::abs(line.pitch_rad / kDeg - 0.8), 0.3);
  EXPECT_NEAR(own.pitch_rad / kDeg, 0.8, 0.01);
}

TEST(Reflectors, refuse_invalid_positions_and_report_their_index) {
  Field field;
  field.places = along();
  const std::vector<Position> good = field.seen();
  const auto expect = [&](const std::vector<Position>& positions, Problem problem, std::size_t at) {
    const Result result = fit_directions(positions, field.radar, Config{});
    EXPECT_EQ(result.problem, problem) << explain(result.problem);
    EXPECT_EQ(result.problem_position, at);
    const LineResult line = fit_line(positions, field.radar, Config{});
    EXPECT_EQ(line.problem, problem);
    EXPECT_EQ(line.problem_position, at);
  };
  std::vector<Position> bad(good.begin(), good.begin() + 9);
  expect(bad, Problem::kTooFewPositions, 9);
  expect({}, Problem::kTooFewPositions, 0);
  bad = good;
  bad[4].azimuth_rad = std::numeric_limits<double>::quiet_NaN();
  expect(bad, Problem::kNotFinite, 4);
  bad = good;
  bad[5].surveyed_m.x() = 70.0;
  expect(bad, Problem::kOutOfRange, 5);
  bad[5].surveyed_m.x() = 4.0;
  expect(bad, Problem::kOutOfRange, 5);
  bad[5].surveyed_m.x() = -10.0;
  expect(bad, Problem::kOutOfView, 5);
}

TEST(Reflectors, contradicting_positions_give_no_result) {
  Field field;
  field.places = across();
  std::vector<Position> positions = field.seen();
  for (std::size_t i = 0; i < 7; ++i) positions[i].range_m += 5.0;
  EXPECT_EQ(fit_directions(positions, field.radar, Config{}).problem, Problem::kTooFewAgree);
  for (Position& position : positions) position.range_m = 0.0;
  EXPECT_EQ(fit_directions(positions, field.radar, Config{}).problem, Problem::kTooFewAgree);
  EXPECT_EQ(fit_line(positions, field.radar, Config{}).problem, Problem::kTooFewAgree);
}

TEST(Line, needs_a_line_along_or_across) {
  Field field;
  field.places = along();
  field.places[3].y() += 0.5;
  LineResult line = fit_line(field.seen(), field.radar, Config{});
  EXPECT_EQ(line.problem, Problem::kNotALine);
  EXPECT_EQ(line.problem_position, 3u);
  EXPECT_TRUE(fit_directions(field.seen(), field.radar, Config{}).ok()) << "the fit of directions needs no line";
  field.places = along();
  for (Eigen::Vector3d& place : field.places) place.y() = 0.3 * (place.x() - 10.0);
  EXPECT_EQ(fit_line(field.seen(), field.radar, Config{}).problem, Problem::kSkewLine);
  for (std::size_t i = 0; i < field.places.size(); ++i) {
    field.places[i] = {20.0 + 0.2 * static_cast<double>(i), 0.0, 0.6};
  }
  EXPECT_EQ(fit_line(field.seen(), field.radar, Config{}).problem, Problem::kLineTooShort);
}

TEST(Reflectors, every_problem_has_a_sentence) {
  std::vector<std::string_view> sentences;
  for (int i = 0; i <= static_cast<int>(Problem::kSkewLine); ++i) {
    sentences.push_back(explain(static_cast<Problem>(i)));
    EXPECT_NE(sentences.back(), "?");
  }
  std::sort(sentences.begin(), sentences.end());
  EXPECT_EQ(std::adjacent_find(sentences.begin(), sentences.end()), sentences.end());
}

}  // namespace
}  // namespace boresight::alignment::reflectors
