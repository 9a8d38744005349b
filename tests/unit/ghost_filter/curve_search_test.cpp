// Lines and arcs among points, and their least-squares fit, against references that share no code with them.
#include "services/ghost_filter/core/reflector_map/curve_search.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/ghost_filter/core/reflector_map/curve_fit.hpp"

namespace boresight::ghosts {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kNoise_m = 0.08;

/// Points of a curve that begins at the origin in the direction `heading`, with noise across it.
Points on_curve(double curvature_per_m, double heading_rad, double length_m, std::size_t count, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, kNoise_m);
  std::uniform_real_distribution<double> along(0.0, length_m);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = along(random), turn = curvature_per_m * s;
    // By the circle's centre rather than by the product's Curve.
    const Eigen::Vector2d p = curvature_per_m == 0.0
                                  ? Eigen::Vector2d(s, 0.0)
                                  : Eigen::Vector2d(std::sin(turn), 1.0 - std::cos(turn)) / curvature_per_m;
    const Eigen::Vector2d q = p + noise(random) * Eigen::Vector2d(-std::sin(turn), std::cos(turn));
    points.emplace_back(std::cos(heading_rad) * q.x() - std::sin(heading_rad) * q.y(),
                        std::sin(heading_rad) * q.x() + std::cos(heading_rad) * q.y());
  }
  return points;
}

/// Orthogonal regression by the scatter matrix: the smallest eigenvector is the line's normal.
struct Line {
  explicit Line(const Points& points) {
    middle.setZero();
    for (const Eigen::Vector2d& p : points) middle += p / static_cast<double>(points.size());
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector2d& p : points) scatter += (p - middle) * (p - middle).transpose();
    normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvectors().col(0);
  }
  Eigen::Vector2d middle, normal;
};

double mean_square(const Points& points, const Eigen::Vector2d& centre, double radius) {
  double sum = 0.0;
  for (const Eigen::Vector2d& p : points) sum += std::pow((p - centre).norm() - radius, 2);
  return sum / static_cast<double>(points.size());
}

TEST(CurveFit, IsOrthogonalRegressionOnALine) {
  std::mt19937 random(1);
  for (int run = 0; run < 50; ++run) {
    const Points points = on_curve(0.0, 0.13 * run, 30.0, 40, random);
    const Line line(points);
    // Held straight by what is known before; from a start that is off. Gauss–Newton needs a few rounds.
    Curve curve{{std::cos(0.13 * run + 0.02) * 15.0, std::sin(0.13 * run + 0.02) * 15.0},
                {std::cos(0.13 * run + 0.03), std::sin(0.13 * run + 0.03)},
                0.0};
    for (int round = 0; round < 6; ++round) {
      CurveFit fit(curve, Eigen::Vector3d(1e-12, 1e-12, 1e14).asDiagonal());
      for (const Eigen::Vector2d& p : points) fit.add(p, kNoise_m * kNoise_m);
      curve = fit.solve();
    }
    EXPECT_NEAR(std::abs(line.normal.dot(curve.tangent)), 0.0, 1e-6) << "run " << run;
    EXPECT_NEAR(line.normal.dot(curve.origin_m - line.middle), 0.0, 1e-6) << "run " << run;
  }
}

TEST(CurveFit, NoCircleNearbyFitsBetter) {
  std::mt19937 random(2);
  for (int run = 0; run < 20; ++run) {
    const double curvature = 0.005 + 0.002 * run;
    const Points points = on_curve(curvature, 0.4 * run, 25.0, 60, random);
    Curve curve{points.front(), {std::cos(0.4 * run), std::sin(0.4 * run)}, 0.8 * curvature};
    for (int round = 0; round < 12; ++round) {
      CurveFit fit(curve, Eigen::Vector3d(1e-12, 1e-12, 1e-12).asDiagonal());
      for (const Eigen::Vector2d& p : points) fit.add(p, kNoise_m * kNoise_m);
      curve = fit.solve();
    }
    const double radius = 1.0 / curve.curvature_per_m;
    const Eigen::Vector2d centre = curve.origin_m + radius * curve.normal();
    const double least = mean_square(points, centre, radius);
    // Whatever step is taken in the circle's three parameters, the sum of squares does not fall by more than what the
    // fit's linearisation leaves out.
    for (const double step : {1e-3, 1e-2, 0.1}) {
      for (const Eigen::Vector3d& d : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1),
                                       Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(0, 1, 1), Eigen::Vector3d(1, 1, 0)}) {
        for (const double sign : {-step, step}) {
          EXPECT_GE(mean_square(points, centre + sign * d.head<2>(), radius + sign * d.z()), least - 1e-6)
              << "run " << run << " step " << step;
        }
      }
    }
  }
}

TEST(CurveFit, CovarianceIsHonest) {
  std::mt19937 random(3);
  constexpr int kRuns = 500;
  for (const double curvature : {0.0, 0.02}) {
    double nees = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      const Points points = on_curve(curvature, 0.0, 30.0, 50, random);
      const Curve truth{{0.0, 0.0}, {1.0, 0.0}, curvature};
      const Curve at_middle = truth.moved(15.0);
      Curve fitted = at_middle;
      CurveFit fit(fitted, Eigen::Vector3d(1e-9, 1e-9, 1e-9).asDiagonal());
      for (const Eigen::Vector2d& p : points) fit.add(p, kNoise_m * kNoise_m);
      fitted = fit.solve();
      const Eigen::Vector2d shift = fitted.origin_m - at_middle.origin_m;
      const double turn = at_middle.tangent.x() * fitted.tangent.y() - at_middle.tangent.y() * fitted.tangent.x();
      const Eigen::Vector3d error(shift.dot(at_middle.normal()), turn, fitted.curvature_per_m - curvature);
      nees += error.dot(fit.covariance().inverse() * error) / kRuns;
    }
    // χ² of 3 degrees of freedom, mean of 500: 3 ± 3.3·√(6/500).
    EXPECT_NEAR(nees, 3.0, 0.36) << "curvature " << curvature;
  }
}

TEST(CurveFit, EvidenceIsTheSameAsAddingPoints) {
  std::mt19937 random(4);
  const Points points = on_curve(0.01, 0.5, 20.0, 30, random);
  const Curve curve{{0.0, 0.0}, {std::cos(0.5), std::sin(0.5)}, 0.0};
  const Eigen::Matrix3d known = Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal();
  CurveFit one_by_one(curve, known), at_once(curve, known);
  Evidence evidence;
  for (const Eigen::Vector2d& p : points) {
    one_by_one.add(p, 0.02);
    const Eigen::Vector2d q = curve.local(p);
    evidence.add_local(q, curve.distance_of_local(q), 0.02);
  }
  at_once.add(evidence);
  EXPECT_EQ(evidence.points, points.size());
  EXPECT_TRUE(one_by_one.covariance().isApprox(at_once.covariance(), 1e-12));
  EXPECT_TRUE(one_by_one.solve().origin_m.isApprox(at_once.solve().origin_m, 1e-12));
}

TEST(CurveFit, CovarianceMovesAsTheCurveDoes) {
  // A shift at the new origin is what shift, turn and curvature at the old one make there.
  const Eigen::Vector3d change(0.3, 0.002, 1e-4);
  const Eigen::Matrix3d moved = moved_covariance(change * change.transpose(), 20.0);
  const Curve straight{{0.0, 0.0}, {1.0, 0.0}, 0.0};
  const Curve changed = straight.changed(change);
  EXPECT_NEAR(std::sqrt(moved(0, 0)), changed.at(20.0).y(), 1e-4);
  EXPECT_NEAR(std::sqrt(moved(1, 1)), std::asin(changed.tangent_at(20.0).y()), 1e-5);
}

struct Case {
  const char* name;
  double curvature_per_m, length_m;
};

class Finds : public testing::TestWithParam<Case> {};

TEST_P(Finds, TheCurveAmongWhatLiesAbout) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-20.0, 20.0);
  const Case& c = GetParam();
  int found = 0;
  constexpr int kRuns = 40;
  for (int run = 0; run < kRuns; ++run) {
    // Turned and shifted at will: nothing depends on where it lies.
    const double heading = 0.157 * run;
    const Eigen::Vector2d shift(37.0 * run, -11.0 * run);
    CurveSearch search(MapConfig{});
    Points points = on_curve(c.curvature_per_m, heading, c.length_m, 40, random);
    const Points truth = points;
    const Eigen::Vector2d middle = 0.5 * c.length_m * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    for (int i = 0; i < 20; ++i) points.push_back(middle + Eigen::Vector2d(anywhere(random), anywhere(random)));
    for (Eigen::Vector2d& p : points) p += shift;
    std::size_t taken = 0;
    const std::optional<FoundCurve> curve = search.find(points, taken);
    if (!curve) continue;
    ++found;
    EXPECT_GE(taken, 36U) << "run " << run;
    double square = 0.0;
    for (const Eigen::Vector2d& p : truth) square += std::pow(curve->curve.distance(p + shift), 2);
    EXPECT_LT(std::sqrt(square / static_cast<double>(truth.size())), 2.0 * kNoise_m) << "run " << run;
    EXPECT_NEAR(std::abs(curve->curve.curvature_per_m), std::abs(c.curvature_per_m), 0.02) << "run " << run;
    EXPECT_GT(curve->end_m - curve->begin_m, 0.75 * c.length_m);
    // The points it took are the ones at the end.
    for (std::size_t i = points.size() - taken; i < points.size(); ++i) {
      EXPECT_LT(std::abs(curve->curve.distance(points[i])), MapConfig{}.tolerance_m);
    }
  }
  EXPECT_GE(found, kRuns * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(CurveSearch, Finds,
                         testing::Values(Case{"straight", 0.0, 20.0}, Case{"bend", 0.02, 20.0},
                                         Case{"tight_right", -0.045, 18.0}, Case{"short", 0.0, 8.0}),
                         [](const auto& info) { return info.param.name; });

TEST(CurveSearch, FindsNothingInWhatIsNoCurve) {
  std::mt19937 random(6);
  std::normal_distribution<double> leaf(0.0, 1.5);
  CurveSearch search(MapConfig{});
  int found = 0;
  for (int run = 0; run < 100; ++run) {
    Points bush;
    for (int i = 0; i < 60; ++i) bush.emplace_back(leaf(random), leaf(random));
    std::size_t taken = 0;
    found += search.find(bush, taken).has_value() ? 1 : 0;
  }
  EXPECT_LE(found, 2) << "lines through a bush are few among what lies beside them";
}

TEST(CurveSearch, SurvivesDegenerateInput) {
  CurveSearch search(MapConfig{});
  std::size_t taken = 7;
  Points few = {{0.0, 0.0}, {1.0, 0.0}};
  EXPECT_FALSE(search.find(few, taken).has_value());
  EXPECT_EQ(taken, 0U);
  Points nothing;
  EXPECT_FALSE(search.find(nothing, taken).has_value());
  Points same(50, Eigen::Vector2d(3.0, 4.0));
  EXPECT_FALSE(search.find(same, taken).has_value()) << "no direction";
  Points twice;
  for (int i = 0; i < 20; ++i) twice.insert(twice.end(), 2, Eigen::Vector2d(0.5 * i, 0.0));
  const std::optional<FoundCurve> line = search.find(twice, taken);
  ASSERT_TRUE(line.has_value()) << "points on top of each other are a line as well";
  EXPECT_NEAR(line->curve.tangent.y(), 0.0, 1e-9);
  EXPECT_TRUE(line->covariance.allFinite());
  EXPECT_GT(line->covariance.diagonal().minCoeff(), 0.0);
}

TEST(CurveSearch, StopsAtAGap) {
  CurveSearch search(MapConfig{});
  Points points;
  for (int i = 0; i < 20; ++i) points.emplace_back(0.5 * i, 0.0);
  for (int i = 0; i < 12; ++i) points.emplace_back(0.5 * i + 25.0, 0.0);
  std::size_t taken = 0;
  const std::optional<FoundCurve> line = search.find(points, taken);
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(line->end_m - line->begin_m, 9.5, 0.1) << "the longer stretch; the other is another reflector";
  EXPECT_EQ(taken, 20U);
}

TEST(CurveSearch, LooksAtSoManyPointsAtMostAndAllocatesNothing) {
  CurveSearch search(MapConfig{});
  Points points;
  for (int i = 0; i < 5000; ++i) points.emplace_back(0.01 * i, 0.0);
  const std::uint64_t before = runtime::counted_allocations();
  std::size_t taken = 0;
  {
    const runtime::CountAllocations counting;
    static_cast<void>(search.find(points, taken));
  }
  EXPECT_LE(taken, CurveSearch::kMaxPoints);
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::ghosts
