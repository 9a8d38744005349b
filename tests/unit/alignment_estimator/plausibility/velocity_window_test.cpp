#include "services/alignment_estimator/core/plausibility/velocity_window.hpp"

#include <memory>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace boresight::alignment::plausibility {
namespace {

/// Detections of a sensor with that velocity, a part of them at random range rates.
std::unique_ptr<ScanDetections> scan_of(const Eigen::Vector2d& velocity_mps, double outliers, double ambiguity_mps,
                                        double azimuth_limit_rad, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> azimuth(-azimuth_limit_rad, azimuth_limit_rad), share(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  auto scan = std::make_unique<ScanDetections>();
  scan->count = VelocityWindow::kCapacity;
  scan->ambiguity_mps = ambiguity_mps;
  for (std::size_t i = 0; i < scan->count; ++i) {
    const double a = azimuth(random);
    double range_rate = -(velocity_mps.x() * std::cos(a) + velocity_mps.y() * std::sin(a));
    if (share(random) < outliers) range_rate = 60.0 * share(random) - 30.0;
    range_rate += 0.05 * normal(random);
    if (ambiguity_mps > 0.0) range_rate = std::remainder(range_rate, ambiguity_mps);
    scan->azimuth_rad[i] = a + 0.005 * normal(random);
    scan->elevation_rad[i] = 0.0;
    scan->range_rate_mps[i] = range_rate;
    scan->range_m[i] = 20.0;
    scan->azimuth_std_rad[i] = 0.005;
    scan->range_rate_std_mps[i] = 0.05;
  }
  return scan;
}

TEST(VelocityWindow, FindsTheVelocityAmongOutliersWithinItsStd) {
  const Eigen::Vector2d truth{12.0, -9.0};
  double nees = 0.0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    VelocityWindow window;
    window.add(*scan_of(truth, 0.5, 0.0, 1.2, seed), VelocityWindow::kCapacity);
    const VelocityFit fit = window.fit({});
    ASSERT_TRUE(fit.valid) << seed;
    EXPECT_LT((fit.velocity_mps - truth).norm(), 0.3) << seed;
    EXPECT_NEAR(fit.share, 0.5, 0.15) << seed;
    nees += (fit.velocity_mps - truth).dot(fit.covariance.inverse() * (fit.velocity_mps - truth)) / 100.0;
  }
  EXPECT_LT(nees, 1.0) << "a reflector counts once, however many detections it has";
}

TEST(VelocityWindow, UnfoldsRangeRatesFromAStart) {
  const Eigen::Vector2d truth{20.0, -14.0}, start{19.0, -15.0};
  VelocityWindow window;
  window.add(*scan_of(truth, 0.4, 20.0, 1.2, 7), VelocityWindow::kCapacity);
  const VelocityFit fit = window.fit({&start, 1});
  ASSERT_TRUE(fit.valid);
  EXPECT_LT((fit.velocity_mps - truth).norm(), 0.3);
}

TEST(VelocityWindow, StandstillIsAVelocity) {
  VelocityWindow window;
  window.add(*scan_of({0.0, 0.0}, 0.3, 0.0, 1.2, 8), VelocityWindow::kCapacity);
  const VelocityFit fit = window.fit({});
  ASSERT_TRUE(fit.valid);
  EXPECT_LT(fit.velocity_mps.norm(), 0.1);
}

TEST(VelocityWindow, OneVehicleInAFewDegreesDoesNotOutweighTheWorld) {
  const Eigen::Vector2d truth{12.0, 3.0};
  auto scan = scan_of(truth, 0.0, 0.0, 1.2, 9);
  // Three quarters of the detections are one vehicle's.
  for (std::size_t i = 0; i < scan->count; ++i) {
    if (i % 4 == 0) continue;
    scan->azimuth_rad[i] = 0.2 + 1e-4 * static_cast<double>(i);
    scan->range_rate_mps[i] = 2.0;
  }
  VelocityWindow window;
  window.add(*scan, VelocityWindow::kCapacity);
  const VelocityFit fit = window.fit({});
  ASSERT_TRUE(fit.valid);
  EXPECT_LT((fit.velocity_mps - truth).norm(), 0.4);
}

TEST(VelocityWindow, FewDetectionsGiveNone) {
  auto scan = scan_of({12.0, 3.0}, 0.0, 0.0, 1.2, 10);
  scan->count = 6;
  VelocityWindow window;
  window.add(*scan, VelocityWindow::kCapacity);
  EXPECT_FALSE(window.fit({}).valid);
}

}  // namespace
}  // namespace boresight::alignment::plausibility
