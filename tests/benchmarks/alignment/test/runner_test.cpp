// The benchmark's own arithmetic, checked with a method that returns the truth.
#include "tests/benchmarks/alignment/common/runner.hpp"

#include <sstream>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {
namespace {

/// Returns the true mounting plus `error`, from the tenth scan of a radar on.
class Oracle : public alignment::Method {
 public:
  Oracle(const VehicleConfig& vehicle, const simulator::AlignmentSpec& spec, Eigen::Vector3d error)
      : drive_(spec), vehicle_(vehicle), speed_scale_(spec.speed_scale), error_(error), scans_(vehicle.radars.size()) {}
  void process(std::size_t radar, const alignment::ScanDetections&, const EgoSample&) override { ++scans_[radar]; }
  [[nodiscard]] alignment::RadarEstimate estimate(std::size_t radar) const override {
    alignment::RadarEstimate e;
    const bool knows = scans_[radar] >= 10;
    e.speed_scale = knows ? speed_scale_ : 1.0;
    e.sensor_to_vehicle = knows ? geometry::so3_exp(error_) * drive_.sensor_to_vehicle(radar, 1.0)
                                : geometry::sensor_to_vehicle(vehicle_.radars[radar].mounting_pose, 0.0, 0.0, 0.0);
    return e;
  }
  void predict(std::size_t radar, const alignment::ScanDetections& scan, const EgoSample& ego,
               std::span<double> out) const override {
    const alignment::RadarEstimate e = estimate(radar);
    for (std::size_t i = 0; i < scan.count; ++i) {
      out[i] = geometry::stationary_range_rate(
          e.sensor_to_vehicle * geometry::direction(scan.azimuth_rad[i], scan.elevation_rad[i]),
          geometry::sensor_velocity(e.speed_scale, ego.speed_mps, ego.yaw_rate_radps,
                                    vehicle_.radars[radar].mounting_pose.position_m));
    }
  }

 private:
  simulator::AlignmentDrive drive_;
  VehicleConfig vehicle_;
  double speed_scale_;
  Eigen::Vector3d error_;
  std::vector<int> scans_;
};

TEST(Runner, ErrorsAreAboutTheVehiclesAxes) {
  const auto spec = clean_drive(simulator::RoadKind::kCity, 10.0, 1);
  const Eigen::Vector3d error(0.001, -0.002, 0.003);
  RunOptions options;
  options.residuals = true;
  const auto run = run_drive(
      spec, [&](const VehicleConfig& vehicle) { return std::make_unique<Oracle>(vehicle, spec, error); }, options);
  ASSERT_GT(run.snapshots.size(), 50u);
  for (const RadarError& radar : run.last().radars) {
    EXPECT_NEAR(radar.error(kSpeedScale), 0.0, 1e-12);
    EXPECT_NEAR(radar.error(kRoll), 0.001, 1e-9);
    EXPECT_NEAR(radar.error(kPitch), -0.002, 1e-9);
    EXPECT_NEAR(radar.error(kYaw), 0.003, 1e-9);
  }
  // Before any data the error is the whole misalignment.
  EXPECT_GT(run.snapshots.front().radars[0].error.tail<3>().norm(), 1.5 * kRadiansPerDegree);
  // Ten scans of 50 ms, snapshots every 0.1 s.
  const TimeTo95 time = time_to_95(run, 0, kSpeedScale, 1e-4);
  EXPECT_NEAR(time.first_s, 0.5, 0.11);
  EXPECT_DOUBLE_EQ(time.first_s, time.stays_s);
  EXPECT_TRUE(std::isnan(time_to_95(run, 0, kSpeedScale, 0.5).first_s)) << "initial error too small";
  // Residuals at the truth are the noise: of range rate 0.03 m/s and of the angles.
  EXPECT_GT(run.corrected.count(), 1000.0);
  EXPECT_LT(run.corrected.rmse(), 0.12);
  EXPECT_GT(run.uncorrected.rmse(), 1.5 * run.corrected.rmse());
}

TEST(Runner, OracleInliersHaveNoOutliers) {
  auto spec = clean_drive(simulator::RoadKind::kCity, 6.0, 2);
  spec.outlier_share = 0.5;
  /// Counts the detections that it receives.
  class Counter : public Oracle {
   public:
    Counter(const VehicleConfig& vehicle, const simulator::AlignmentSpec& s, double& count)
        : Oracle(vehicle, s, Eigen::Vector3d::Zero()), count_(count) {}
    void process(std::size_t, const alignment::ScanDetections& scan, const EgoSample&) override {
      count_ += static_cast<double>(scan.count);
    }

   private:
    double& count_;
  };
  double all = 0.0, stationary = 0.0;
  static_cast<void>(
      run_drive(spec, [&](const VehicleConfig& vehicle) { return std::make_unique<Counter>(vehicle, spec, all); }));
  RunOptions options;
  options.only_stationary = true;
  static_cast<void>(run_drive(
      spec, [&](const VehicleConfig& vehicle) { return std::make_unique<Counter>(vehicle, spec, stationary); },
      options));
  EXPECT_NEAR(stationary / all, 0.5, 0.03);
}

TEST(Report, ABarThatIsNotANumberFails) {
  const Bar bar{"g", "w", std::nan(""), 0.7, 1.5, "", ""};
  EXPECT_FALSE(bar.passes());
  const Bar good{"g", "w", 1.0, 0.7, 1.5, "", ""};
  EXPECT_TRUE(good.passes());
}

TEST(Report, AFigureForComparisonIsNotJudged) {
  Report report;
  report.at_most("group", "judged", 2.0, 1.0, "s", "");
  report.beside("group", "beside", 2.0, "s", "");
  EXPECT_STREQ(report.bars()[0].verdict(), "FAIL");
  EXPECT_STREQ(report.bars()[1].verdict(), "—");
  EXPECT_EQ(report.bars()[1].limit(), "—");
  std::ostringstream text, json;
  report.print(text);
  EXPECT_NE(text.str().find("\n1 bars, 1 failed\n"), std::string::npos) << text.str();
  report.write_json(json);
  EXPECT_NE(json.str().find("\"low\":null,\"high\":null,\"unit\":\"s\",\"pass\":null"), std::string::npos)
      << json.str();
}

TEST(Statistics, QuantilesOfValuesThatWereNeverReached) {
  const double never = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_DOUBLE_EQ(median({1.0, 2.0, never}), 2.0);
  EXPECT_TRUE(std::isinf(median({1.0, never, never})));
  EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace boresight::bench
