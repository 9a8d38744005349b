// The solution over all segments against one dense weighted least-squares problem over all parameters.
#include "services/alignment_estimator/core/windows/solver.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/windows/reduced.hpp"
#include "tests/unit/alignment_estimator/windows/shares.hpp"

namespace boresight::alignment::windows {
namespace {

constexpr int kRadars = 2, kSegments = 3;
constexpr std::array<double, kSegments> kSeconds{4.0, 2.0, 2.0}, kMiddle_s{2.0, 5.0, 7.0};
constexpr std::array<int, kSegments> kLoad{0, 0, 1};
constexpr double kNow_s = 8.0, kKnotStep_rad = 0.2;

Eigen::Matrix3d nominal(int radar) {
  return geometry::sensor_to_vehicle(radar == 0 ? 0.7 : -2.3, 0.05, radar == 0 ? 0.0 : M_PI);
}

Priors priors() {
  Priors p;
  p.drift_std_radps = 2e-4;
  return p;
}

struct Problem {
  Solver solver{kRadars, priors()};
  Segments segments{kRadars};
};

/// Every share counts from the prior, so that the problem is linear.
std::unique_ptr<Problem> problem(unsigned seed, bool elevation_of_1 = true, bool shares_of_1 = true) {
  auto p = std::make_unique<Problem>();
  for (std::size_t r = 0; r < kRadars; ++r) {
    p->solver.set_prior(r, nominal(static_cast<int>(r)), r == 0 || elevation_of_1, kKnotStep_rad);
  }
  p->solver.begin(kNow_s);
  p->solver.stop();
  RandomShares shares(seed);
  for (int i = 0; i < kSegments; ++i) {
    const auto at = static_cast<std::size_t>(i);
    p->segments.begin(kLoad[at], p->solver.merge_noise());
    p->segments.segment(i).seconds = kSeconds[at];
    p->segments.segment(i).middle_s = kMiddle_s[at];
    for (std::size_t r = 0; r < kRadars; ++r) {
      const Share share = shares.next(p->solver.point(r, kMiddle_s[at], kLoad[at]), kSeconds[at]);
      if (r == 0 || shares_of_1) p->segments.share(i, r) = share;
    }
  }
  return p;
}

// Columns of the dense problem: each radar's own, the vehicle's constants and loads, the common fluctuations of each
// segment, then each radar's own ones of each segment, and its roll's.
constexpr int kConstants = kRadars * own::kCount, kCommon = kConstants + shared::kConstants + shared::kLoads;
constexpr int kOwnFluctuation = kCommon + kFluctuations * kSegments;
constexpr int kOwnRoll = kOwnFluctuation + kRadars * kFluctuations * kSegments;
constexpr int kDense = kOwnRoll + kRadars * kSegments;
struct Dense {
  Eigen::VectorXd step;
  Eigen::MatrixXd covariance;
};

/// Rows: local parameters of a radar in a segment; columns: all parameters.
Eigen::MatrixXd action(int radar, int segment) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(local::kCount, kDense);
  const int own_first = radar * own::kCount;
  const auto s = static_cast<std::size_t>(segment);
  a(local::kRateScale, own_first + own::kRateScale) = 1.0;
  for (int axis = 0; axis < 3; ++axis) a(local::kRotation + axis, own_first + own::kRotation + axis) = 1.0;
  a(local::kStamp, own_first + own::kStamp) = a(local::kStamp, kConstants + shared::kStamp) = 1.0;
  for (int axis = 0; axis < 2; ++axis) a(local::kPosition + axis, own_first + own::kPosition + axis) = 1.0;
  for (int k = 0; k < kKnots; ++k) a(local::kCurve + k, own_first + own::kCurve + k) = 1.0;
  a(local::kAbove, own_first + own::kAbove) = a(local::kMirror, own_first + own::kMirror) = 1.0;
  a(local::kRotation + 1, own_first + own::kPitchDrift) = kMiddle_s[s] - kNow_s;
  a(local::kRotation + 2, own_first + own::kYawDrift) = kMiddle_s[s] - kNow_s;
  a(local::kSpeedScale, kConstants + shared::kSpeedScale) = 1.0;
  a(local::kYawRateBias, kConstants + shared::kYawRateBias) = 1.0;
  a(local::kYawRateGain, kConstants + shared::kYawRateGain) = 1.0;
  a(local::kSlip, kConstants + shared::kSlip) = 1.0;
  a(local::kPitchPerAcceleration, kConstants + shared::kPitchPerAcceleration) = 1.0;
  for (int load = 0; load < kLoad[s]; ++load) a(local::kRotation + 1, kConstants + shared::kLoad + load) = 1.0;
  for (int k = 0; k < kFluctuations; ++k) {
    const int row = kFluctuating[static_cast<std::size_t>(k)];
    a(row, kCommon + kFluctuations * segment + k) = 1.0;
    a(row, kOwnFluctuation + kFluctuations * (kSegments * radar + segment) + k) = 1.0;
  }
  a(local::kRotation, kOwnRoll + kSegments * radar + segment) = 1.0;
  return a;
}

Dense dense_solution(const Problem& p) {
  const Priors& prior = p.solver.priors();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kDense, kDense);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(kDense);
  for (int r = 0; r < kRadars; ++r) {
    const RadarSolution& radar = p.solver.radar(static_cast<std::size_t>(r));
    auto own_block = information.block<own::kCount, own::kCount>(r * own::kCount, r * own::kCount);
    own_block = radar.prior;
    own_block(own::kPitchDrift, own::kPitchDrift) =
        radar.has_elevation ? 1.0 / std::pow(prior.drift_std_radps, 2) : 1e18;
    own_block(own::kYawDrift, own::kYawDrift) = 1.0 / std::pow(prior.drift_std_radps, 2);
    for (int s = 0; s < kSegments; ++s) {
      for (int k = 0; k < kFluctuations; ++k) {
        const int c = kOwnFluctuation + kFluctuations * (kSegments * r + s) + k;
        const double std = prior.own_std[static_cast<std::size_t>(k)];
        information(c, c) = k == 1 && !radar.has_elevation ? 1e18 : 1.0 / (std * std);
      }
      const int roll = kOwnRoll + kSegments * r + s;
      information(roll, roll) = radar.has_elevation ? std::pow(prior.roll_per_pitch * prior.own_std[1], -2) : 1e18;
    }
  }
  const std::array<double, shared::kConstants> stds{prior.speed_scale_std,
                                                    prior.yaw_rate_bias_std_radps,
                                                    prior.yaw_rate_gain_std,
                                                    prior.slip_std_radps2pm,
                                                    prior.pitch_per_acceleration_std_radps2pm,
                                                    prior.common_stamp_std_s};
  for (int c = 0; c < shared::kConstants; ++c) {
    information(kConstants + c, kConstants + c) = std::pow(stds[static_cast<std::size_t>(c)], -2);
  }
  for (int load = 0; load < shared::kLoads; ++load) {
    information(kConstants + shared::kLoad + load, kConstants + shared::kLoad + load) =
        std::pow(prior.load_std_rad, -2);
  }
  // Common fluctuations: means of an Ornstein–Uhlenbeck process, each with the one before.
  for (int k = 0; k < kFluctuations; ++k) {
    const double tau_s = prior.common_correlation_s,
                 variance = std::pow(prior.common_std[static_cast<std::size_t>(k)], 2);
    Eigen::Matrix<double, kSegments, kSegments> covariance;
    for (int i = 0; i < kSegments; ++i) {
      const double length = kSeconds[static_cast<std::size_t>(i)];
      covariance(i, i) = variance * share_of_mean(length, tau_s);
      if (i == 0) continue;
      const double before = kSeconds[static_cast<std::size_t>(i - 1)];
      const double shared = variance * tau_s * tau_s / (length * before) * (1.0 - std::exp(-length / tau_s)) *
                            (1.0 - std::exp(-before / tau_s));
      const double keep = shared / covariance(i - 1, i - 1);
      for (int j = 0; j < i; ++j) covariance(i, j) = covariance(j, i) = keep * covariance(i - 1, j);
    }
    const Eigen::Matrix3d precision = covariance.inverse();
    for (int i = 0; i < kSegments; ++i) {
      for (int j = 0; j < kSegments; ++j) {
        information(kCommon + kFluctuations * i + k, kCommon + kFluctuations * j + k) = precision(i, j);
      }
    }
  }
  for (int r = 0; r < kRadars; ++r) {
    for (int s = 0; s < kSegments; ++s) {
      const Share& share = p.segments.share(s, static_cast<std::size_t>(r));
      if (share.seconds <= 0.0) continue;
      const Eigen::MatrixXd a = action(r, s);
      information += a.transpose() * share.information * a;
      score += a.transpose() * share.score;
    }
  }
  // Scaled, since the units differ by orders of magnitude.
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(scaled);
  Dense d;
  d.step = scale.asDiagonal() * ldlt.solve(Eigen::VectorXd(scale.asDiagonal() * score));
  d.covariance = scale.asDiagonal() * ldlt.solve(Eigen::MatrixXd::Identity(kDense, kDense)) * scale.asDiagonal();
  return d;
}

/// Step of a radar's own parameters that the solver has made from its prior.
OwnVector step_of(const RadarSolution& radar, const Eigen::Matrix3d& from) {
  OwnVector d;
  d(own::kRateScale) = radar.state.rate_scale;
  d.segment<3>(own::kRotation) = geometry::so3_log(radar.state.sensor_to_vehicle * from.transpose());
  d(own::kStamp) = radar.state.stamp_s;
  d.segment<2>(own::kPosition) = radar.state.position_error_m;
  d.segment<kKnots>(own::kCurve) = radar.state.curve_rad;
  d(own::kAbove) = radar.state.height_excess;
  d(own::kMirror) = radar.state.mirror_share;
  d.tail<2>() = radar.state.drift_radps;
  return d;
}

void expect_dense(const Solver& solver, const Dense& dense) {
  for (int r = 0; r < kRadars; ++r) {
    const RadarSolution& radar = solver.radar(static_cast<std::size_t>(r));
    const int first = r * own::kCount;
    const Eigen::MatrixXd expected = dense.covariance.block(first, first, own::kCount, own::kCount);
    const Eigen::VectorXd stds = expected.diagonal().cwiseSqrt();
    EXPECT_LT((step_of(radar, nominal(r)) - dense.step.segment(first, own::kCount)).cwiseQuotient(stds).norm(), 1e-5)
        << r;
    const Eigen::VectorXd inverse = stds.cwiseInverse();
    EXPECT_LT((inverse.asDiagonal() * (radar.covariance - expected) * inverse.asDiagonal()).norm(), 1e-5) << r;
    const Eigen::MatrixXd with = dense.covariance.block(first, kConstants, own::kCount, shared::kConstants);
    const Eigen::VectorXd of_constants =
        dense.covariance.diagonal().segment(kConstants, shared::kConstants).cwiseSqrt().cwiseInverse();
    EXPECT_LT((inverse.asDiagonal() * (radar.with_shared - with) * of_constants.asDiagonal()).norm(), 1e-5) << r;
  }
  const SharedState& s = solver.shared();
  Eigen::Matrix<double, shared::kConstants, 1> constants;
  constants << s.speed_scale - 1.0, s.yaw_rate_bias_radps, s.yaw_rate_gain, s.slip_radps2pm,
      s.pitch_per_acceleration_radps2pm, s.stamp_s;
  for (int c = 0; c < shared::kConstants; ++c) {
    const double variance = dense.covariance(kConstants + c, kConstants + c);
    EXPECT_NEAR(constants(c), dense.step(kConstants + c), 1e-5 * std::sqrt(variance)) << c;
    EXPECT_NEAR(solver.shared_covariance()(c, c), variance, 1e-5 * variance) << c;
  }
  const int load = kConstants + shared::kLoad;
  EXPECT_NEAR(s.load_rad[0], dense.step(load), 1e-5 * std::sqrt(dense.covariance(load, load)));
  EXPECT_NEAR(solver.load_variance(0), dense.covariance(load, load), 1e-5 * dense.covariance(load, load));
}

TEST(Solver, EqualsOneDenseLeastSquaresSolution) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto p = problem(seed);
    const Dense dense = dense_solution(*p);
    p->solver.solve(p->segments, kNow_s);
    expect_dense(p->solver, dense);
    EXPECT_GT(dense.step.head(kRadars * own::kCount).norm(), 1e-2) << "otherwise nothing was solved";
  }
}

TEST(Solver, ARadarWithoutElevationKeepsItsPitchAndRoll) {
  const auto p = problem(4, false);
  const Dense dense = dense_solution(*p);
  p->solver.solve(p->segments, kNow_s);
  expect_dense(p->solver, dense);
  const Eigen::Vector3d turn = step_of(p->solver.radar(1), nominal(1)).segment<3>(own::kRotation);
  EXPECT_LT(turn.head<2>().norm(), 1e-6 * std::abs(turn.z()));
}

TEST(Solver, StepByStepEqualsAtOnceAndStepsAreLinearInRadars) {
  const auto a = problem(5), b = problem(5);
  a->solver.solve(a->segments, kNow_s);
  b->solver.begin(kNow_s);
  int steps = 0;
  do {
    EXPECT_TRUE(b->solver.busy());
    ++steps;
  } while (!b->solver.step(b->segments));
  EXPECT_FALSE(b->solver.busy());
  EXPECT_EQ(steps, 3 + 2 * kRadars);
  for (std::size_t r = 0; r < kRadars; ++r) {
    EXPECT_EQ(a->solver.radar(r).covariance, b->solver.radar(r).covariance);
    EXPECT_EQ(a->solver.radar(r).state.sensor_to_vehicle, b->solver.radar(r).state.sensor_to_vehicle);
  }
}

TEST(Solver, AnInterruptedSolutionChangesNothing) {
  const auto p = problem(6);
  const OwnMatrix before = p->solver.radar(0).covariance;
  p->solver.begin(kNow_s);
  for (int i = 0; i < 4; ++i) static_cast<void>(p->solver.step(p->segments));
  EXPECT_EQ(p->solver.radar(0).covariance, before);
  p->solver.stop();
  EXPECT_FALSE(p->solver.busy());
  EXPECT_EQ(p->solver.radar(0).covariance, before);
}

TEST(Solver, WithoutDataThePriorStays) {
  Solver empty(kRadars, priors());
  Segments none(kRadars);
  for (std::size_t r = 0; r < kRadars; ++r) empty.set_prior(r, nominal(static_cast<int>(r)), true, kKnotStep_rad);
  empty.solve(none, kNow_s);
  EXPECT_EQ(empty.radar(0).state.sensor_to_vehicle, nominal(0));
  // One radar sees nothing: the other's data move the vehicle's parameters only.
  const auto p = problem(7, true, false);
  p->solver.solve(p->segments, kNow_s);
  const RadarSolution& blind = p->solver.radar(1);
  EXPECT_LT(step_of(blind, nominal(1)).norm(), 1e-12);
  const Priors prior = priors();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(blind.covariance(own::kRotation + axis, own::kRotation + axis)), prior.rotation_std_rad,
                1e-9);
  }
  EXPECT_NEAR(std::sqrt(blind.covariance(own::kRateScale, own::kRateScale)), prior.rate_scale_std, 1e-9);
  EXPECT_NEAR(std::sqrt(blind.covariance(own::kStamp, own::kStamp)), prior.stamp_std_s, 1e-9);
  EXPECT_LT(std::sqrt(p->solver.shared_covariance()(0, 0)), 0.9 * prior.speed_scale_std);
}

TEST(Solver, APriorFromAnEarlierDriveActsAsItsCovarianceSays) {
  // Restoring what one half of the data gave, then solving the other half, equals solving both, where nothing is
  // shared.
  Priors alone = priors();
  alone.speed_scale_std = alone.yaw_rate_bias_std_radps = alone.yaw_rate_gain_std = alone.slip_std_radps2pm = 0.0;
  alone.pitch_per_acceleration_std_radps2pm = alone.common_stamp_std_s = alone.load_std_rad = alone.drift_std_radps =
      0.0;
  alone.own_std = alone.common_std = {0.0, 0.0, 0.0};
  const auto solved = [&](Solver& solver, const std::vector<Share>& shares) {
    Segments segments(1);
    for (const Share& share : shares) {
      segments.begin(0, solver.merge_noise());
      segments.segment(segments.size() - 1).seconds = 2.0;
      segments.share(segments.size() - 1, 0) = share;
    }
    solver.solve(segments, 0.0);
  };
  Solver both(1, alone), first(1, alone), second(1, alone);
  for (Solver* s : {&both, &first, &second}) s->set_prior(0, nominal(0), true, kKnotStep_rad);
  RandomShares shares(8);
  const Point point = both.point(0, 0.0, 0);
  const Share one = shares.next(point, 2.0), two = shares.next(point, 2.0);
  solved(both, {one, two});
  solved(first, {one});
  second.restore(0, first.radar(0).state, first.radar(0).covariance, first.radar(0).fluctuation);
  const OwnVector found = step_of(second.radar(0), nominal(0));
  EXPECT_EQ(found, step_of(first.radar(0), nominal(0)));
  solved(second, {two});
  const OwnVector stds = both.radar(0).covariance.diagonal().cwiseSqrt();
  for (int c = 0; c < own::kPitchDrift; ++c) {
    // A rotation vector of some degrees is not quite a sum.
    EXPECT_NEAR(step_of(second.radar(0), nominal(0))(c), step_of(both.radar(0), nominal(0))(c), 0.1 * stds(c)) << c;
    EXPECT_NEAR(second.radar(0).covariance(c, c), both.radar(0).covariance(c, c), 1e-3 * stds(c) * stds(c)) << c;
  }
}

TEST(Solver, ATurnedRadarForgetsItsRotationOnly) {
  const auto p = problem(9);
  p->solver.solve(p->segments, kNow_s);
  const RadarSolution before = p->solver.radar(0);
  p->solver.turn(0, {0.0, 0.02, -0.03});
  const RadarSolution& after = p->solver.radar(0);
  EXPECT_LT((geometry::so3_log(after.state.sensor_to_vehicle * before.state.sensor_to_vehicle.transpose()) -
             Eigen::Vector3d(0.0, 0.02, -0.03))
                .norm(),
            1e-9);
  EXPECT_NEAR(std::sqrt(after.covariance(own::kRotation + 2, own::kRotation + 2)), priors().turned_std_rad, 1e-9);
  EXPECT_EQ(after.covariance(own::kStamp, own::kStamp), before.covariance(own::kStamp, own::kStamp));
}

}  // namespace
}  // namespace boresight::alignment::windows
