// The model's derivatives against differences of the model itself, and the sums of a scan against its likelihood.
#include <algorithm>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/windows/block.hpp"
#include "tests/unit/alignment_estimator/windows/points.hpp"

namespace boresight::alignment::windows {
namespace {

constexpr std::array<double, 3> kPosition_m{3.4, -0.8, 0.5};

Motion some_motion() {
  Motion m;
  m.speed_mps = 17.0;
  m.yaw_rate_radps = 0.21;
  m.acceleration_mps2 = m.clear_acceleration_mps2 = 1.3;
  m.clear_yaw_acceleration_radps2 = 0.4;
  m.yaw_rate_std_radps = 0.001;
  return m;
}

struct Mount {
  double yaw_deg, pitch_deg, roll_deg;
};
const std::vector<Mount> kMounts = {{0.0, 0.0, 0.0}, {135.0, 5.0, 180.0}, {-90.0, -5.0, 0.0}, {30.0, 10.0, 90.0}};

TEST(ScanModel, DifferenceIsTheInverseOfAStep) {
  for (const Mount& mount : kMounts) {
    const Point from = some_point(mount.yaw_deg, mount.pitch_deg, mount.roll_deg);
    LocalVector d;
    for (int c = 0; c < local::kCount; ++c) d(c) = 0.01 * std::cos(1.0 + c);
    EXPECT_LT((difference(from, moved(from, d)) - d).norm(), 1e-12);
    // A turn counts about the vehicle's axes, whatever the mounting.
    Point turned = from;
    turned.sensor_to_vehicle = geometry::so3_exp({0.0, 0.0, 0.02}) * from.sensor_to_vehicle;
    EXPECT_LT((difference(from, turned).segment<3>(local::kRotation) - Eigen::Vector3d(0, 0, 0.02)).norm(), 1e-12);
  }
}

TEST(ScanModel, EveryDerivativeEqualsADifference) {
  for (const Mount& mount : kMounts) {
    const Motion motion = some_motion();
    constexpr double kStep = 1e-6;
    for (int c = 0; c < local::kCurve; ++c) {
      Point point = some_point(mount.yaw_deg, mount.pitch_deg, mount.roll_deg);
      // The product of roll and body pitch is missing in the derivative on purpose.
      if (c == local::kRotation) point.pitch_per_acceleration_radps2pm = 0.0;
      const ScanModel model = model_scan(point, kPosition_m, motion);
      const auto at = [&](double step) {
        LocalVector d = LocalVector::Zero();
        d(c) = step;
        Motion then = motion;
        if (c == local::kStamp) {  // the motion at another time
          then.speed_mps += step * motion.clear_acceleration_mps2;
          then.yaw_rate_radps += step * motion.clear_yaw_acceleration_radps2;
        }
        return model_scan(moved(point, d), kPosition_m, then).g;
      };
      const Eigen::Vector3d slope = (at(kStep) - at(-kStep)) / (2.0 * kStep);
      EXPECT_LT((slope - model.by_parameter.row(c).transpose()).norm(), 1e-6 * (1.0 + slope.norm()))
          << "parameter " << c << ", mounting yaw " << mount.yaw_deg;
    }
  }
}

TEST(ScanModel, ErrorsOfTheMotionActAsThoseOfTheSignals) {
  const Point point = some_point();
  const Motion motion = some_motion();
  const ScanModel model = model_scan(point, kPosition_m, motion);
  constexpr double kStep = 1e-6;
  const auto slope = [&](double Motion::*member) {
    Motion more = motion, less = motion;
    more.*member += kStep;
    less.*member -= kStep;
    return Eigen::Vector3d((model_scan(point, kPosition_m, more).g - model_scan(point, kPosition_m, less).g) /
                           (2.0 * kStep));
  };
  EXPECT_LT((slope(&Motion::speed_mps) - model.by_motion.row(0).transpose()).norm(), 1e-6);
  EXPECT_LT((slope(&Motion::yaw_rate_radps) - model.by_motion.row(1).transpose()).norm(), 1e-6);
  // A body pitch with the nose up, and a slip to the left, are vertical and lateral speed.
  const double speed = point.speed_scale * motion.speed_mps;
  const Eigen::Matrix3d to_sensor = (1.0 + point.rate_scale) * point.sensor_to_vehicle.transpose();
  EXPECT_LT((to_sensor * Eigen::Vector3d(0, 0, speed) - model.by_motion.row(2).transpose()).norm(), 1e-9);
  EXPECT_LT((to_sensor * Eigen::Vector3d(0, speed, 0) - model.by_motion.row(3).transpose()).norm(), 1e-9);
}

TEST(ScanModel, NoiseOfTheYawRateTellsNothingOfGainAndSlip) {
  Motion straight = some_motion();
  straight.yaw_rate_radps = 0.003;  // the point's bias is 0.002
  const ScanModel model = model_scan(some_point(), kPosition_m, straight);
  EXPECT_EQ(model.by_parameter.row(local::kYawRateGain).norm(), 0.0);
  EXPECT_EQ(model.by_parameter.row(local::kSlip).norm(), 0.0);
  EXPECT_GT(model.by_parameter.row(local::kYawRateBias).norm(), 0.1);
}

TEST(ScanModel, ErrorsInTheVehicleDoNotDependOnTheSensorsOwnAxes) {
  // A sensor that is turned about its own axes sees the same velocity in its new axes, with the same derivatives.
  Point point = some_point(20.0, 0.0, 0.0);
  const Eigen::Matrix3d turn = geometry::so3_exp({0.4, -0.3, 1.1});
  const ScanModel before = model_scan(point, kPosition_m, some_motion());
  point.sensor_to_vehicle = point.sensor_to_vehicle * turn;
  const ScanModel after = model_scan(point, kPosition_m, some_motion());
  EXPECT_LT((after.g - turn.transpose() * before.g).norm(), 1e-12);
  EXPECT_LT((after.by_parameter - before.by_parameter * turn).norm(), 1e-10);
  EXPECT_LT((after.by_motion - before.by_motion * turn).norm(), 1e-10);
}

// ---- Sums of a scan.

const Knots kView{-1.2, 0.24};
const Eigen::Vector3d kVelocity(16.0, 5.0, -0.7);

void add_sighting(Sightings& s, double azimuth, double elevation, double range_m, double error_mps, double angle_std) {
  const std::size_t i = s.count++;
  s.x[i] = std::cos(elevation) * std::cos(azimuth);
  s.y[i] = std::cos(elevation) * std::sin(azimuth);
  s.z[i] = std::sin(elevation);
  s.azimuth_rad[i] = azimuth;
  s.range_m[i] = range_m;
  s.range_rate_mps[i] = -kVelocity.dot(Eigen::Vector3d(s.x[i], s.y[i], s.z[i])) + error_mps;
  s.azimuth_variance[i] = s.elevation_variance[i] = angle_std * angle_std;
  s.range_rate_variance[i] = 0.01;
  s.azimuth_std_slope[i] = s.lowering[i] = s.lowering_variance[i] = s.mean_sine[i] = 0.0;
}

/// Detections above the road, with exact angles.
std::unique_ptr<Sightings> exact_scan() {
  auto s = std::make_unique<Sightings>();
  s->has_elevation = true;
  for (int i = 0; i < 40; ++i) {
    add_sighting(*s, -1.1 + 0.055 * i, 0.03 + 0.05 * std::sin(3.0 * i), 20.0 + i, 0.15 * std::sin(7.0 * i), 0.0);
  }
  return s;
}

CurveJudgement judgement() {
  CurveJudgement j;
  j.gate = 5.0;
  j.height_m = 0.5;
  return j;
}

/// Logarithm of Tukey's likelihood of exact angles.
double log_likelihood(const Sightings& s, const Eigen::Vector3d& g, const Curve& curve, const CurveJudgement& j) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.count; ++i) {
    const double place = (s.azimuth_rad[i] - kView.first_rad) / kView.step_rad;
    const int knot = std::clamp(static_cast<int>(place), 0, kKnots - 2);
    const double share = std::clamp(place - knot, 0.0, 1.0);
    const double error = curve(knot) * (1.0 - share) + curve(knot + 1) * share;
    const Eigen::Vector3d u(std::cos(error) * s.x[i] + std::sin(error) * s.y[i],
                            std::cos(error) * s.y[i] - std::sin(error) * s.x[i], s.z[i]);
    const double z = j.up.dot(u), by_elevation = (j.up.dot(g) - z * u.dot(g)) / std::sqrt(1.0 - z * z);
    const double height = j.height_m / s.range_m[i] + j.up.dot(u);
    const double e = s.range_rate_mps[i] + u.dot(g) + j.height_excess * by_elevation * height;
    const double t = e * e / s.range_rate_variance[i] / (j.gate * j.gate);
    sum -= t < 1.0 ? j.gate * j.gate / 6.0 * (1.0 - std::pow(1.0 - t, 3)) : j.gate * j.gate / 6.0;
  }
  return sum;
}

TEST(CurveSums, ScoreIsTheDerivativeOfTheLogLikelihood) {
  const auto scan = exact_scan();
  const Curve curve = some_point().curve_rad;
  constexpr double kStep = 1e-5;
  const CurveSums sums = sum_scan(*scan, kVelocity, curve, kView, judgement());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    const double slope = (log_likelihood(*scan, kVelocity + step, curve, judgement()) -
                          log_likelihood(*scan, kVelocity - step, curve, judgement())) /
                         (2.0 * kStep);
    EXPECT_NEAR(sums.score(axis), slope, 1e-2 * (1.0 + std::abs(slope))) << axis;
  }
  for (int k = 0; k < kKnots; ++k) {
    const Curve step = kStep * Curve::Unit(k);
    const double slope = (log_likelihood(*scan, kVelocity, curve + step, judgement()) -
                          log_likelihood(*scan, kVelocity, curve - step, judgement())) /
                         (2.0 * kStep);
    EXPECT_NEAR(sums.curve_score(k), slope, 1e-2 * (1.0 + std::abs(slope))) << "knot " << k;
  }
  CurveJudgement more = judgement(), less = judgement();
  more.height_excess = kStep;
  less.height_excess = -kStep;
  const double slope =
      (log_likelihood(*scan, kVelocity, curve, more) - log_likelihood(*scan, kVelocity, curve, less)) / (2.0 * kStep);
  EXPECT_NEAR(sums.heights[0].score, slope, 1e-2 * (1.0 + std::abs(slope)));
  EXPECT_EQ(sums.detections, 40.0);
}

TEST(CurveSums, InformationOfSmallResidualsIsThatOfLeastSquares) {
  auto scan = std::make_unique<Sightings>();
  scan->has_elevation = true;
  for (int i = 0; i < 30; ++i) add_sighting(*scan, -1.0 + 0.06 * i, 0.02 * (i % 4), 25.0, 1e-4, 0.0);
  const CurveSums sums = sum_scan(*scan, kVelocity, Curve::Zero(), kView, judgement());
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, kKnots, kKnots> of_curve = Eigen::Matrix<double, kKnots, kKnots>::Zero();
  Eigen::Matrix<double, kKnots, 3> cross = Eigen::Matrix<double, kKnots, 3>::Zero();
  for (std::size_t i = 0; i < scan->count; ++i) {
    const Eigen::Vector3d u(scan->x[i], scan->y[i], scan->z[i]);
    Curve hats = Curve::Zero();
    for (int k = 0; k < kKnots; ++k) {
      hats(k) =
          std::max(0.0, 1.0 - std::abs(scan->azimuth_rad[i] - kView.first_rad - k * kView.step_rad) / kView.step_rad);
    }
    hats *= u.y() * kVelocity.x() - u.x() * kVelocity.y();  // ∂e/∂(azimuth error)
    information += u * u.transpose() / 0.01;
    of_curve += hats * hats.transpose() / 0.01;
    cross += hats * u.transpose() / 0.01;
  }
  EXPECT_LT((sums.information - information).norm(), 1e-3 * information.norm());
  EXPECT_LT((sums.curve_by_velocity - cross).norm(), 1e-3 * cross.norm());
  for (int k = 0; k < kKnots; ++k) {
    EXPECT_NEAR(sums.curve_diagonal(k), of_curve(k, k), 1e-3 * of_curve.norm());
    if (k + 1 == kKnots) continue;
    EXPECT_NEAR(sums.curve_next(k), of_curve(k, k + 1), 1e-3 * of_curve.norm());
  }
}

TEST(CurveSums, ADetectionTouchesItsKnotsOnly) {
  for (const auto& [azimuth, first, last] : std::vector<std::tuple<double, int, int>>{
           {-1.2 + 0.24 * 3, 3, 3}, {-1.2 + 0.24 * 3.5, 3, 4}, {-1.4, 0, 0}, {1.4, kKnots - 1, kKnots - 1}}) {
    auto scan = std::make_unique<Sightings>();
    scan->has_elevation = true;
    add_sighting(*scan, azimuth, 0.02, 30.0, 0.05, 0.0);
    const CurveSums sums = sum_scan(*scan, kVelocity, Curve::Zero(), kView, judgement());
    for (int k = 0; k < kKnots; ++k) {
      const bool touched = k >= first && k <= last;
      EXPECT_EQ(std::abs(sums.curve_score(k)) > 1e-9, touched) << azimuth << ", knot " << k;
      EXPECT_EQ(sums.curve_diagonal(k) > 1e-9, touched) << azimuth << ", knot " << k;
    }
  }
}

TEST(CurveSums, NoiseOfTheAnglesDoesNotBiasTheScore) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> azimuth(-1.1, 1.1), elevation(-0.01, 0.12);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = sum, without = sum;
  auto scan = std::make_unique<Sightings>();
  constexpr double kStd = 0.6 * kDegreeOfTest;
  for (int k = 0; k < 4000; ++k) {
    scan->count = 0;
    scan->has_elevation = true;
    for (int i = 0; i < 20; ++i) {
      const double a = azimuth(random), b = elevation(random);
      const double rate = -kVelocity.dot(geometry::direction(a, b)) + 0.1 * normal(random);
      add_sighting(*scan, a + kStd * normal(random), b + kStd * normal(random), 40.0, 0.0, kStd);
      scan->range_rate_mps[scan->count - 1] = rate;
    }
    CurveJudgement no_road = judgement();
    no_road.height_m = 0.0;
    const CurveSums sums = sum_scan(*scan, kVelocity, Curve::Zero(), kView, no_road);
    sum += sums.score;
    squares += sums.score.cwiseAbs2();
    // Least squares alone, as if the angles were exact.
    for (std::size_t i = 0; i < scan->count; ++i) {
      const Eigen::Vector3d u(scan->x[i], scan->y[i], scan->z[i]);
      without -= u * (scan->range_rate_mps[i] + u.dot(kVelocity)) / 0.02;
    }
  }
  const Eigen::Vector3d stds = squares.cwiseSqrt();
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(std::abs(sum(axis)), 4.5 * stds(axis)) << axis;
  EXPECT_GT(without.cwiseAbs().cwiseQuotient(stds).maxCoeff(), 6.0) << "otherwise the test cannot fail";
}

TEST(CurveSums, DetectionsBelowTheRoadAreMirrorImages) {
  auto scan = std::make_unique<Sightings>();
  scan->has_elevation = true;
  constexpr double kElevation = -0.06, kRange_m = 20.0;
  // A radar 0.5 m over the road: at 20 m the road is 0.025 rad below. The mirror image at −0.06 is of a reflector at
  // +0.01.
  for (int i = 0; i < 20; ++i) add_sighting(*scan, -0.5 + 0.05 * i, kElevation, kRange_m, 0.0, 0.0);
  const double true_elevation = -kElevation - 2.0 * 0.5 / kRange_m;
  for (std::size_t i = 0; i < scan->count; ++i) {
    scan->range_rate_mps[i] = -kVelocity.dot(geometry::direction(scan->azimuth_rad[i], true_elevation));
  }
  const auto score_at = [&](double share) {
    CurveJudgement j = judgement();
    j.mirror_share = share;
    const CurveSums sums = sum_scan(*scan, kVelocity, Curve::Zero(), kView, j);
    EXPECT_EQ(sums.heights[0].diagonal, 0.0);
    EXPECT_GT(sums.heights[1].diagonal, 0.0);
    return sums.heights[1].score;
  };
  EXPECT_GT(score_at(0.8), 0.0);
  EXPECT_NEAR(score_at(1.0), 0.0, 0.03 * score_at(0.8));
  EXPECT_LT(score_at(1.2), 0.0);
  // Without elevations nothing is said about heights.
  scan->has_elevation = false;
  const CurveSums sums = sum_scan(*scan, kVelocity, Curve::Zero(), kView, judgement());
  EXPECT_EQ(sums.heights[0].diagonal, 0.0);
  EXPECT_EQ(sums.heights[1].diagonal, 0.0);
}

// ---- Elimination of the errors of the motion.

TEST(Block, EliminationOfMotionErrorsEqualsTheDenseInverse) {
  for (const Mount& mount : kMounts) {
    const Point point = some_point(mount.yaw_deg, mount.pitch_deg, mount.roll_deg);
    const ScanModel model = model_scan(point, kPosition_m, some_motion());
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    CurveSums sums;
    constexpr int kAll = local::kCount + kMotionErrors;
    Eigen::Matrix<double, kAll, kAll> information = Eigen::Matrix<double, kAll, kAll>::Zero();
    Eigen::Matrix<double, kAll, 1> score = Eigen::Matrix<double, kAll, 1>::Zero();
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d u(uniform(random), uniform(random), uniform(random));
      const int knot = i % (kKnots - 1), side = i % 2;
      const double c0 = uniform(random), c1 = uniform(random), height = uniform(random), e = uniform(random);
      const double w = 1.5 + uniform(random);
      sums.information += w * u * u.transpose();
      sums.score += w * e * u;
      sums.curve_by_velocity.row(knot) += w * c0 * u.transpose();
      sums.curve_by_velocity.row(knot + 1) += w * c1 * u.transpose();
      sums.curve_diagonal(knot) += w * c0 * c0;
      sums.curve_diagonal(knot + 1) += w * c1 * c1;
      sums.curve_next(knot) += w * c0 * c1;
      sums.curve_score(knot) += w * e * c0;
      sums.curve_score(knot + 1) += w * e * c1;
      CurveSums::Heights& heights = sums.heights[static_cast<std::size_t>(side)];
      heights.by_velocity += w * height * u;
      heights.by_curve(knot) += w * height * c0;
      heights.by_curve(knot + 1) += w * height * c1;
      heights.diagonal += w * height * height;
      heights.score += w * e * height;
      // The same detection as one row over all parameters.
      Eigen::Matrix<double, kAll, 1> row = Eigen::Matrix<double, kAll, 1>::Zero();
      row.head<local::kCurve>() = model.by_parameter * u;
      row(local::kCurve + knot) = c0;
      row(local::kCurve + knot + 1) = c1;
      row(local::kAbove + side) = height;
      row.tail<kMotionErrors>() = model.by_motion * u;
      information += w * row * row.transpose();
      score += w * e * row;
    }
    const MotionVariances variances{0.03 * 0.03, 0.002 * 0.002, 0.0, 1e-6};
    const LossFactors factors{0.8, 0.9};
    information *= factors.information;
    score *= factors.score;
    for (int m = 0; m < kMotionErrors; ++m) {
      const double variance = variances[static_cast<std::size_t>(m)];
      information(local::kCount + m, local::kCount + m) += variance > 0.0 ? 1.0 / variance : 1e15;
    }
    const Eigen::MatrixXd cross = information.topRightCorner<local::kCount, kMotionErrors>();
    const Eigen::Matrix4d own = information.bottomRightCorner<kMotionErrors, kMotionErrors>();
    const LocalMatrix expected =
        information.topLeftCorner<local::kCount, local::kCount>() - cross * own.inverse() * cross.transpose();
    const LocalVector expected_score =
        score.head<local::kCount>() - cross * own.inverse() * score.tail<kMotionErrors>();
    Block block;
    block.clear(point);
    add_scan(block, model, sums, variances, factors);
    EXPECT_LT((block.information - expected).norm(), 1e-9 * expected.norm()) << mount.yaw_deg;
    EXPECT_LT((block.score - expected_score).norm(), 1e-9 * expected_score.norm()) << mount.yaw_deg;
    EXPECT_EQ(block.scans, 1);
    // A second scan adds the same.
    add_scan(block, model, sums, variances, factors);
    EXPECT_LT((block.information - 2.0 * expected).norm(), 1e-9 * expected.norm());
  }
}

}  // namespace
}  // namespace boresight::alignment::windows
