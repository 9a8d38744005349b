// What segments keep when they are merged, moved and forgotten.
#include "services/alignment_estimator/core/windows/segment.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/windows/reduced.hpp"
#include "tests/unit/alignment_estimator/windows/shares.hpp"

namespace boresight::alignment::windows {
namespace {

/// Scaled by the priors, so that eigenvalues can be compared.
LocalMatrix scaled(const LocalMatrix& information) {
  const LocalVector stds = local_stds(Priors{});
  return stds.asDiagonal() * information * stds.asDiagonal();
}

double smallest_eigenvalue(const LocalMatrix& matrix) {
  return Eigen::SelfAdjointEigenSolver<LocalMatrix>(matrix).eigenvalues()(0);
}

MergeNoise noise_of(double own, double common) {
  MergeNoise noise;
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    noise.common.variance[k] = common * common;
    for (Fluctuation& radar : noise.own) radar.variance[k] = own * own;
  }
  return noise;
}

/// Drives so many segments of two blocks each with two radars; returns the information of radar 0 that went in.
LocalMatrix fill(Segments& segments, int count, const MergeNoise& noise, unsigned seed, int load_from = 1'000'000) {
  RandomShares shares(seed);
  const Point point = some_point();
  LocalMatrix sum = LocalMatrix::Zero();
  for (int i = 0; i < count; ++i) {
    segments.begin(i >= load_from ? 1 : 0, noise);
    for (int block = 0; block < 2; ++block) {
      for (std::size_t r = 0; r < 2; ++r) {
        const Block b = shares.block(point);
        if (r == 0) sum += b.information;
        segments.add(r, b, 2.0, noise);
      }
    }
    Segment& latest = segments.segment(segments.size() - 1);
    latest.seconds = 2.0;
    latest.middle_s = 2.0 * i + 1.0;
  }
  return sum;
}

LocalMatrix sum_of(const Segments& segments) {
  LocalMatrix sum = LocalMatrix::Zero();
  for (int i = 0; i < segments.size(); ++i) sum += segments.share(i, 0).information;
  return sum;
}

TEST(Segments, WithoutFluctuationsMergingKeepsAllInformation) {
  Segments segments(2);
  const LocalMatrix in = fill(segments, 300, noise_of(0.0, 0.0), 1);
  EXPECT_LE(segments.size(), kMaxSegments);
  EXPECT_LT(scaled(sum_of(segments) - in).norm(), 1e-9 * scaled(in).norm());
  double seconds = 0.0, of_radar_s = 0.0;
  for (int i = 0; i < segments.size(); ++i) {
    seconds += segments.segment(i).seconds;
    of_radar_s += segments.share(i, 1).seconds;
    if (i > 0) {
      EXPECT_GT(segments.segment(i).middle_s, segments.segment(i - 1).middle_s);
      EXPECT_LE(segments.segment(i).level, segments.segment(i - 1).level) << "the older, the longer";
    }
  }
  EXPECT_NEAR(seconds, 600.0, 1e-9);
  EXPECT_NEAR(of_radar_s, 600.0, 1e-9);
  EXPECT_GT(segments.segment(0).level, 2);
  EXPECT_EQ(segments.segment(segments.size() - 1).level, 0);
}

TEST(Segments, MergingNeverAddsInformation) {
  Segments segments(2);
  const LocalMatrix in = fill(segments, 200, noise_of(3e-3, 2e-3), 2);
  const LocalMatrix kept = sum_of(segments);
  EXPECT_GT(smallest_eigenvalue(scaled(in - kept)), -1e-7 * scaled(in).norm());
  EXPECT_GT(smallest_eigenvalue(scaled(kept)), 0.0);
  // Parameters without fluctuations, with all others known, are as well known as before.
  for (const int c : {static_cast<int>(local::kSlip), static_cast<int>(local::kStamp), local::kCurve + 4}) {
    EXPECT_GT(kept(c, c), 0.2 * in(c, c)) << c;
  }
}

TEST(Segments, SegmentsBeforeALoadStepForgetTheirPitchWhenTheyAreMergedWithLaterOnes) {
  Segments segments(2);
  const MergeNoise none = noise_of(0.0, 0.0);
  const LocalMatrix in = fill(segments, 300, none, 3, 280);
  const int pitch = local::kRotation + 1;
  for (int i = 0; i + 1 < segments.size(); ++i) {
    EXPECT_LE(segments.segment(i).load, segments.segment(i + 1).load);
  }
  EXPECT_LE(sum_of(segments)(pitch, pitch), in(pitch, pitch));
  segments.forget_first_load();
  for (int i = 0; i < segments.size(); ++i) {
    EXPECT_EQ(segments.segment(i).load, 0);
    if (segments.segment(i).middle_s < 500.0) {
      EXPECT_EQ(segments.share(i, 0).information(pitch, pitch), 0.0);
    }
  }
}

TEST(Segments, ForgettingEqualsMarginalisation) {
  RandomShares shares(4);
  for (const auto& [first, count] : {std::pair{static_cast<int>(local::kRotation), 3},
                                     {local::kRotation + 1, 1},
                                     {static_cast<int>(local::kSpeedScale), 1}}) {
    Share share = shares.next(some_point(), 2.0);
    const LocalMatrix covariance = share.information.inverse();
    const LocalVector best = covariance * share.score;
    forget(share, first, count);
    std::vector<int> rest;
    for (int c = 0; c < local::kCount; ++c) {
      if (c < first || c >= first + count) {
        rest.push_back(c);
        continue;
      }
      EXPECT_EQ(share.information.row(c).norm() + share.information.col(c).norm() + std::abs(share.score(c)), 0.0);
    }
    // Marginal covariance and mean of the others are what they were.
    const Eigen::MatrixXd of_rest = share.information(rest, rest);
    const Eigen::MatrixXd expected = covariance(rest, rest);
    const Eigen::VectorXd stds = expected.diagonal().cwiseSqrt();
    const Eigen::MatrixXd off =
        stds.cwiseInverse().asDiagonal() * (of_rest.inverse() - expected) * stds.cwiseInverse().asDiagonal();
    EXPECT_LT(off.norm(), 1e-7);
    const Eigen::VectorXd mean = of_rest.ldlt().solve(Eigen::VectorXd(share.score(rest)));
    EXPECT_LT((mean - best(rest)).cwiseQuotient(stds).norm(), 1e-6);
  }
}

TEST(Segments, ASumAtAnotherPointHasTheSameMaximum) {
  RandomShares shares(5);
  LocalVector step = LocalVector::Zero();
  step << 0.01, 0.001, 0.0, 0.0, 0.02, LocalVector::Zero().tail<local::kCount - 5>();  // a turn about one axis
  const Point a = some_point(), b = moved(a, step);
  const Share one = shares.next(a, 1.0), two = shares.next(b, 2.0);
  Share sum;
  add_to(sum, one.point, one.score, one.information, one.seconds);
  add_to(sum, two.point, two.score, two.information, two.seconds);
  EXPECT_EQ(sum.seconds, 3.0);
  // log likelihood of d from a: s₁·d − ½dL₁d + s₂·(d − step) − ½(d − step)L₂(d − step).
  const LocalVector expected =
      (one.information + two.information).ldlt().solve(one.score + two.score + two.information * step);
  const LocalVector found = sum.information.ldlt().solve(sum.score);
  EXPECT_LT((found - expected).cwiseQuotient(local_stds(Priors{})).norm(), 1e-9);
}

TEST(Segments, DroppedTimeIsThatOfOneRadar) {
  Segments segments(2);
  fill(segments, 20, noise_of(1e-3, 1e-3), 6);
  segments.drop_latest(1, 5.0);
  for (int i = 0; i < segments.size(); ++i) {
    EXPECT_EQ(segments.share(i, 1).seconds > 0.0, i < 17) << i;
    EXPECT_GT(segments.share(i, 0).seconds, 0.0);
  }
}

TEST(Reduced, EliminatingAFluctuationEqualsTheDenseInverse) {
  RandomShares shares(7);
  const Share share = shares.next(some_point(), 2.0);
  const std::array<double, kFluctuations> variances{1e-6, 4e-6, 0.0};
  const Reduced reduced = reduce(share, share.point, variances);
  constexpr int kAll = local::kCount + kFluctuations;
  Eigen::Matrix<double, local::kCount, kAll> act = Eigen::Matrix<double, local::kCount, kAll>::Zero();
  act.leftCols<local::kCount>().setIdentity();
  for (int k = 0; k < kFluctuations; ++k) {
    act(kFluctuating[static_cast<std::size_t>(k)], local::kCount + k) = 1.0;
  }
  Eigen::MatrixXd all = act.transpose() * share.information * act;
  const Eigen::VectorXd score = act.transpose() * share.score;
  for (int k = 0; k < kFluctuations; ++k) {
    const double variance = variances[static_cast<std::size_t>(k)];
    all(local::kCount + k, local::kCount + k) += variance > 0.0 ? 1.0 / variance : 1e18;
  }
  const Eigen::MatrixXd cross = all.topRightCorner(local::kCount, kFluctuations);
  const Eigen::MatrixXd own = all.bottomRightCorner(kFluctuations, kFluctuations);
  const LocalMatrix expected =
      all.topLeftCorner(local::kCount, local::kCount) - cross * own.inverse() * cross.transpose();
  const LocalVector expected_score = score.head(local::kCount) - cross * own.inverse() * score.tail(kFluctuations);
  EXPECT_LT(scaled(reduced.information - expected).norm(), 1e-9 * scaled(expected).norm());
  EXPECT_LT((reduced.score - expected_score).cwiseProduct(local_stds(Priors{})).norm(), 1e-6);
}

TEST(Reduced, DirectionsThatAShareKnowsLessThanNothingOfAreDropped) {
  RandomShares shares(8);
  Share share = shares.next(some_point(), 2.0);
  const LocalVector stds = local_stds(Priors{});
  LocalVector direction = LocalVector::Zero();
  direction(local::kRotation) = 1.0;
  const LocalVector bad = stds.cwiseInverse().cwiseProduct(direction);
  share.information -= 500.0 * bad * bad.transpose();
  ASSERT_LT(smallest_eigenvalue(scaled(share.information)), 0.0);
  make_positive(share, stds);
  EXPECT_GT(smallest_eigenvalue(scaled(share.information)), -1e-9);
  EXPECT_TRUE(share.positive);
  const LocalMatrix once = share.information;
  make_positive(share, stds);
  EXPECT_LT(scaled(share.information - once).norm(), 1e-7 * scaled(once).norm());
}

TEST(Reduced, MeanOfACorrelatedProcess) {
  EXPECT_NEAR(share_of_mean(1e-3, 10.0), 1.0, 1e-3);            // constant over the time
  EXPECT_NEAR(share_of_mean(1000.0, 1.0), 2.0 / 1000.0, 3e-6);  // many independent parts
  EXPECT_GT(share_of_mean(5.0, 10.0), share_of_mean(10.0, 10.0));
}

}  // namespace
}  // namespace boresight::alignment::windows
