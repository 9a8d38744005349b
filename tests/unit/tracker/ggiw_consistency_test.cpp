// Normalised estimation error squared (NEES) of whole tracks, simulated with the model's own assumptions.
#include <cmath>

#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/prediction.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking {
namespace {

struct ConsistencyCase {
  bool has_range_rates = false;
  double detection_probability = 1.0;
  std::size_t tracks = 200, scans = 60;
};
struct WholeTrackNees {
  double mean = 0.0;            ///< of all tracks and scans
  double standard_error = 0.0;  ///< from the scatter between tracks, which are independent: errors within one are not
};

Eigen::Vector4d draw_gaussian(support::Random& random, const Eigen::Matrix4d& covariance) {
  Eigen::Vector4d x;
  for (double& v : x) v = support::normal(random);
  return covariance.llt().matrixL() * x;
}

/// X of the inverse Wishart: each call a new object (Bartlett's decomposition, v − 3 degrees of freedom).
Eigen::Matrix2d draw_object_extent(support::Random& random, const support::Reference& r) {
  const Eigen::Matrix2d root = r.scale.inverse().llt().matrixL();
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  a(0, 0) = std::sqrt(std::chi_squared_distribution<double>(r.dof - 3.0)(random));
  a(1, 1) = std::sqrt(std::chi_squared_distribution<double>(r.dof - 4.0)(random));
  a(1, 0) = support::normal(random);
  return (root * a * (root * a).transpose()).inverse();
}

WholeTrackNees simulate_nees(const ConsistencyCase& the_case, std::uint64_t seed) {
  constexpr double kStep_s = 0.1;
  support::Random random(seed);
  MotionParameters motion;
  motion.acceleration_density = 1.0;
  motion.rate_memory_s = motion.extent_memory_s = 1e9;  // rate and extent of a track do not change
  View<double> view;
  view.detection_probability = the_case.detection_probability;
  view.noise_m2 = {0.04, 0.01, 0.09};
  view.range_rate_variance = the_case.has_range_rates ? 0.04 : 0.0;
  support::Reference prior;
  prior.covariance = Eigen::Vector4d(2.0, 2.0, 4.0, 4.0).asDiagonal();
  prior.rate_shape = 20.0;
  prior.rate_inverse_scale = 4.0;
  prior.dof = 40.0;
  prior.scale = 34.0 * Eigen::Vector2d(4.0, 1.0).asDiagonal();

  Eigen::Matrix4d f = Eigen::Matrix4d::Identity(), q = Eigen::Matrix4d::Zero();
  f.topRightCorner<2, 2>().diagonal().setConstant(kStep_s);
  q.topLeftCorner<2, 2>().diagonal().setConstant(std::pow(kStep_s, 3) / 3.0);
  q.topRightCorner<2, 2>().diagonal().setConstant(std::pow(kStep_s, 2) / 2.0);
  q.bottomLeftCorner<2, 2>().diagonal().setConstant(std::pow(kStep_s, 2) / 2.0);
  q.bottomRightCorner<2, 2>().diagonal().setConstant(kStep_s);
  q *= motion.acceleration_density;

  double sum = 0.0, squares = 0.0;
  for (std::size_t track = 0; track < the_case.tracks; ++track) {
    prior.mean << support::uniform(random, 20.0, 60.0), support::uniform(random, -20.0, 20.0),
        support::uniform(random, -20.0, 20.0), support::uniform(random, -10.0, 10.0);
    Component<double> c = support::component_of(prior);
    Eigen::Vector4d truth = prior.mean + draw_gaussian(random, prior.covariance);
    const Eigen::Matrix2d extent = draw_object_extent(random, prior);
    const double rate = std::gamma_distribution<double>(prior.rate_shape, 1.0 / prior.rate_inverse_scale)(random);
    double of_track = 0.0;
    for (std::size_t scan = 0; scan < the_case.scans; ++scan) {
      truth = f * truth + draw_gaussian(random, q);
      predict(c, motion, kStep_s);
      const bool is_detected = support::uniform(random, 0.0, 1.0) < view.detection_probability;
      const auto n = is_detected ? static_cast<std::size_t>(std::poisson_distribution<int>(rate)(random)) : 0;
      Prediction<double> p(c, view);
      if (n == 0) {
        c = p.missed_component(c);
      } else {
        c = p.updated(c, support::cell_of(support::draw_detections(random, truth, extent, view, n, -5.0)));
      }
      const support::Reference r = support::reference_of(c);
      const Eigen::Vector4d error = truth - r.mean;
      of_track += error.dot(r.covariance.llt().solve(error)) / static_cast<double>(the_case.scans);
    }
    sum += of_track;
    squares += of_track * of_track;
  }
  const auto n = static_cast<double>(the_case.tracks);
  WholeTrackNees nees;
  nees.mean = sum / n;
  nees.standard_error = std::sqrt((squares / n - nees.mean * nees.mean) / (n - 1.0));
  return nees;
}

/// The mean of four degrees of freedom is 4; 2.58 standard errors are 99 % of a Gaussian.
void expect_consistent(const ConsistencyCase& the_case, std::uint64_t seed) {
  constexpr double kDegreesOfFreedom = 4.0, kOf99Percent = 2.58;
  const WholeTrackNees nees = simulate_nees(the_case, seed);
  EXPECT_NEAR(nees.mean, kDegreesOfFreedom, kOf99Percent * nees.standard_error);
  EXPECT_LT(nees.standard_error, 0.15) << "a bound that judges nothing";
  testing::Test::RecordProperty("nees", std::to_string(nees.mean));
}

TEST(WholeTrackConsistency, HoldsWithPositionsAlone) {
  expect_consistent({false, 1.0}, 1);
}
TEST(WholeTrackConsistency, HoldsWithRangeRates) {
  expect_consistent({true, 1.0}, 2);
}
TEST(WholeTrackConsistency, HoldsWithPositionsAloneAndMissedDetections) {
  expect_consistent({false, 0.7}, 3);
}
TEST(WholeTrackConsistency, HoldsWithRangeRatesAndMissedDetections) {
  expect_consistent({true, 0.7}, 4);
}

}  // namespace
}  // namespace boresight::tracking
