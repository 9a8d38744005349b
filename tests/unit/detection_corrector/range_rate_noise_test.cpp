// The learnt ratio of actual to stated range-rate noise: against the noise that was drawn, the Cramér–Rao bound, moving
// objects, errors of the vehicle, and invalid values.
#include "services/detection_corrector/core/range_rate_noise.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::corrector {
namespace {

constexpr double kBody_mps = 0.06;

/// A radar that states `stated_mps` and has `actual_mps`.
struct Radar {
  double stated_mps = 0.27, actual_mps = 0.1;
  double angular_mps = 0.03;
  int per_scan = 40;
  double cycle_s = 0.075;
  double movers = 0.0;                                       // share of the detections
  double heavy_tail = 0.0;                                   // share of stationary detections with three times the std
  Eigen::Vector3d common_std_mps = Eigen::Vector3d::Zero();  // beside the motion of the body
};

class Drive {
 public:
  explicit Drive(const Radar& radar, unsigned seed = 1, const StatedNoiseConfig& config = {})
      : noise(config), radar_(radar), random_(seed) {}

  void run(double seconds) {
    const auto scans = static_cast<int>(std::lround(seconds / radar_.cycle_s));
    const Eigen::Vector3d variance =
        radar_.common_std_mps.cwiseAbs2() + Eigen::Vector3d::Constant(kBody_mps * kBody_mps);
    for (int s = 0; s < scans; ++s) {
      time_ns_ += static_cast<std::int64_t>(radar_.cycle_s * 1e9);
      const Eigen::Vector3d error(normal(std::sqrt(variance.x())), normal(std::sqrt(variance.y())),
                                  normal(std::sqrt(variance.z())));
      scan.clear();
      for (int i = 0; i < radar_.per_scan; ++i) scan.push_back(detection(error));
      noise.learn(scan, variance.asDiagonal().toDenseMatrix(), time_ns_);
    }
  }
  [[nodiscard]] double scale() const { return std::sqrt(noise.variance_factor()); }
  /// Std of the noise that was drawn over the stated one: what the estimator cannot see apart.
  [[nodiscard]] double drawn_scale() const { return std::sqrt(drawn_ / drawn_count_) / radar_.stated_mps; }
  [[nodiscard]] double drawn_count() const { return drawn_count_; }

  RangeRateNoise noise;
  std::vector<Innovation> scan;

 private:
  double normal(double std) { return std * std::normal_distribution<double>()(random_); }
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

  Innovation detection(const Eigen::Vector3d& error) {
    const double azimuth = uniform(-1.0, 1.0);
    const Eigen::Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0.0);
    const double scatter = uniform(0.0, 1.0) < radar_.heavy_tail ? 3.0 : 1.0;
    const double own = normal(scatter * radar_.actual_mps);
    double value = own + normal(radar_.angular_mps) + direction.dot(error);
    if (uniform(0.0, 1.0) < radar_.movers) {
      // Vehicles, and one in three a pedestrian.
      value += uniform(0.0, 1.0) < 1.0 / 3.0 ? uniform(-1.5, 1.5) : uniform(-20.0, 20.0);
    } else {
      drawn_ += own * own;
      drawn_count_ += 1.0;
    }
    return {direction, value, radar_.stated_mps * radar_.stated_mps, radar_.angular_mps * radar_.angular_mps};
  }

  Radar radar_;
  std::mt19937_64 random_;
  std::int64_t time_ns_ = 1'000'000'000'000;
  double drawn_ = 0.0, drawn_count_ = 0.0;
};

/// The evidence alone.
StatedNoiseConfig without_prior() {
  StatedNoiseConfig config;
  config.prior_detections = 1.0;
  return config;
}

TEST(RangeRateNoise, FindsTheRatioOfTheNoiseThatWasDrawn) {
  for (const double actual_mps : {0.1, 0.27, 0.54}) {
    Radar radar;  // stated / actual 2.7, 1, 0.5
    radar.actual_mps = actual_mps;
    Drive drive(radar, 1, without_prior());
    drive.run(120.0);
    EXPECT_NEAR(drive.scale() / drive.drawn_scale(), 1.0, 0.02) << actual_mps;
    Drive with_prior(radar);
    with_prior.run(120.0);
    EXPECT_NEAR(with_prior.scale() / drive.drawn_scale(), 1.0, 0.05) << actual_mps;
  }
}

TEST(RangeRateNoise, ErrorIsNearTheCramerRaoBound) {
  StatedNoiseConfig config = without_prior();
  config.time_constant_s = 1e6;
  Radar radar;
  radar.stated_mps = radar.actual_mps = 0.1;
  radar.angular_mps = 0.0;
  double squared = 0.0, count = 0.0;
  constexpr unsigned kDrives = 200;
  for (unsigned seed = 1; seed <= kDrives; ++seed) {
    Drive drive(radar, seed, config);
    drive.run(1.5);
    squared += (drive.scale() - 1.0) * (drive.scale() - 1.0) / kDrives;
    count = drive.drawn_count();
  }
  const double bound = std::sqrt(1.0 / (2.0 * count));  // std of a std from `count` normal values
  EXPECT_LT(std::sqrt(squared), 1.3 * bound);
}

TEST(RangeRateNoise, ThirtyPercentMovingObjectsLeaveNoBias) {
  for (const double actual_mps : {0.1, 0.27, 0.54}) {
    Radar radar;
    radar.actual_mps = actual_mps;
    radar.movers = 0.3;
    Drive drive(radar, 1, without_prior());
    drive.run(120.0);
    EXPECT_NEAR(drive.scale() / drive.drawn_scale(), 1.0, 0.05) << actual_mps;
  }
}

TEST(RangeRateNoise, AMajorityOfVehiclesDoesNotWidenTheNoise) {
  Radar radar;
  radar.movers = 0.7;
  Drive drive(radar, 1, without_prior());
  drive.run(120.0);
  EXPECT_NEAR(drive.scale() / drive.drawn_scale(), 1.0, 0.3);
}

TEST(RangeRateNoise, ErrorsOfTheVehicleAreNotTheRadars) {
  // 1° of the mounting at 20 m/s to the side, 1 % of the speed: common to a scan, and as large as stated or absent.
  Radar radar;
  radar.stated_mps = radar.actual_mps = 0.1;
  radar.common_std_mps = {0.2, 0.35, 0.1};
  Drive drive(radar);
  drive.run(120.0);
  EXPECT_NEAR(drive.scale(), 1.0, 0.03);

  Radar exact = radar;
  exact.common_std_mps.setZero();
  Drive unaware(exact);
  for (int s = 0; s < 600; ++s) {
    unaware.run(exact.cycle_s);
    unaware.noise.learn(unaware.scan, Eigen::Vector3d(0.04, 0.12, 0.01).asDiagonal().toDenseMatrix(), 0);
  }
  EXPECT_NEAR(unaware.scale(), 1.0, 0.05);
}

TEST(RangeRateNoise, HeavyTailsAreNoReasonForATighterThreshold) {
  Radar radar;
  radar.stated_mps = radar.actual_mps = 0.1;
  radar.heavy_tail = 0.1;  // kurtosis 8
  Drive drive(radar);
  drive.run(120.0);
  EXPECT_GT(drive.scale(), 1.0);
  EXPECT_LT(drive.scale(), 1.5);
}

TEST(RangeRateNoise, ReturnsToTheStatedNoiseWithoutDetections) {
  RangeRateNoise untouched{StatedNoiseConfig{}};
  untouched.learn({}, Eigen::Matrix3d::Identity(), 1'000'000'000);
  EXPECT_EQ(untouched.variance_factor(), 1.0);

  Drive drive{Radar{}};
  drive.run(60.0);
  const double learnt = drive.scale();
  EXPECT_LT(learnt, 0.45);
  double before = learnt;
  for (int minute = 1; minute <= 20; ++minute) {
    drive.noise.learn({}, Eigen::Matrix3d::Identity(), 1'100'000'000'000 + minute * 60'000'000'000);
    EXPECT_GE(drive.scale(), before);
    before = drive.scale();
  }
  EXPECT_NEAR(before, 1.0, 1e-3);
}

TEST(RangeRateNoise, ASlowRadarWithFewDetectionsIsLearntToo) {
  Radar radar;
  radar.cycle_s = 1.0;
  radar.per_scan = 15;
  Drive drive(radar);
  drive.run(400.0);
  // The prior keeps its share: 300 of about 1200 detections.
  const StatedNoiseConfig config;
  const double evidence = radar.per_scan * config.time_constant_s / radar.cycle_s;
  const double share = config.prior_detections / (config.prior_detections + evidence);
  const double ratio = radar.actual_mps / radar.stated_mps;
  EXPECT_NEAR(drive.scale(), std::sqrt(share + (1.0 - share) * ratio * ratio), 0.06);
}

TEST(RangeRateNoise, InvalidValuesAreIgnored) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const Eigen::Matrix3d common = kBody_mps * kBody_mps * Eigen::Matrix3d::Identity();
  const Innovation good{Eigen::Vector3d::UnitX(), 0.1, 0.04, 0.001};
  std::vector<Innovation> scan(20, good);
  RangeRateNoise clean{StatedNoiseConfig{}}, dirty{StatedNoiseConfig{}};
  clean.learn(scan, common, 1);
  for (const double bad : {nan, infinite, -infinite}) {
    Innovation i = good;
    i.value_mps = bad;
    scan.push_back(i);
    i = good;
    i.stated_variance_m2ps2 = bad;
    scan.push_back(i);
    i = good;
    i.angular_variance_m2ps2 = bad;
    scan.push_back(i);
    i = good;
    i.direction.y() = bad;
    scan.push_back(i);
  }
  for (const double variance : {0.0, -0.04}) scan.push_back({Eigen::Vector3d::UnitX(), 0.1, variance, 0.001});
  dirty.learn(scan, common, 1);
  EXPECT_EQ(dirty.variance_factor(), clean.variance_factor());
  dirty.learn(scan, nan * common, 2);
  EXPECT_EQ(dirty.variance_factor(), clean.variance_factor());
  // Nothing is known to be wrong, and nothing measured: no division by zero.
  scan.assign(20, {Eigen::Vector3d::UnitX(), 0.0, 1e-300, 0.0});
  dirty.learn(scan, Eigen::Matrix3d::Zero(), 3);
  EXPECT_TRUE(std::isfinite(dirty.variance_factor()));
}

TEST(RangeRateNoise, StaysWithinItsLimits) {
  StatedNoiseConfig config;
  config.least_scale = 0.5;
  config.most_scale = 2.0;
  for (const double actual_mps : {1e-4, 1.0}) {
    Radar radar;
    radar.actual_mps = actual_mps;
    Drive drive(radar, 1, config);
    drive.run(120.0);
    EXPECT_EQ(drive.scale(), actual_mps < radar.stated_mps ? config.least_scale : config.most_scale);
  }
}

TEST(RangeRateNoise, AClockThatRunsBackwardsForgetsNothing) {
  Drive drive{Radar{}};
  drive.run(30.0);
  const double learnt = drive.scale();
  drive.noise.learn({}, Eigen::Matrix3d::Identity(), 0);
  EXPECT_EQ(drive.scale(), learnt);
}

TEST(RangeRateNoise, AllocatesNothing) {
  Drive drive{Radar{}};
  drive.run(0.075);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    drive.noise.learn(drive.scan, Eigen::Matrix3d::Identity(), 0);
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::corrector
