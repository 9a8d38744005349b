// A short run of the set-up of Burza's tables: it must reproduce the published figures. The benchmark has the whole
// table, with more seeds and the methods that need an hour of driving.
#include <gtest/gtest.h>

#include "services/alignment_estimator/core/published/published.hpp"
#include "services/alignment_estimator/core/published/published_method.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/simulator/alignment/drive.hpp"

namespace boresight::alignment::published {
namespace {

struct Outcome {
  std::array<int, 4> scans_to_95_percent{};        // of the slowest radar; 0: never
  Eigen::Vector4d bias = Eigen::Vector4d::Zero();  // mean over radars and the last fifth; rad
  double rmse_mps = 0.0;                           // of the last fifth
};

Outcome run(Kind kind, double duration_s) {
  simulator::AlignmentSpec spec = simulator::published_setup();
  spec.duration_s = duration_s;
  simulator::AlignmentDrive drive(spec);
  const VehicleConfig vehicle = drive.vehicle();
  const auto method = make_published(kind, vehicle, as_published());
  const auto scan = std::make_unique<ScanDetections>();
  std::vector<double> predicted(kMaxDetections);
  std::vector<std::array<int, 4>> first(vehicle.radars.size());
  std::vector<int> scans(vehicle.radars.size());
  std::vector<Eigen::Vector4d> sum(vehicle.radars.size(), Eigen::Vector4d::Zero());
  double counted = 0.0, squares = 0.0, residuals = 0.0;
  EgoHistory ego;
  simulator::AlignmentEvent event;
  while (drive.next(event)) {
    if (event.ego != nullptr) {
      ego.add(*event.ego);
      continue;
    }
    const std::size_t r = event.radar;
    take_detections(*event.scan, vehicle.radars[r], *scan);
    const EgoSample motion = ego.at(event.scan->header.measurement_time_ns);
    method->process(r, *scan, motion);
    ++scans[r];
    const simulator::Misalignment& actual = spec.radars[r].truth;
    const Eigen::Vector4d truth(spec.speed_scale, actual.yaw_rad, actual.pitch_rad, actual.roll_rad);
    const Eigen::Vector4d start(1.0, 0.0, 0.0, 0.0);
    const Eigen::Vector4d error = dynamic_cast<const PublishedMethod&>(*method).parameters(r) - truth;
    for (int p = 0; p < 4; ++p) {
      int& at = first[r][static_cast<std::size_t>(p)];
      if (at == 0 && std::abs(error(p)) <= 0.05 * std::abs(start(p) - truth(p))) at = scans[r];
    }
    if (event.time_s < 0.8 * duration_s) continue;
    sum[r] += error;
    counted += r == 0 ? 1.0 : 0.0;
    method->predict(r, *scan, motion, predicted);
    for (std::size_t i = 0; i < scan->count; ++i) {
      const double residual = scan->range_rate_mps[i] - predicted[i];
      squares += residual * residual;
      residuals += 1.0;
    }
  }
  Outcome outcome;
  outcome.rmse_mps = std::sqrt(squares / residuals);
  for (std::size_t r = 0; r < first.size(); ++r) {
    outcome.bias += sum[r].cwiseAbs() / counted / static_cast<double>(first.size());
    for (std::size_t p = 0; p < 4; ++p) {
      int& slowest = outcome.scans_to_95_percent[p];
      slowest = r > 0 && (slowest == 0 || first[r][p] == 0) ? 0 : std::max(slowest, first[r][p]);
    }
  }
  return outcome;
}

TEST(Reproduction, NelderMead) {
  // Published: 6971 iterations; bias 2.99e-5, 0.0106°, 0.1380°, 0.0912°; RMSE 0.0272 m/s.
  const Outcome outcome = run(Kind::kNelderMead, 500.0);
  for (const int scans : outcome.scans_to_95_percent) {
    EXPECT_GT(scans, 0);
    EXPECT_LT(scans, 9'500);
  }
  EXPECT_LT(outcome.bias(0), 1.5e-4);
  EXPECT_LT(outcome.bias(1), 0.0106 * kRadiansPerDegree);
  EXPECT_LT(outcome.bias(2), 0.1380 * kRadiansPerDegree);
  EXPECT_LT(outcome.bias(3), 0.0912 * kRadiansPerDegree);
  EXPECT_NEAR(outcome.rmse_mps, 0.0272, 0.002);
}

TEST(Reproduction, LeastSquares) {
  const Outcome outcome = run(Kind::kLeastSquares, 300.0);
  EXPECT_NEAR(outcome.scans_to_95_percent[0], 3'000, 300);  // ln 20 / η of k_v
  EXPECT_NEAR(outcome.scans_to_95_percent[1], 370, 100);
  EXPECT_LT(outcome.bias(0), 2e-4);
  EXPECT_LT(outcome.bias(2), 0.06 * kRadiansPerDegree);
  EXPECT_NEAR(outcome.rmse_mps, 0.0272, 0.002);
}

TEST(Reproduction, TheReferenceIsBiasedByPitchAndRoll) {
  // k_v absorbs the mean of cos β: 1 − (1 + 1 + 4 + 4)/4·(1°)²/2 = −3.8e-4.
  const Outcome outcome = run(Kind::kAzimuth1d, 400.0);
  EXPECT_NEAR(outcome.bias(0), 3.1e-4, 1e-4);
  EXPECT_NEAR(outcome.bias(1) / kRadiansPerDegree, 0.046, 0.015);
  EXPECT_NEAR(outcome.rmse_mps, 0.0287, 0.002);
}

}  // namespace
}  // namespace boresight::alignment::published
