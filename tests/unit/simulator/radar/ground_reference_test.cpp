// The elevation bias by the ground reflection agrees with the measurement of a phase interferometer in the field of two
// spherical waves.
#include <complex>

#include <gtest/gtest.h>

#include "services/simulator/radar/ground.hpp"
#include "tests/unit/simulator/radar/bench_scene.hpp"

namespace boresight::simulator {
namespace {

/// The field above the sensor's place: the direct wave, and the wave from the road with a phase shift of π and a loss.
std::complex<double> field(double distance_m, double target_m, double at_m, double reflection) {
  const double k = 2.0 * M_PI / radar::kWavelength_m;
  const double direct = std::hypot(distance_m, target_m - at_m), ground = std::hypot(distance_m, target_m + at_m);
  return std::polar(1.0 / direct, k * direct) - reflection * std::polar(1.0 / ground, k * ground);
}

TEST(GroundReference, ElevationIsWhatTwoNeighbouringElementsMeasure) {
  constexpr double kApart_m = 1e-7;  // far less than a wavelength: the phase's slope
  const double k = 2.0 * M_PI / radar::kWavelength_m;
  double most = 0.0;
  for (double distance = 20.0; distance < 90.0; distance += 0.0371) {
    for (const double target : {0.3, 0.7, 1.4}) {
      const double reflection =
          radar::ground_reflection((target + kHeight_m) / std::hypot(distance, target + kHeight_m));
      const auto low = field(distance, target, kHeight_m - kApart_m, reflection),
                 high = field(distance, target, kHeight_m + kApart_m, reflection);
      // A wave from above arrives at the upper element first.
      const double apparent = std::asin(-std::arg(high / low) / (2.0 * k * kApart_m));
      const radar::GroundEffect effect = radar::two_rays(distance, kHeight_m, target);
      // The model takes the mean of angles, the interferometer that of sines; the bias is up to 50 times as large.
      ASSERT_NEAR(effect.elevation_rad, apparent, 2e-4) << distance << " " << target;
      const double direct = std::hypot(distance, target - kHeight_m);
      ASSERT_NEAR(effect.gain_db,
                  10.0 * std::log10(std::norm(field(distance, target, kHeight_m, reflection)) * direct * direct), 1e-3);
      most = std::max(most, std::abs(effect.elevation_rad - std::atan2(target - kHeight_m, distance)));
    }
  }
  EXPECT_GT(most, 0.01);
}

TEST(GroundReference, TheScanHasTheBiasInElevationOnly) {
  double squares = 0.0;
  int compared = 0;
  for (double distance = 20.0; distance < 60.0; distance += 0.37) {
    Bench e;
    e.scene.scatterers = {{{distance, 1.0, 1.1}, 5.0}};
    const Measured without = measure(e);
    e.effects.multipath.ground_bounce = true;
    const Measured with = measure(e);
    ASSERT_EQ(with.count(), 1u);
    const double flat = std::hypot(distance, 1.0);
    ASSERT_NEAR(without.scan->elevation_rad[0], std::atan2(0.5, flat), 1e-6);
    ASSERT_NEAR(with.scan->elevation_rad[0], radar::two_rays(flat, kHeight_m, 1.1).elevation_rad, 1e-6);
    ASSERT_EQ(with.scan->range_m[0], without.scan->range_m[0]);
    ASSERT_EQ(with.scan->range_rate_mps[0], without.scan->range_rate_mps[0]);
    ASSERT_NEAR(with.scan->azimuth_rad[0], without.scan->azimuth_rad[0], 1e-6);
    squares += std::pow(with.scan->elevation_rad[0] - without.scan->elevation_rad[0], 2);
    ++compared;
  }
  EXPECT_GT(std::sqrt(squares / compared), 0.003) << "elevation is biased: " << compared;
}

}  // namespace
}  // namespace boresight::simulator
