// The published set-up gives the residuals of Burza 2025. Comparisons with its tables rest on this.
#include <cmath>

#include "services/simulator/alignment/drive.hpp"

namespace boresight::simulator {
namespace {

/// RMSE of the stationary detections' range rates against the planar model (10)–(12) with each radar's (α, β, γ).
double planar_rmse(const AlignmentSpec& spec, double speed_scale, bool at_truth) {
  AlignmentDrive drive(spec);
  AlignmentEvent event;
  double speed = 0.0, yaw_rate = 0.0, sum = 0.0, n = 0.0;
  while (drive.next(event)) {
    if (event.ego != nullptr) {
      speed = event.ego->speed_mps;
      yaw_rate = event.ego->yaw_rate_radps;
      continue;
    }
    const AlignmentRadar& radar = spec.radars[event.radar];
    const Misalignment m = at_truth ? radar.truth : Misalignment{};
    const auto& p = radar.config.mounting_pose.position_m;
    const double c = std::cos(m.roll_rad), s = std::sin(m.roll_rad);
    for (std::size_t i = 0; i < event.truth->size(); ++i) {
      if (!(*event.truth)[i].stationary) continue;
      const double azimuth = event.scan->azimuth_rad[i], elevation = event.scan->elevation_rad[i];
      const double a = radar.config.mounting_pose.yaw_rad + m.yaw_rad + azimuth * c - elevation * s;      // (10)
      const double b = radar.config.mounting_pose.pitch_rad + m.pitch_rad + elevation * c + azimuth * s;  // (11)
      const double expected = -(speed_scale * speed - yaw_rate * p[1]) * std::cos(a) * std::cos(b) -
                              yaw_rate * p[0] * std::sin(a) * std::cos(b);  // (12)
      sum += std::pow(expected - event.scan->range_rate_mps[i], 2);
      n += 1.0;
    }
  }
  return std::sqrt(sum / n);
}

TEST(PublishedSetup, ResidualsAreThoseOfTheTable) {
  double uncorrected = 0.0, at_truth = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    AlignmentSpec spec = published_setup();
    spec.seed = seed;
    spec.duration_s = 90.0;
    const double raw = planar_rmse(spec, 1.0, false), right = planar_rmse(spec, spec.speed_scale, true);
    uncorrected += 0.25 * raw;
    at_truth += 0.25 * right;
  }
  EXPECT_NEAR(uncorrected, 0.2045, 0.02);
  EXPECT_NEAR(at_truth, 0.0272, 0.001);
}

}  // namespace
}  // namespace boresight::simulator
