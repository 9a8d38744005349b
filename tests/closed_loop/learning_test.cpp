// What is learnt on line, with its use and without: the probability of `moving` must never become worse by it.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "services/ghost_filter/weights_file.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/scenario_vehicle.hpp"
#include "tests/closed_loop/chain.hpp"

namespace boresight::closed_loop {
namespace {

struct LearningDrive {
  std::string scenario, profile;
  std::uint64_t seed = 1;
  float stated_factor = 1.0F;  ///< on the range-rate standard deviations that the radars state
};

/// Mean squared error of the probability of `moving`, over all detections that are not rejected.
double brier_score(const LearningDrive& of, bool learns) {
  constexpr double kDuration_s = 20.0, kBegin_s = 5.0;
  simulator::Scenario scenario = simulator::scenario(of.scenario);
  simulator::use_profile(scenario, of.profile);
  const VehicleConfig vehicle = bench::vehicle_of(scenario);
  simulator::Drive drive(scenario, vehicle, of.seed, std::min(kDuration_s, scenario.duration_s));
  corrector::Config corrector;
  if (!learns) corrector.stated_noise.least_scale = corrector.stated_noise.most_scale = 1.0;
  Front front(vehicle, corrector);
  ghosts::Config config;
  config.evidence.weights = ghosts::read_weights(std::filesystem::path(BORESIGHT_SOURCE_DIR) /
                                                 ("config/radar_profiles/" + of.profile + ".toml"));
  Back back(vehicle, ghosts::make_method(config));
  const auto stated = std::make_unique<RadarScan>();
  double sum = 0.0, detections = 0.0;
  while (const simulator::Event* event = drive.next()) {
    simulator::Event seen = *event;
    if (event->scan != nullptr) {
      *stated = *event->scan;
      for (std::size_t i = 0; i < stated->number_of_valid_detections; ++i) {
        stated->range_rate_std_mps[i] *= of.stated_factor;
      }
      seen.scan = stated.get();
    }
    if (!front.take(seen)) continue;
    back.take(*front.corrected);
    if (event->t_s < kBegin_s) continue;
    for (std::size_t i = 0; i < front.corrected->number_of_valid_detections; ++i) {
      if ((front.corrected->detection_flags[i] & corrected_flag::kRejected) != 0) continue;
      const bool is_real = (*event->truth)[i].provenance == Provenance::kMoving;
      const double p = static_cast<double>(back.classified->probability(Provenance::kMoving, i));
      sum += (p - (is_real ? 1.0 : 0.0)) * (p - (is_real ? 1.0 : 0.0));
      detections += 1.0;
    }
  }
  return sum / detections;
}

class LearningOfTheNoise : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(LearningOfTheNoise, IsNeverWorseThanTheStatedNoise) {
  const auto [scenario, profile] = GetParam();
  double honest_on = 0.0, honest_off = 0.0, wide_on = 0.0, wide_off = 0.0;
  for (const std::uint64_t seed : {11U, 12U}) {
    const LearningDrive honest{scenario, profile, seed, 1.0F}, wide{scenario, profile, seed, 3.0F};
    honest_on += brier_score(honest, true);
    honest_off += brier_score(honest, false);
    wide_on += brier_score(wide, true);
    wide_off += brier_score(wide, false);
  }
  std::printf(
      "%s, %s: Brier score with learning / without: honest radar %.5f / %.5f, 3 x the noise stated %.5f / %.5f\n",
      scenario, profile, honest_on / 2.0, honest_off / 2.0, wide_on / 2.0, wide_off / 2.0);
  // The paired difference of two drives scatters by some percent.
  EXPECT_LT(honest_on, 1.06 * honest_off);
  EXPECT_LT(wide_on, wide_off);
}

INSTANTIATE_TEST_SUITE_P(Drives, LearningOfTheNoise,
                         testing::Combine(testing::Values("junction", "city_canyon"),
                                          testing::Values("series_77ghz", "can_cluster")));

}  // namespace
}  // namespace boresight::closed_loop
