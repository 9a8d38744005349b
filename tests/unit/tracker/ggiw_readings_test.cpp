// Readings: where an object's detections lie by what it may be. Against the plain prediction, a stacked Gaussian, a
// Kalman update with Eigen, and quadrature.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/prediction.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

using support::Detections;
using support::Reference;

struct ReadingCase {
  Reference object;
  View<double> view;
  Detections z;
};

Reading<double> random_reading(support::Random& random, bool knows_scatter) {
  Reading<double> r;
  r.offset_m = {support::uniform(random, -4.0, 4.0), support::uniform(random, -2.0, 2.0)};
  r.covariance_m2 = support::symmetric_of(support::random_positive<2>(random, 1.0));
  r.knows_scatter = knows_scatter;
  r.scatter_m2 = support::symmetric_of(support::random_positive<2>(random, 1.5));
  return r;
}

ReadingCase random_reading_case(support::Random& random, bool has_range_rates, std::size_t n) {
  ReadingCase c{support::random_object(random), support::random_view(random, has_range_rates), {}};
  c.z = support::draw_detections(random, c.object.mean, c.object.extent(), c.view, n, -4.0);
  return c;
}
double log_likelihood_of(const Reference& object, const View<double>& view, const Detections& z) {
  return Prediction<double>(support::component_of(object), view).log_likelihood(support::cell_of(z));
}
View<double> with_reading(View<double> view, const Reading<double>& reading) {
  view.number_of_readings = 1;
  view.readings[0] = reading;
  return view;
}

TEST(GgiwReadings, OneWithoutOffsetEqualsThePlainPredictionBitForBit) {
  support::Random random(1);
  for (int run = 0; run < 200; ++run) {
    const ReadingCase c = random_reading_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run) % 7);
    Reading<double> zero;
    zero.weight = 0.4;                  // of one reading alone, the weight is 1 whatever is written
    zero.scatter_m2 = {9.0, 0.0, 9.0};  // and what it does not know does not count
    const View<double> with = with_reading(c.view, zero);
    const Component<double> object = support::component_of(c.object);
    const Cell<double> cell = support::cell_of(c.z);
    Prediction<double> plain(object, c.view), read(object, with);
    EXPECT_EQ(plain.log_likelihood(cell), read.log_likelihood(cell));
    EXPECT_EQ(plain.log_intensity(c.z[0]), read.log_intensity(c.z[0]));
    EXPECT_EQ(plain.place_distance(c.z[0].position_m), read.place_distance(c.z[0].position_m));
    EXPECT_EQ(plain.missed(), read.missed());
    const Component<double> a = plain.updated(object, cell), b = read.updated(object, cell);
    EXPECT_EQ(support::eigen(a.position_m), support::eigen(b.position_m));
    EXPECT_EQ(support::eigen(a.position_covariance), support::eigen(b.position_covariance));
    EXPECT_EQ(support::eigen(a.velocity_covariance), support::eigen(b.velocity_covariance));
    EXPECT_EQ(support::eigen(a.extent_scale), support::eigen(b.extent_scale));
    EXPECT_EQ(a.extent_dof, b.extent_dof);
  }
}

TEST(GgiwReadings, MixtureIsTheWeightedSumOfItsReadings) {
  support::Random random(2);
  for (int run = 0; run < 200; ++run) {
    const ReadingCase c = random_reading_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run) % 5);
    const std::size_t number = 2 + static_cast<std::size_t>(run) % 2;
    View<double> mixed = c.view;
    mixed.number_of_readings = number;
    const std::array<double, 3> weights = number == 2 ? std::array{0.3, 0.7, 0.0} : std::array{0.2, 0.3, 0.5};
    double sum = 0.0;
    for (std::size_t k = 0; k < number; ++k) {
      mixed.readings[k] = random_reading(random, (run + static_cast<int>(k)) % 2 == 0);
      mixed.readings[k].weight = weights[k];
      sum += weights[k] * std::exp(log_likelihood_of(c.object, with_reading(c.view, mixed.readings[k]), c.z));
    }
    const double expected = std::log(sum);
    EXPECT_NEAR(log_likelihood_of(c.object, mixed, c.z), expected, 1e-9 * (1.0 + std::abs(expected)));
  }
}

TEST(GgiwReadings, EqualReadingsAreTheSingleOne) {
  support::Random random(3);
  for (int run = 0; run < 50; ++run) {
    const ReadingCase c = random_reading_case(random, true, 4);
    Reading<double> reading = random_reading(random, run % 2 == 0);
    View<double> thrice = c.view;
    thrice.number_of_readings = 3;
    reading.weight = 1.0 / 3.0;
    thrice.readings.fill(reading);
    const View<double> once = with_reading(c.view, reading);
    EXPECT_NEAR(log_likelihood_of(c.object, thrice, c.z), log_likelihood_of(c.object, once, c.z), 1e-9);
    const Component<double> object = support::component_of(c.object);
    const Cell<double> cell = support::cell_of(c.z);
    support::expect_equal(support::reference_of(Prediction<double>(object, thrice).updated(object, cell)),
                          support::reference_of(Prediction<double>(object, once).updated(object, cell)), 1e-9);
  }
}

TEST(GgiwReadings, OffsetActsAsAShiftedComponent) {
  support::Random random(4);
  for (int run = 0; run < 200; ++run) {
    const ReadingCase c = random_reading_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run) % 6);
    Reading<double> reading = random_reading(random, run % 4 < 2);
    Reference shifted = c.object;
    shifted.mean.head<2>() += support::eigen(reading.offset_m);
    const View<double> off = with_reading(c.view, reading);
    reading.offset_m = {0.0, 0.0};
    const View<double> here = with_reading(c.view, reading);
    const double expected = log_likelihood_of(shifted, here, c.z);
    EXPECT_NEAR(log_likelihood_of(c.object, off, c.z), expected, 1e-9 * (1.0 + std::abs(expected)));
    Component<double> object = support::component_of(c.object), moved = support::component_of(shifted);
    const Cell<double> cell = support::cell_of(c.z);
    Reference updated = support::reference_of(Prediction<double>(object, off).updated(object, cell));
    updated.mean.head<2>() += shifted.mean.head<2>() - c.object.mean.head<2>();
    support::expect_equal(updated, support::reference_of(Prediction<double>(moved, here).updated(moved, cell)), 1e-9);
  }
}

/// log of P_D, number and density of the places and range rates of detections with a known scatter: one Gaussian of
/// all.
double stacked_log_likelihood(const Reference& r, const View<double>& view, const Detections& z) {
  const Reading<double>& reading = view.readings[0];
  const auto n = static_cast<Eigen::Index>(z.size());
  const Eigen::Index size = view.range_rate_variance > 0.0 ? 3 * n : 2 * n;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, 4), noise = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd e(size);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Measurement<double>& m = z[static_cast<std::size_t>(i)];
    h.block<2, 2>(2 * i, 0).setIdentity();
    for (Eigen::Index j = 0; j < n; ++j) noise.block<2, 2>(2 * i, 2 * j) = support::eigen(reading.covariance_m2);
    noise.block<2, 2>(2 * i, 2 * i) += support::eigen(reading.scatter_m2) + support::eigen(view.noise_m2);
    e.segment<2>(2 * i) = support::eigen(m.position_m) - r.mean.head<2>() - support::eigen(reading.offset_m);
    if (size == 2 * n) continue;
    h.block<1, 2>(2 * n + i, 2) = support::eigen(m.sight).transpose();
    noise(2 * n + i, 2 * n + i) = view.range_rate_variance;
    e(2 * n + i) = m.range_rate_mps - support::eigen(m.sight).dot(r.mean.tail<2>());
  }
  double log_p = std::log(view.detection_probability) +
                 support::log_count_reference(r, view.exposure, static_cast<double>(n)) +
                 support::log_gaussian(e, h * r.covariance * h.transpose() + noise);
  for (const auto& m : z) log_p -= m.log_clutter;
  return log_p;
}

TEST(GgiwReadings, KnownScatterIsAGaussianOfAllDetections) {
  support::Random random(5);
  for (int run = 0; run < 300; ++run) {
    ReadingCase c = random_reading_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run) % 9);
    c.view = with_reading(c.view, random_reading(random, true));
    const double expected = stacked_log_likelihood(c.object, c.view, c.z);
    EXPECT_NEAR(log_likelihood_of(c.object, c.view, c.z), expected, 1e-8 * (1.0 + std::abs(expected)));
  }
}

/// Kalman update by the mean of the detections and all range rates in one vector.
Reference kalman_reference(const Reference& prior, const View<double>& view, const Detections& z) {
  const support::Sums s = support::sums_of(z);
  const Reading<double>& reading = view.readings[0];
  const Eigen::Index rates = view.range_rate_variance > 0.0 ? s.rates.size() : 0, size = 2 + rates;
  const Eigen::Matrix2d scatter = (reading.knows_scatter ? view.held * support::eigen(reading.scatter_m2)
                                                         : Eigen::Matrix2d(view.held * view.spread * prior.extent())) +
                                  support::eigen(view.noise_m2);
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, 4), noise = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd e(size);
  h.topLeftCorner<2, 2>().setIdentity();
  noise.topLeftCorner<2, 2>() = scatter / s.n + support::eigen(reading.covariance_m2);
  e.head<2>() = s.mean - prior.mean.head<2>() - support::eigen(reading.offset_m);
  if (rates > 0) {
    h.bottomRightCorner(rates, 2) = s.sights;
    noise.bottomRightCorner(rates, rates).diagonal().setConstant(view.range_rate_variance);
    e.tail(rates) = s.rates - s.sights * prior.mean.tail<2>();
  }
  const Eigen::MatrixXd innovation = h * prior.covariance * h.transpose() + noise;
  const Eigen::MatrixXd gain = innovation.ldlt().solve(h * prior.covariance).transpose();
  Reference out = prior;
  out.mean += gain * e;
  const Eigen::Matrix4d keep = Eigen::Matrix4d::Identity() - gain * h;
  out.covariance = keep * prior.covariance * keep.transpose() + gain * noise * gain.transpose();
  return out;
}

TEST(GgiwReadings, UpdateIsAKalmanUpdateByTheMeanOfTheDetections) {
  support::Random random(6);
  for (int run = 0; run < 300; ++run) {
    ReadingCase c = random_reading_case(random, run % 2 == 0, 1 + static_cast<std::size_t>(run) % 9);
    c.view.held = run % 3 == 0 ? 1.0 : 5.0;
    c.view = with_reading(c.view, random_reading(random, run % 4 < 2));
    const Component<double> object = support::component_of(c.object);
    const Cell<double> cell = support::cell_of(c.z);
    const Component<double> updated = Prediction<double>(object, c.view).updated(object, cell);
    Reference expected = kalman_reference(c.object, c.view, c.z), value = support::reference_of(updated);
    expected.dof = value.dof;
    expected.scale = value.scale;
    expected.rate_shape += cell.n;
    expected.rate_inverse_scale += c.view.exposure;
    support::expect_equal(value, expected, 1e-8);
  }
}

TEST(GgiwReadings, KnownScatterTeachesNothingAboutTheExtent) {
  support::Random random(7);
  ReadingCase c = random_reading_case(random, true, 5);
  c.view = with_reading(c.view, random_reading(random, true));
  const Component<double> object = support::component_of(c.object);
  const Component<double> updated = Prediction<double>(object, c.view).updated(object, support::cell_of(c.z));
  EXPECT_EQ(updated.extent_dof, object.extent_dof);
  EXPECT_EQ(support::eigen(updated.extent_scale), support::eigen(object.extent_scale));
}

// A mixture of a reading that knows its scatter and one that does not: the extent learns by the second one's share.
TEST(GgiwReadings, SharesOfReadingsSumToOne) {
  support::Random random(8);
  for (int run = 0; run < 100; ++run) {
    ReadingCase c = random_reading_case(random, run % 2 == 0, 3);
    c.view.number_of_readings = 3;
    double expected = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      Reading<double>& reading = c.view.readings[k];
      reading = random_reading(random, k == 0);
      reading.weight = k == 0 ? 0.5 : 0.25;
      const double p = reading.weight * std::exp(log_likelihood_of(c.object, with_reading(c.view, reading), c.z));
      sum += p;
      if (!reading.knows_scatter) expected += p;
    }
    const Component<double> object = support::component_of(c.object);
    const auto learnt_by = [&] {
      return (Prediction<double>(object, c.view).updated(object, support::cell_of(c.z)).extent_dof -
              object.extent_dof) /
             3.0;
    };
    EXPECT_NEAR(learnt_by(), expected / sum, 1e-9);
    c.view.readings[0].knows_scatter = false;
    EXPECT_NEAR(learnt_by(), 1.0, 1e-12);
  }
}

TEST(GgiwReadings, FarDetectionsGiveFiniteLikelihoodsAndShares) {
  support::Random random(9);
  ReadingCase c = random_reading_case(random, true, 3);
  c.view.number_of_readings = 2;
  for (std::size_t k = 0; k < 2; ++k) {
    c.view.readings[k] = random_reading(random, k == 0);
    c.view.readings[k].weight = 0.5;
  }
  for (auto& z : c.z) z.position_m = z.position_m + Vector2<double>{3e3, -2e3};
  const Component<double> object = support::component_of(c.object);
  EXPECT_TRUE(std::isfinite(log_likelihood_of(c.object, c.view, c.z)));
  const Component<double> updated = Prediction<double>(object, c.view).updated(object, support::cell_of(c.z));
  EXPECT_TRUE(std::isfinite(updated.position_m.x) && std::isfinite(updated.extent_scale.xx));
}

template <typename Real>
void expect_positive(const Component<Real>& c, int update) {
  const Eigen::Matrix2d pp = support::eigen(c.position_covariance), vv = support::eigen(c.velocity_covariance);
  ASSERT_GT(pp(0, 0), 0.0) << update;
  ASSERT_GT(pp.determinant(), 0.0) << update;
  ASSERT_GT(vv(0, 0), 0.0) << update;
  ASSERT_GT(vv.determinant(), 0.0) << update;
}

template <typename Real>
Symmetric2<Real> random_symmetric(support::Random& random, double scale) {
  const double a = support::uniform(random, 0.01, 1.0), b = support::uniform(random, 0.01, 1.0);
  const double xy = support::uniform(random, -0.99, 0.99) * std::sqrt(a * b);
  return {static_cast<Real>(scale * a), static_cast<Real>(scale * xy), static_cast<Real>(scale * b)};
}

template <typename Real>
void update_million_times() {
  support::Random random(10);
  MotionParameters motion;
  Component<Real> c;
  View<Real> view;
  view.detection_probability = Real(0.9);
  for (int update = 0; update < 1'000'000; ++update) {
    if (update % 200 == 0) {
      c = {};
      c.position_m = {30, 5};
      c.velocity_mps = {10, 0};
      c.position_covariance = random_symmetric<Real>(random, 900.0);
      c.velocity_covariance = random_symmetric<Real>(random, 100.0);
      c.extent_dof = 9;
      c.extent_scale = {Real(6), Real(0), Real(6)};
    }
    predict(c, motion, 0.01 + 0.05 * (update % 3));
    view.noise_m2 = random_symmetric<Real>(random, 0.3);
    view.range_rate_variance = update % 5 == 0 ? Real(0) : Real(0.01);
    view.number_of_readings = 1 + static_cast<std::size_t>(update) % 3;
    for (std::size_t k = 0; k < view.number_of_readings; ++k) {
      Reading<Real>& r = view.readings[k];
      r.weight = Real(1) / static_cast<Real>(view.number_of_readings);
      r.offset_m = {static_cast<Real>(3 * support::normal(random)), static_cast<Real>(support::normal(random))};
      r.covariance_m2 = random_symmetric<Real>(random, update % 7 == 0 ? 0.0 : 4.0);
      r.knows_scatter = (static_cast<std::size_t>(update) + k) % 2 == 0;
      r.scatter_m2 = random_symmetric<Real>(random, 2.0);
    }
    Cell<Real> cell;
    Measurement<Real> z;
    z.position_m = c.position_m + Vector2<Real>{static_cast<Real>(2 * support::normal(random)),
                                                static_cast<Real>(support::normal(random))};
    const Real range = std::sqrt(squared_norm(z.position_m));
    z.sight = range > 0 ? (Real(1) / range) * z.position_m : Vector2<Real>{1, 0};
    z.range_rate_mps = dot(z.sight, c.velocity_mps) + static_cast<Real>(0.1 * support::normal(random));
    cell.add(z, Real(1 + update % 4));
    c = Prediction<Real>(c, view).updated(c, cell);
    ASSERT_NO_FATAL_FAILURE(expect_positive(c, update));
  }
}
TEST(GgiwReadings, CovariancesStayPositiveOverAMillionUpdatesInDouble) {
  update_million_times<double>();
}
TEST(GgiwReadings, CovariancesStayPositiveOverAMillionUpdatesInFloat) {
  update_million_times<float>();
}

/// ∫ of the likelihood of one detection over its place, by the trapezoidal rule; P_D and the chance of one taken out.
template <typename Real>
double mass_over_places(bool knows_scatter, double reach_m, double step_m) {
  Component<Real> c;
  c.position_m = {20, 3};
  c.velocity_mps = {8, 1};
  c.position_covariance = {Real(0.5), Real(0.1), Real(0.3)};
  c.velocity_covariance = {1, 0, 1};
  c.rate_shape = 4;
  c.rate_inverse_scale = 2;
  c.extent_dof = 40;
  c.extent_scale = {Real(60), Real(10), Real(30)};
  View<Real> view;
  view.detection_probability = Real(0.8);
  view.exposure = Real(1.3);
  view.noise_m2 = {Real(0.2), Real(-0.05), Real(0.1)};
  view.number_of_readings = 2;
  view.readings[0] = {Real(0.3),
                      {Real(1.5), Real(-0.5)},
                      {Real(0.4), Real(0.1), Real(0.2)},
                      knows_scatter,
                      {Real(1.2), Real(0.3), Real(0.5)}};
  view.readings[1] = {Real(0.7),
                      {Real(-1), Real(0.2)},
                      {Real(0.1), Real(0), Real(0.6)},
                      knows_scatter,
                      {Real(0.3), Real(0), Real(0.8)}};
  Prediction<Real> p(c, view);
  double mass = 0.0;
  for (double x = -reach_m; x <= reach_m; x += step_m) {
    for (double y = -reach_m; y <= reach_m; y += step_m) {
      Measurement<Real> z;
      z.position_m = c.position_m + Vector2<Real>{static_cast<Real>(x), static_cast<Real>(y)};
      Cell<Real> cell;
      cell.add(z, Real(1));
      mass += std::exp(static_cast<double>(p.log_likelihood(cell))) * step_m * step_m;
    }
  }
  // P_D · α e β^α / (β + e)^(α + 1)
  return mass / (0.8 * 4.0 * 1.3 * std::pow(2.0, 4.0) / std::pow(3.3, 5.0));
}
TEST(GgiwReadings, LikelihoodOfOneDetectionIntegratesToOneOverPlaces) {
  EXPECT_NEAR(mass_over_places<double>(true, 9.0, 0.1), 1.0, 1e-6);
  EXPECT_NEAR(mass_over_places<float>(true, 9.0, 0.1), 1.0, 2e-5);
  EXPECT_NEAR(mass_over_places<double>(false, 14.0, 0.1), 1.0, 1e-3);
  EXPECT_NEAR(mass_over_places<float>(false, 14.0, 0.1), 1.0, 1e-3);
}

// What a detection alone is likely to be is gated and pruned by log_intensity(): the likeliest reading, so within the
// number of readings.
TEST(GgiwReadings, IntensityIsWithinTheNumberOfReadingsOfTheSumOverThem) {
  support::Random random(11);
  for (int run = 0; run < 100; ++run) {
    ReadingCase c = random_reading_case(random, run % 2 == 0, 1);
    c.view.number_of_readings = 3;
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      c.view.readings[k] = random_reading(random, true);
      c.view.readings[k].weight = 1.0 / 3.0;
      sum += std::exp(Prediction<double>(support::component_of(c.object), with_reading(c.view, c.view.readings[k]))
                          .log_intensity(c.z[0])) /
             3.0;
    }
    const double value = Prediction<double>(support::component_of(c.object), c.view).log_intensity(c.z[0]);
    EXPECT_LE(value, std::log(sum) + 1e-9);
    EXPECT_GE(value, std::log(sum) - std::log(3.0) - 1e-9);
  }
}

}  // namespace
}  // namespace boresight::tracking
