#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "services/simulator/radar/cells.hpp"
#include "services/simulator/radar/detector.hpp"
#include "services/simulator/radar/doppler.hpp"
#include "services/simulator/radar/measurement_noise.hpp"
#include "services/simulator/random.hpp"
#include "tests/unit/simulator/radar/bench_scene.hpp"

namespace boresight::simulator {
namespace {

TEST(Detection, ProbabilityRisesWithPowerFromNothingToItsMaximumAndIsHalfAtTheThreshold) {
  SensitivitySpec spec;
  spec.threshold_db = -40.0;
  spec.max_probability = 0.9;
  double before = 0.0;
  for (double power = -80.0; power < 0.0; power += 0.25) {
    const double p = radar::detection_probability(power, spec);
    ASSERT_GE(p, before);
    before = p;
  }
  EXPECT_NEAR(before, 0.9, 1e-6);
  EXPECT_NEAR(radar::detection_probability(-40.0, spec), 0.45, 0.005);
  EXPECT_LT(radar::detection_probability(-55.0, spec), 1e-4);
}

TEST(Detection, FartherIsSeenLessOften) {
  Bench e;
  e.effects.sensitivity.threshold_db = -40.0;  // a 0 dBsm reflector is detected half of the time at 100 m
  std::vector<int> seen;
  for (const double range : {50.0, 90.0, 100.0, 110.0, 180.0}) {
    e.scene.scatterers = {{{range, 0.0, kHeight_m}, 0.0}};
    int n = 0;
    for (std::uint32_t cycle = 0; cycle < 600; ++cycle) n += static_cast<int>(measure(e, cycle).count());
    seen.push_back(n);
  }
  EXPECT_EQ(seen[0], 600);
  EXPECT_GT(seen[1], seen[2]);
  EXPECT_NEAR(seen[2], 300, 50);
  EXPECT_LT(seen[3], seen[2]);
  EXPECT_EQ(seen[4], 0);
}

TEST(Detection, FluctuationHasTheWantedSpreadAndTheMeanOfOne) {
  EXPECT_NEAR(radar::swerling_order(5.57), 1.0, 0.03);  // Swerling 1
  EXPECT_NEAR(radar::swerling_order(3.49), 2.0, 0.05);  // Swerling 3: √ψ₁(2)·10/ln 10
  for (const double wanted : {1.0, 3.0}) {
    const double order = radar::swerling_order(wanted);
    Stream stream(3, "test");
    constexpr int kSamples = 40'000;
    double linear = 0.0, sum = 0.0, squares = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const double db = radar::fluctuation_db(order, stream.gaussian());
      linear += std::pow(10.0, 0.1 * db);
      sum += db;
      squares += db * db;
    }
    EXPECT_NEAR(linear / kSamples, 1.0, 0.02);
    EXPECT_NEAR(std::sqrt(squares / kSamples - std::pow(sum / kSamples, 2)), wanted, 0.1 * wanted);
  }
}

TEST(Detection, RangeRatesFoldIntoTheUnambiguousInterval) {
  EXPECT_DOUBLE_EQ(radar::fold(12.0, 30.0), 12.0);
  EXPECT_DOUBLE_EQ(radar::fold(35.0, 30.0), -25.0);
  EXPECT_DOUBLE_EQ(radar::fold(-35.0, 30.0), 25.0);
  EXPECT_DOUBLE_EQ(radar::fold(-95.0, 30.0), 25.0);
  EXPECT_DOUBLE_EQ(radar::fold(30.0, 30.0), -30.0);
  EXPECT_DOUBLE_EQ(radar::fold(-95.0, 0.0), -95.0);

  Bench e;
  e.effects.unambiguous_mps = 30.0;
  e.add_body(1, {30.0, 0.0, kHeight_m}, {-25.0, 0.0, 0.0});  // approaches with 45 m/s
  const Measured m = measure(e);
  ASSERT_EQ(m.count(), 1u);
  EXPECT_NEAR(m.scan->range_rate_mps[0], 15.0, 1e-5);
  EXPECT_FLOAT_EQ(m.scan->range_rate_min_mps, -30.0F);
  EXPECT_FLOAT_EQ(m.scan->range_rate_max_mps, 30.0F);
  EXPECT_TRUE(m.scan->has(scan_field::kAmbiguity));
  e.effects.unambiguous_mps = 0.0;
  const Measured resolved = measure(e);
  EXPECT_NEAR(resolved.scan->range_rate_mps[0], -45.0, 1e-5);
  EXPECT_FALSE(resolved.scan->has(scan_field::kAmbiguity));
}

radar::Echo echo(double range_m, double azimuth_rad, double range_rate_mps, double power_db, std::uint64_t key) {
  radar::Echo e{};
  e.range_m = range_m;
  e.azimuth_rad = azimuth_rad;
  e.range_rate_mps = range_rate_mps;
  e.power_db = power_db;
  e.key = key;
  return e;
}

TEST(Detection, UnresolvedEchoesAreOneDetectionAtTheCentroidOfThePowers) {
  Bench e;
  e.effects.resolution = {1.0, 0.05, 0.5};
  // The stronger by 10·log10(3) dB, where range hardly matters: the centroid is a quarter of the way to the weaker.
  const double stronger = 10.0 * std::log10(3.0);
  e.scene.scatterers = {{{50.7, 0.5, kHeight_m}, stronger}, {{51.1, 0.5, kHeight_m}, 0.0}};
  const Measured one = measure(e);
  ASSERT_EQ(one.count(), 1u) << "at any position: there is no grid";
  EXPECT_NEAR(one.scan->range_m[0], 50.8, 0.01);
  e.scene.scatterers[1].position_m.x() = 51.75;  // one cell farther
  EXPECT_EQ(measure(e).count(), 2u);
  e.scene.scatterers[1].position_m = {50.6, 4.5, kHeight_m};  // another azimuth
  EXPECT_EQ(measure(e).count(), 2u);
  e.scene.scatterers.pop_back();
  Body& body = e.add_body(4, {50.9, 0.5, kHeight_m}, {3.0, 0.0, 0.0}, 20.0);  // another range rate
  body.length_m = body.width_m = 0.2;
  EXPECT_EQ(measure(e).count(), 2u);
  e.scene.centres[0].velocity_mps.x() = e.scene.bodies[0].velocity_mps.x() = 0.2;
  const Measured strongest = measure(e);
  ASSERT_EQ(strongest.count(), 1u);
  EXPECT_EQ(strongest.truth[0].provenance, Provenance::kMoving);
}

TEST(Detection, TheStrongestEchoTakesExactlyTheEchoesWithinACell) {
  radar::Cells cells({1.0, 0.05, 0.5});
  // If the middle echo is the strongest, it takes both others. If the first is, it takes the second; the third remains.
  std::vector<radar::Echo> echoes = {echo(10.0, 0.0, 0.0, -20.0, 1), echo(10.8, 0.0, 0.0, 0.0, 2),
                                     echo(11.6, 0.0, 0.0, -20.0, 3)};
  cells.merge(echoes);
  ASSERT_EQ(echoes.size(), 1u);
  EXPECT_EQ(echoes[0].key, 2u);
  EXPECT_NEAR(echoes[0].range_m, 10.8, 1e-9);
  EXPECT_NEAR(echoes[0].power_db, 10.0 * std::log10(1.02), 1e-9);
  echoes = {echo(11.6, 0.0, 0.0, -20.0, 3), echo(10.8, 0.0, 0.0, -10.0, 2), echo(10.0, 0.0, 0.0, 0.0, 1)};
  cells.merge(echoes);
  ASSERT_EQ(echoes.size(), 2u);
  EXPECT_EQ(echoes[0].key, 1u);
  EXPECT_EQ(echoes[1].key, 3u);
}

TEST(Detection, CellsEqualTheComparisonOfAllPairsInAnyOrder) {
  const ResolutionCell cell{2.5, 0.07, 0.5};
  Stream stream(11, "test");
  std::vector<radar::Echo> echoes;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    echoes.push_back(echo(stream.uniform(1.0, 75.0), stream.uniform(-1.3, 1.3), stream.uniform(-15.0, 15.0),
                          stream.uniform(-40.0, 0.0), i));
  }
  // By the definition: in the order of power, each echo takes all remaining echoes within a cell.
  std::vector<radar::Echo> left = echoes;
  std::sort(left.begin(), left.end(), [](const auto& a, const auto& b) { return a.power_db > b.power_db; });
  std::vector<std::uint64_t> wanted;
  while (!left.empty()) {
    const radar::Echo strongest = left.front();
    wanted.push_back(strongest.key);
    std::erase_if(left, [&](const auto& e) { return !radar::resolved(cell, strongest, e); });
  }
  ASSERT_LT(wanted.size(), 980u);
  radar::Cells cells(cell);
  for (int order = 0; order < 3; ++order) {
    std::vector<radar::Echo> merged = echoes;
    if (order == 1) std::reverse(merged.begin(), merged.end());
    if (order == 2) std::rotate(merged.begin(), merged.begin() + 333, merged.end());
    cells.merge(merged);
    ASSERT_EQ(merged.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) ASSERT_EQ(merged[i].key, wanted[i]);
  }
}

TEST(Detection, TheStrongestComeFirstAndTheRestIsCounted) {
  Bench e;
  e.effects.multipath.on = false;
  for (int i = 0; i < 60; ++i) {
    e.scene.scatterers.push_back({{20.0 + 2.0 * i, (i % 7) - 3.0, kHeight_m}, static_cast<double>(i % 11)});
  }
  const Measured all = measure(e);
  ASSERT_EQ(all.count(), 60u);
  e.effects.sensitivity.max_detections = 25;
  const Measured few = measure(e);
  ASSERT_EQ(few.count(), 25u);
  EXPECT_EQ(few.truth.size(), 25u);
  EXPECT_EQ(few.scan->dropped_detections, 35u);
  double before = 1e9;
  for (std::size_t i = 0; i < 60; ++i) {
    const double range = all.scan->range_m[i], azimuth = all.scan->azimuth_rad[i];
    const double power = all.scan->rcs_dbsm[i] - 40.0 * std::log10(range) +
                         2.0 * radar::pattern_db(azimuth, all.scan->elevation_rad[i], e.config.field_of_view);
    ASSERT_LT(power, before + 1.01);  // the stated RCS is rounded
    before = power;
  }
  for (std::size_t i = 0; i < 25; ++i) ASSERT_EQ(few.scan->range_m[i], all.scan->range_m[i]);
  e.effects.sensitivity.max_detections = 5000;
  for (int i = 0; i < 1500; ++i) e.scene.scatterers.push_back({{20.0 + 0.1 * i, 10.0, kHeight_m}, 0.0});
  const Measured full = measure(e);
  EXPECT_EQ(full.count(), kMaxDetections);
  EXPECT_EQ(full.scan->dropped_detections, 1560u - kMaxDetections);
}

TEST(Detection, NoiseGrowsOffBoresightAndForWeakEchoesAndIsTheStatedOne) {
  const SensorNoise nominal;
  const SensorNoise good = radar::noise_of(nominal, 0.0, 0.0, 10.0), aside = radar::noise_of(nominal, 1.0, 0.0, 10.0),
                    weak = radar::noise_of(nominal, 0.0, 0.0, 5.0);
  EXPECT_DOUBLE_EQ(good.azimuth_std_rad, nominal.azimuth_std_rad);
  EXPECT_GT(aside.azimuth_std_rad, 1.5 * good.azimuth_std_rad);
  EXPECT_GT(aside.range_rate_std_mps, good.range_rate_std_mps);
  EXPECT_GT(weak.range_rate_std_mps, 1.5 * good.range_rate_std_mps);
  EXPECT_GT(weak.elevation_std_rad, 1.5 * good.elevation_std_rad);
  EXPECT_GT(weak.range_std_m, 1.5 * good.range_std_m);

  Bench e;
  e.effects.noise = true;
  e.effects.sensitivity.rcs_fluctuation_db = 0.0;
  e.effects.sensitivity.threshold_db = -60.0;
  const Eigen::Vector3d direction = geometry::direction(0.9, 0.1);
  e.scene.scatterers = {{Eigen::Vector3d(0.0, 0.0, kHeight_m) + 60.0 * direction, 10.0}};
  std::array<double, 4> squares{};
  constexpr std::uint32_t kScans = 2000;
  for (std::uint32_t cycle = 0; cycle < kScans; ++cycle) {
    const Measured m = measure(e, cycle);
    ASSERT_EQ(m.count(), 1u);
    const RadarScan& s = *m.scan;
    squares[0] += std::pow((s.range_m[0] - 60.0) / s.range_std_m[0], 2);
    squares[1] += std::pow((s.azimuth_rad[0] - 0.9) / s.azimuth_std_rad[0], 2);
    squares[2] += std::pow((s.elevation_rad[0] - 0.1) / s.elevation_std_rad[0], 2);
    squares[3] += std::pow((s.range_rate_mps[0] + 20.0 * direction.x()) / s.range_rate_std_mps[0], 2);
  }
  for (const double sum : squares) EXPECT_NEAR(sum / kScans, 1.0, 0.15);
}

}  // namespace
}  // namespace boresight::simulator
