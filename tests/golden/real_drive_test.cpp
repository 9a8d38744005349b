// The comma2k19 drive: the estimate of k_v depends on the range rates of stationary detections only.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "tests/golden/support/decoded.hpp"

namespace boresight::golden {
namespace {

namespace fs = std::filesystem;
const fs::path kRealDriveRecording = shared_data() / "comma2k19_seg40/radar_ego.candump.log";

struct Result {
  double speed_scale;
  double speed_scale_std;
  double yaw_rad;
  double yaw_std_rad;
};

/// The estimate at the end of the drive with a speed signal multiplied by `factor`.
Result estimate(const Decoding& drive, const VehicleConfig& car, const alignment::Config& config, double factor = 1.0) {
  alignment::Estimator estimator(car, config);
  for (const Decoded& message : drive.messages) {
    if (message.ego) {
      EgoMotion motion = *message.ego;
      motion.speed_mps *= static_cast<float>(factor);
      estimator.add_ego_motion(motion);
    } else {
      static_cast<void>(estimator.add_scan(*message.scan));
    }
  }
  AlignmentEstimate found{};
  EXPECT_TRUE(estimator.write(1, found));
  return {found.speed_scale, std::sqrt(found.covariance[0]), found.alignment_yaw_rad, std::sqrt(found.covariance[5])};
}

class RealDrive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!fs::exists(kRealDriveRecording)) return;
    car_ = vehicle("comma2k19");
    drive_ = decode(car_, kRealDriveRecording);
  }
  static void TearDownTestSuite() { drive_ = {}; }
  void SetUp() override { REQUIRE_RECORDING(kRealDriveRecording); }
  static inline VehicleConfig car_;
  static inline Decoding drive_;
};

TEST_F(RealDrive, AWrongSpeedSignalIsFoundWhateverItsError) {
  // True speed is k_v times the signal, so a signal scaled by a factor must give k_v divided by the factor. A gate that
  // pulls k_v to its start value of 1 would fail here.
  const Result as_it_is = estimate(drive_, car_, {});
  for (const double factor : {0.96, 0.98, 1.02, 1.04}) {
    const Result scaled = estimate(drive_, car_, {}, factor);
    EXPECT_NEAR(scaled.speed_scale * factor, as_it_is.speed_scale, as_it_is.speed_scale_std) << factor;
    EXPECT_NEAR(scaled.yaw_rad, as_it_is.yaw_rad, 1.5 * as_it_is.yaw_std_rad) << factor;
  }
}

TEST_F(RealDrive, NeitherPriorNorStartDecide) {
  const Result as_it_is = estimate(drive_, car_, {});
  const auto changed = [&](const std::function<void(alignment::Config&)>& change) {
    alignment::Config config;
    change(config);
    return estimate(drive_, car_, config).speed_scale;
  };
  EXPECT_NEAR(changed([](auto& c) { c.windows.priors.speed_scale_std = 0.01; }), as_it_is.speed_scale, 5e-4);
  EXPECT_NEAR(changed([](auto& c) { c.windows.priors.speed_scale_std = 0.1; }), as_it_is.speed_scale, 5e-4);
  EXPECT_NEAR(changed([](auto& c) { c.filter.start_scale_mps = 1.0; }), as_it_is.speed_scale, 5e-4);
  EXPECT_NEAR(changed([](auto& c) { c.filter.start_scale_mps = 4.0; }), as_it_is.speed_scale, 5e-4);
  // The gate matters, since the accepted residuals are not Gaussian: k_v changes by up to 1.5 per mille from 2 to 8
  // stds.
  EXPECT_NEAR(changed([](auto& c) { c.filter.outlier_gate_sigma = 2.0; }), as_it_is.speed_scale, 1.5e-3);
  EXPECT_NEAR(changed([](auto& c) { c.filter.outlier_gate_sigma = 8.0; }), as_it_is.speed_scale, 1.5e-3);
}

TEST_F(RealDrive, SpeedScaleIsTheMedianOfStationaryDetections) {
  // Reference without filter, noise model or weights: the median of range rate over signalled speed, of all within 5 %.
  EgoHistory history;
  std::vector<double> ratios;
  const double yaw_rad = estimate(drive_, car_, {}).yaw_rad;
  for (const Decoded& message : drive_.messages) {
    if (message.ego) {
      history.add(*message.ego);
      continue;
    }
    const RadarScan& scan = *message.scan;
    const EgoSample ego = history.at(scan.header.measurement_time_ns);
    if (!ego.valid || ego.stale || ego.speed_mps < 5.0) continue;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      const double ratio =
          -static_cast<double>(scan.range_rate_mps[i]) / (ego.speed_mps * std::cos(scan.azimuth_rad[i] + yaw_rad));
      if (std::abs(ratio - 1.0) < 0.05) ratios.push_back(ratio);
    }
  }
  ASSERT_GT(ratios.size(), 1000u);
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  const Result found = estimate(drive_, car_, {});
  // The estimator also models unknown elevations, and its σ includes their effect.
  std::printf("median %.4f of %zu, estimator %.4f ± %.4f\n", *middle, ratios.size(), found.speed_scale,
              found.speed_scale_std);
  EXPECT_NEAR(found.speed_scale, *middle, 2.0 * found.speed_scale_std);
}

}  // namespace
}  // namespace boresight::golden
