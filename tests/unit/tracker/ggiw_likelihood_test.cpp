// The likelihood of a cell against formulas, integrals by sampling and by quadrature, and a stacked Gaussian.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/prediction.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

using support::Detections;
using support::Reference;

struct LikelihoodCase {
  Reference object;
  View<double> view;
  Detections z;
};
LikelihoodCase random_likelihood_case(support::Random& random, bool has_range_rates, std::size_t n) {
  LikelihoodCase c{support::random_object(random), support::random_view(random, has_range_rates), {}};
  const Eigen::LLT<Eigen::Matrix4d> root(c.object.covariance);
  Eigen::Vector4d deviation;
  for (double& d : deviation) d = support::normal(random);
  const Eigen::Vector4d truth = c.object.mean + root.matrixL() * deviation;
  c.z = support::draw_detections(random, truth, c.object.extent(), c.view, n, -4.0);
  return c;
}
double log_likelihood_of(const LikelihoodCase& c) {
  Prediction<double> p(support::component_of(c.object), c.view);
  return p.log_likelihood(support::cell_of(c.z));
}

/// ∫ Gamma(γ; α, β) f(γ) dγ by the midpoint rule in log γ.
template <typename Function>
double gamma_integral(const Reference& r, const Function& f) {
  constexpr int kSteps = 20'000;
  const double mean = r.rate_shape / r.rate_inverse_scale, from = std::log(mean) - 12.0, to = std::log(mean) + 4.0;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double log_rate = from + (to - from) * (i + 0.5) / kSteps, rate = std::exp(log_rate);
    const double log_density = r.rate_shape * std::log(r.rate_inverse_scale) - std::lgamma(r.rate_shape) +
                               r.rate_shape * log_rate - r.rate_inverse_scale * rate;
    sum += std::exp(log_density) * f(rate) * (to - from) / kSteps;
  }
  return sum;
}

TEST(CellLikelihood, EqualsThePublishedFormula) {
  support::Random random(1);
  for (int run = 0; run < 400; ++run) {
    const auto n = static_cast<std::size_t>(1 + run % 20);
    LikelihoodCase c = random_likelihood_case(random, run % 2 == 0, n);
    c.view.turn_mps = {support::uniform(random, -2.0, 2.0), support::uniform(random, -2.0, 2.0)};
    const double expected =
        support::log_likelihood_reference(support::reference_of(support::component_of(c.object)), c.view, c.z);
    EXPECT_NEAR(log_likelihood_of(c), expected, 1e-8 * (1.0 + std::abs(expected))) << n << " detections";
  }
}

TEST(CellLikelihood, EqualsThePublishedFormulaForHundredsOfDetections) {
  support::Random random(2);
  for (const std::size_t n : {61U, 62U, 63U, 64U, 65U, 80U, 128U, 256U}) {
    for (int run = 0; run < 5; ++run) {
      const LikelihoodCase c = random_likelihood_case(random, run % 2 == 0, n);
      const double expected = support::log_likelihood_reference(c.object, c.view, c.z);
      EXPECT_NEAR(log_likelihood_of(c), expected, 1e-8 * (1.0 + std::abs(expected))) << n << " detections";
    }
  }
}

/// X of an inverse Wishart of Granström's v and V: Wishart with v − 3 degrees of freedom inverted (Bartlett's method).
Eigen::Matrix2d draw_extent(support::Random& random, double dof, const Eigen::Matrix2d& scale) {
  const Eigen::Matrix2d root = scale.inverse().llt().matrixL();
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  a(0, 0) = std::sqrt(std::chi_squared_distribution<double>(dof - 3.0)(random));
  a(1, 1) = std::sqrt(std::chi_squared_distribution<double>(dof - 4.0)(random));
  a(1, 0) = support::normal(random);
  const Eigen::Matrix2d half = root * a;
  return (half * half.transpose()).inverse();
}

/// log of the density of the positions by random places and extents, with P_D and the number of detections by
/// quadrature. `standard_error`: of the result.
double sampled_log_likelihood(support::Random& random, const LikelihoodCase& c, int samples, double& standard_error) {
  const Eigen::Matrix2d place_root = c.object.covariance.topLeftCorner<2, 2>().llt().matrixL();
  const support::Sums s = support::sums_of(c.z);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double x = support::normal(random), y = support::normal(random);
    const Eigen::Vector2d place = c.object.mean.head<2>() + place_root * Eigen::Vector2d(x, y);
    const Eigen::Matrix2d r =
        c.view.spread * draw_extent(random, c.object.dof, c.object.scale) + support::eigen(c.view.noise_m2);
    const Eigen::Matrix2d information = r.inverse();
    const Eigen::Vector2d e = s.mean - place;
    const double p = std::exp(-s.n * std::log(2.0 * std::numbers::pi) - 0.5 * s.n * std::log(r.determinant()) -
                              0.5 * (information * (s.scatter + s.n * e * e.transpose())).trace());
    sum += p;
    squares += p * p;
  }
  const double mean = sum / samples;
  standard_error = std::sqrt((squares / samples - mean * mean) / samples) / mean;
  const double count = gamma_integral(
      c.object, [&](double rate) { return std::exp(-rate * c.view.exposure) * std::pow(rate * c.view.exposure, s.n); });
  double log_p = std::log(c.view.detection_probability) + std::log(mean) + std::log(count);
  for (const auto& z : c.z) log_p -= z.log_clutter;
  return log_p;
}

LikelihoodCase small_case() {
  LikelihoodCase c;
  c.object.mean << 10.0, 2.0, 5.0, 0.0;
  c.object.rate_shape = 6.0;
  c.object.rate_inverse_scale = 2.0;
  c.object.dof = 14.0;
  c.object.scale =
      8.0 * support::rotation(0.4) * Eigen::Vector2d(4.0, 1.0).asDiagonal() * support::rotation(0.4).transpose();
  c.view.detection_probability = 0.8;
  c.view.exposure = 1.3;
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(10.5, 2.1), Eigen::Vector2d(9.4, 1.2), Eigen::Vector2d(10.9, 2.4)}) {
    c.z.push_back(support::detection_at(at, {0.0, 0.0}, 0.0, -3.0));
  }
  return c;
}

TEST(CellLikelihood, OfAKnownPlaceIsTheIntegralOverExtentAndRate) {
  // With the place known and no measurement noise, the published formula makes no approximation.
  support::Random random(3);
  for (const double spread : {0.25, 1.0}) {
    LikelihoodCase c = small_case();
    c.object.covariance = 1e-12 * Eigen::Matrix4d::Identity();
    c.view.spread = spread;
    double standard_error = 0.0;
    const double expected = sampled_log_likelihood(random, c, 200'000, standard_error);
    EXPECT_LT(standard_error, 0.01);
    EXPECT_NEAR(log_likelihood_of(c), expected, 4.0 * standard_error) << spread;
  }
}

TEST(CellLikelihood, OfAnUncertainPlaceIsCloseToTheIntegralOverPlaceExtentAndRate) {
  // The approximations of the formula: E[X] in S = P + R/n, X^½ S^−½, and X^½ R^−½ where noise is added.
  support::Random random(4);
  for (const double place_variance : {0.05, 0.3, 1.0}) {
    LikelihoodCase c = small_case();
    c.object.covariance = place_variance * Eigen::Matrix4d::Identity();
    c.view.noise_m2 = {0.05, 0.01, 0.08};
    double standard_error = 0.0;
    const double expected = sampled_log_likelihood(random, c, 200'000, standard_error);
    EXPECT_LT(standard_error, 0.01);
    EXPECT_NEAR(log_likelihood_of(c), expected, 0.35) << place_variance;
  }
}

TEST(CellLikelihood, OfAKnownExtentIsTheStackedGaussianOfPositionsAndRangeRates) {
  support::Random random(5);
  for (int run = 0; run < 60; ++run) {
    const std::size_t n = 1 + static_cast<std::size_t>(run % 6);
    LikelihoodCase c = random_likelihood_case(random, run % 3 != 0, n);
    const Eigen::Matrix2d extent = c.object.extent();
    c.object.dof = 1e7;
    c.object.scale = (c.object.dof - 6.0) * extent;
    const bool has_rates = c.view.range_rate_variance > 0.0;
    const auto size = static_cast<Eigen::Index>((has_rates ? 3 : 2) * n), first_rate = static_cast<Eigen::Index>(2 * n);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, 4), noise = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd value(size);
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(n); ++i) {
      const Measurement<double>& z = c.z[static_cast<std::size_t>(i)];
      h.block<2, 2>(2 * i, 0).setIdentity();
      noise.block<2, 2>(2 * i, 2 * i) = c.view.spread * extent + support::eigen(c.view.noise_m2);
      value.segment<2>(2 * i) = support::eigen(z.position_m);
      if (!has_rates) continue;
      h.block<1, 2>(first_rate + i, 2) = support::eigen(z.sight).transpose();
      noise(first_rate + i, first_rate + i) = c.view.range_rate_variance;
      value(first_rate + i) = z.range_rate_mps;
    }
    double expected = support::log_gaussian(value - h * c.object.mean, h * c.object.covariance * h.transpose() + noise);
    expected += std::log(c.view.detection_probability) +
                support::log_count_reference(c.object, c.view.exposure, static_cast<double>(n));
    for (const auto& z : c.z) expected -= z.log_clutter;
    EXPECT_NEAR(log_likelihood_of(c), expected, 1e-4) << n << " detections, range rates: " << has_rates;
  }
}

TEST(CellLikelihood, IsTheSameInRotatedAxes) {
  support::Random random(6);
  for (int run = 0; run < 100; ++run) {
    const LikelihoodCase c = random_likelihood_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run % 9));
    const double angle = support::uniform(random, -3.0, 3.0);
    const LikelihoodCase turned{support::rotated(c.object, angle), support::rotated(c.view, angle),
                                support::rotated(c.z, angle)};
    EXPECT_NEAR(log_likelihood_of(turned), log_likelihood_of(c), 1e-9 * (1.0 + std::abs(log_likelihood_of(c))));
  }
}

TEST(CellLikelihood, IsTheSameInDisplacedAxes) {
  support::Random random(7);
  for (int run = 0; run < 100; ++run) {
    LikelihoodCase c = random_likelihood_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run % 9));
    const double before = log_likelihood_of(c);
    const Eigen::Vector2d shift(support::uniform(random, -500.0, 500.0), support::uniform(random, -500.0, 500.0));
    c.object.mean.head<2>() += shift;
    for (auto& z : c.z) z.position_m = z.position_m + support::vector_of(shift);  // lines of sight stay
    EXPECT_NEAR(log_likelihood_of(c), before, 1e-7 * (1.0 + std::abs(before)));
  }
}

TEST(CellLikelihood, OfSharedMeasurementsJoinsThatOfWholeOnes) {
  support::Random random(8);
  for (int run = 0; run < 50; ++run) {
    const LikelihoodCase c = random_likelihood_case(random, run % 2 == 0, 4);
    Prediction<double> p(support::component_of(c.object), c.view);
    const auto with_share = [&](double share) {
      Cell<double> cell = support::cell_of(std::span(c.z).first(3));
      cell.add(c.z[3], share);
      return p.log_likelihood(cell);
    };
    constexpr double kSmall = 1e-7;
    const double three = p.log_likelihood(support::cell_of(std::span(c.z).first(3)));
    const double four = p.log_likelihood(support::cell_of(c.z));
    EXPECT_NEAR(with_share(kSmall), three, 1e-4);
    EXPECT_NEAR(with_share(1.0 - kSmall), four, 1e-4);
    // No jump in between.
    double before = three;
    for (double share = 0.01; share < 1.0; share += 0.01) {
      EXPECT_LT(std::abs(with_share(share) - before), 0.2 + 0.05 * std::abs(four - three));
      before = with_share(share);
    }
  }
}

TEST(CellLikelihood, FallsByTheClutterDensityOfEachMeasurement) {
  support::Random random(9);
  LikelihoodCase c = random_likelihood_case(random, true, 5);
  const double before = log_likelihood_of(c);
  c.z[0].log_clutter += 1.5;
  c.z[3].log_clutter -= 0.25;
  EXPECT_NEAR(log_likelihood_of(c), before - 1.25, 1e-9);
}

TEST(MissedDetection, ProbabilityIncludesDetectionWithoutAPoint) {
  support::Random random(10);
  for (int run = 0; run < 20; ++run) {
    const LikelihoodCase c = random_likelihood_case(random, false, 1);
    const Prediction<double> p(support::component_of(c.object), c.view);
    const double no_point = gamma_integral(c.object, [&](double rate) { return std::exp(-rate * c.view.exposure); });
    EXPECT_NEAR(p.missed(), 1.0 - c.view.detection_probability * (1.0 - no_point), 1e-7);
  }
}

TEST(MissedDetection, ProbabilityAndThoseOfAllCountsAddUpToOne) {
  // Σ_n P(n) with P(n) = ∫ p(cell of n) d(cell) / n!: what log_source_ratio() divides by, so from there.
  support::Random random(11);
  for (int run = 0; run < 20; ++run) {
    const LikelihoodCase c = random_likelihood_case(random, false, 1);
    Prediction<double> p(support::component_of(c.object), c.view);
    const double more = c.view.source_more,
                 none = std::exp(support::log_count_reference(c.object, c.view.exposure, 0.0));
    double sum = none;
    for (int n = 1; n < 400; ++n) {
      const double log_geometric = std::log(1.0 - more) + (n - 1) * std::log(more);
      sum += std::exp(log_geometric - p.log_source_ratio(n)) * (1.0 - none);
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
}

TEST(Intensity, OfOneMeasurementIsTheExpectedNumberTimesItsDensityOverClutter) {
  support::Random random(12);
  for (int run = 0; run < 100; ++run) {
    const LikelihoodCase c = random_likelihood_case(random, run % 2 == 0, 1);
    const Prediction<double> p(support::component_of(c.object), c.view);
    const Eigen::Vector2d u = support::eigen(c.z[0].sight),
                          e = support::eigen(c.z[0].position_m) - c.object.mean.head<2>();
    const Eigen::Matrix2d s =
        c.object.covariance.topLeftCorner<2, 2>() + c.view.spread * c.object.extent() + support::eigen(c.view.noise_m2);
    double expected = std::log(c.view.exposure * c.object.rate_shape / c.object.rate_inverse_scale) +
                      support::log_gaussian(e, s) - c.z[0].log_clutter;
    EXPECT_NEAR(p.place_distance(c.z[0].position_m), e.dot(s.inverse() * e), 1e-9);
    if (c.view.range_rate_variance > 0.0) {
      const double error = c.z[0].range_rate_mps - u.dot(c.object.mean.tail<2>());
      const double variance = c.view.range_rate_variance + u.dot(c.object.covariance.bottomRightCorner<2, 2>() * u);
      expected -= 0.5 * (std::log(2.0 * std::numbers::pi * variance) + error * error / variance);
      EXPECT_NEAR(p.range_rate_distance(c.z[0]), error * error / variance, 1e-9);
    } else {
      EXPECT_EQ(p.range_rate_distance(c.z[0]), 0.0);
    }
    EXPECT_NEAR(p.log_intensity(c.z[0]), expected, 1e-9);
  }
}

TEST(CellLikelihood, OfAPossibleClutterSourceIsThatOfAMixtureOfSources) {
  support::Random random(13);
  for (int run = 0; run < 100; ++run) {
    LikelihoodCase c = random_likelihood_case(random, false, 1 + static_cast<std::size_t>(run % 8));
    c.view.source_seen = 0.6;
    c.view.source_more = 0.3;
    c.view.source_wander_m2 = 0.5;
    c.view.evidence_share = 0.3;
    const Cell<double> cell = support::cell_of(c.z);
    Component<double> component = support::component_of(c.object);
    Prediction<double> of_object(component, c.view);
    component.source = {0.5, 0.2, 0.1, -1};
    Prediction<double> of_mixture(component, c.view);
    const double n = cell.n;
    // Chance of n detections of a source of clutter over that of an object, both with at least one.
    const double none = std::exp(support::log_count_reference(c.object, c.view.exposure, 0.0));
    const double log_object = support::log_count_reference(c.object, c.view.exposure, n) - std::lgamma(n + 1.0);
    const double ratio = 0.7 * std::pow(0.3, n - 1.0) / (std::exp(log_object) / (1.0 - none));
    // Neither exactly one detection nor a place far from the predicted one speaks for a source.
    const Eigen::Matrix2d place = c.object.covariance.topLeftCorner<2, 2>() +
                                  (c.view.spread * c.object.extent() + support::eigen(c.view.noise_m2)) / n;
    const Eigen::Matrix2d wide = place + 0.5 * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d e = support::eigen(cell.mean()) - c.object.mean.head<2>();
    const double log_place = 0.5 * (std::log(place.determinant() / wide.determinant()) + e.dot(place.inverse() * e) -
                                    e.dot(wide.inverse() * e));
    const double source = 0.6 * std::min(1.0, ratio) * std::exp(std::min(0.0, log_place));
    const double object = 0.5, lobe = 0.2 * 0.6 * std::pow(std::min(1.0, ratio), 0.3), lasting = 0.1 * source,
                 brief = 0.2 * source;
    const double sum = object + lobe + lasting + brief;
    EXPECT_NEAR(of_mixture.log_likelihood(cell) - of_object.log_likelihood(cell), std::log(sum), 1e-8);
    const Component<double> updated = of_mixture.updated(component, cell);
    EXPECT_NEAR(updated.source.object, object / sum, 1e-9);
    EXPECT_NEAR(updated.source.side_lobe, lobe / sum, 1e-9);
    EXPECT_NEAR(updated.source.lasting_source, lasting / sum, 1e-9);
    EXPECT_NEAR(updated.source.brief_source(), brief / sum, 1e-9);
  }
}

TEST(Prediction, InSinglePrecisionGivesTheLikelihoodOfDouble) {
  support::Random random(14);
  for (int run = 0; run < 100; ++run) {
    const LikelihoodCase c = random_likelihood_case(random, false, 1 + static_cast<std::size_t>(run % 8));
    const Component<double> d = support::component_of(c.object);
    Component<float> f;
    const auto narrow = [](double x) { return static_cast<float>(x); };
    const auto narrow_symmetric = [&](const Symmetric2<double>& s) {
      return Symmetric2<float>{narrow(s.xx), narrow(s.xy), narrow(s.yy)};
    };
    f.position_m = {narrow(d.position_m.x), narrow(d.position_m.y)};
    f.position_covariance = narrow_symmetric(d.position_covariance);
    f.velocity_covariance = narrow_symmetric(d.velocity_covariance);
    f.extent_dof = narrow(d.extent_dof);
    f.extent_scale = narrow_symmetric(d.extent_scale);
    f.rate_shape = narrow(d.rate_shape);
    f.rate_inverse_scale = narrow(d.rate_inverse_scale);
    View<float> view;
    view.detection_probability = narrow(c.view.detection_probability);
    view.exposure = narrow(c.view.exposure);
    view.noise_m2 = narrow_symmetric(c.view.noise_m2);
    view.spread = narrow(c.view.spread);
    Cell<float> cell;
    for (const auto& z : c.z) {
      Measurement<float> m;
      m.position_m = {narrow(z.position_m.x), narrow(z.position_m.y)};
      m.log_clutter = narrow(z.log_clutter);
      cell.add(m, 1.0F);
    }
    EXPECT_NEAR(Prediction<float>(f, view).log_likelihood(cell), log_likelihood_of(c), 0.02);
  }
}

}  // namespace
}  // namespace boresight::tracking
