// Each effect that makes false detections has the statistic that its profile states.
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "services/simulator/radar/returns/azimuth_ambiguity.hpp"
#include "services/simulator/radar/returns/doppler_ambiguity.hpp"
#include "services/simulator/radar/returns/false_movers.hpp"
#include "services/simulator/radar/returns/side_lobes.hpp"
#include "services/simulator/radar/returns/validity.hpp"
#include "tests/unit/simulator/returns/statistics.hpp"

namespace boresight::simulator::returns_test {
namespace {

const FieldOfView kView{-1.22, 1.22, -0.3, 0.3, 100.0};

/// A radar that looks ahead and drives with 15 m/s.
radar::Viewpoint driving() {
  return {Eigen::Vector3d(0.0, 0.0, 0.6), Eigen::Vector3d(15.0, 0.0, 0.0), Eigen::Matrix3d::Identity()};
}

radar::Echo echo_of(Provenance provenance, double range_m, double azimuth_rad, double rate_mps, double rcs_dbsm,
                    std::uint64_t key) {
  radar::Echo e{};
  e.range_m = range_m;
  e.azimuth_rad = azimuth_rad;
  e.range_rate_mps = rate_mps;
  radar::set_rcs(e, rcs_dbsm, kView);
  e.truth.provenance = provenance;
  e.truth.object_id = provenance == Provenance::kMoving ? 5 : 0;
  e.key = key;
  return e;
}

TEST(FalseMovers, TheRateIsLogNormalAndChangesWithinSeconds) {
  const radar::FalseMovers movers(series().false_mover);
  std::vector<double> rates, logarithms;
  for (int i = 0; i < 20'000; ++i) {
    rates.push_back(movers.rate(0.5 * i, at_cycle(0)));
    logarithms.push_back(std::log(rates.back()));
  }
  const radar::FalseMoverSpec& spec = series().false_mover;
  EXPECT_NEAR(quantile(rates, 0.5), spec.median_per_scan, 0.1 * spec.median_per_scan);
  EXPECT_NEAR(quantile(rates, 0.9), spec.p90_per_scan, 0.15 * spec.p90_per_scan);
  EXPECT_NEAR(correlation(logarithms, 2), 0.8, 0.03);
  EXPECT_NEAR(correlation(logarithms, 6), 0.51, 0.05);
  EXPECT_NE(rates[10], movers.rate(5.0, at_cycle(0, 2))) << "each radar has its own";
}

TEST(FalseMovers, HaveTheStatedRangesDeviationsAndLengths) {
  const radar::FalseMovers movers(series().false_mover);
  std::vector<double> ranges, deviations;
  std::map<std::uint64_t, int> lengths;
  std::size_t near_zero = 0, scans = 10'000;
  for (std::uint32_t cycle = 0; cycle < scans; ++cycle) {
    std::vector<radar::Echo> echoes;
    movers.add(0.075 * cycle, 0.075, at_cycle(cycle), driving(), 0.0, kView, series().strength, echoes);
    for (const radar::Echo& e : echoes) {
      ++lengths[e.key];
      EXPECT_EQ(e.truth.cause, Cause::kFalseMover);
      EXPECT_EQ(e.truth.provenance, Provenance::kClutter);
      near_zero += std::abs(e.range_rate_mps) < 1.0 ? 1 : 0;
      ranges.push_back(e.range_m);
      deviations.push_back(std::abs(e.range_rate_mps - radar::stationary_rate(driving(), e)));
    }
  }
  const radar::FalseMoverSpec& spec = series().false_mover;
  const double spread = std::log(spec.p90_per_scan / spec.median_per_scan) / radar::kNormal90;
  const double mean_rate = spec.median_per_scan * std::exp(0.5 * spread * spread);
  const double number = static_cast<double>(ranges.size());
  EXPECT_NEAR(number / static_cast<double>(scans),
              (1.0 - spec.lasting_share) * mean_rate + spec.lasting_share * spec.median_per_scan * spec.lasting_scans,
              0.12 * mean_rate);
  EXPECT_NEAR(quantile(ranges, 0.1), 9.0, 1.5);
  EXPECT_NEAR(quantile(ranges, 0.5), 32.0, 2.0);
  EXPECT_NEAR(quantile(ranges, 0.9), 75.0, 2.0);
  EXPECT_GT(static_cast<double>(near_zero) / number, spec.near_zero_share);
  EXPECT_LT(static_cast<double>(near_zero) / number, spec.near_zero_share + 0.15);
  double sum = 0.0;
  for (const double share : spec.deviation_share) sum += share;
  EXPECT_NEAR(share_of(deviations, [](double d) { return d > 10.0 && d < 20.0; }),
              (1.0 - spec.near_zero_share) * spec.deviation_share[3] / sum + 0.8 * spec.near_zero_share, 0.05);
  double single = 0.0, in_long_chains = 0.0;
  for (const auto& [key, length] : lengths) {
    single += length == 1 ? 1.0 : 0.0;
    in_long_chains += length >= 6 ? length : 0.0;
  }
  EXPECT_NEAR(single / static_cast<double>(lengths.size()), 0.92, 0.04);
  // Lengths are geometric: of the detections that last, some six in seven are in chains of six and more scans.
  const double lasting = spec.lasting_share * spec.median_per_scan * spec.lasting_scans;
  EXPECT_NEAR(in_long_chains / number, 6.0 / 7.0 * lasting / ((1.0 - spec.lasting_share) * mean_rate + lasting), 0.05);
}

TEST(FalseMovers, AreFewerWhereTheRadarLooksAbeam) {
  const radar::FalseMovers movers(series().false_mover);
  const auto per_scan = [&](double ego_heading_rad) {
    std::size_t number = 0;
    for (std::uint32_t cycle = 0; cycle < 4000; ++cycle) {
      std::vector<radar::Echo> echoes;
      movers.add(0.075 * cycle, 0.075, at_cycle(cycle), driving(), ego_heading_rad, kView, series().strength, echoes);
      number += echoes.size();
    }
    return static_cast<double>(number) / 4000.0;
  };
  const double ahead = per_scan(0.0), factor = series().false_mover.abeam_factor;
  EXPECT_LT(factor, 0.6);
  EXPECT_NEAR(per_scan(0.5 * M_PI) / ahead, factor, 0.05);
  EXPECT_NEAR(per_scan(M_PI) / ahead, 1.0, 0.05) << "behind is as ahead";
  EXPECT_NEAR(per_scan(0.25 * M_PI) / ahead, 0.5 * (1.0 + factor), 0.05);
}

TEST(DopplerAmbiguity, ShiftsTheStatedSharesAcrossZero) {
  std::size_t moving = 0, stationary = 0, scans = 4000;
  std::map<double, int> widths;
  for (std::uint32_t cycle = 0; cycle < scans; ++cycle) {
    std::vector<radar::Echo> echoes;
    for (std::uint64_t k = 0; k < 20; ++k) echoes.push_back(echo_of(Provenance::kMoving, 30.0, 0.1, -4.0, 3.0, k));
    for (std::uint64_t k = 20; k < 60; ++k) {
      echoes.push_back(echo_of(Provenance::kStationary, 30.0, 0.1, -15.0, 3.0, k));
    }
    echoes.push_back(echo_of(Provenance::kGhostType2, 30.0, 0.1, -15.0, 3.0, 99));
    radar::shift_range_rates(series().doppler_ambiguity, at_cycle(cycle), echoes);
    std::map<double, int> of_scan;
    for (std::size_t i = 0; i < 60; ++i) {
      const radar::Echo& e = echoes[i];
      if (e.truth.cause != Cause::kDopplerAmbiguity) continue;
      const double width = e.range_rate_mps + (i < 20 ? 4.0 : 15.0);
      EXPECT_GE(width, 21.5);
      EXPECT_LE(width, 34.0);
      EXPECT_EQ(e.truth.provenance, i < 20 ? Provenance::kMoving : Provenance::kClutter);
      (i < 20 ? moving : stationary) += 1;
      ++of_scan[std::round(1e6 * width)];
    }
    EXPECT_LE(of_scan.size(), 2u) << "two widths in a scan";
    for (const auto& [width, n] : of_scan) widths[width] += n;
    EXPECT_EQ(echoes.back().range_rate_mps, -15.0);
  }
  EXPECT_NEAR(static_cast<double>(moving) / (20.0 * static_cast<double>(scans)), 0.035, 0.003);
  EXPECT_NEAR(static_cast<double>(stationary) / (40.0 * static_cast<double>(scans)), 0.01, 0.001);
  EXPECT_GT(widths.size(), 1000u) << "drawn anew in each scan";
}

TEST(AzimuthAmbiguity, CopiesStrongStationaryDetectionsAtTheStatedStep) {
  std::vector<double> steps;
  std::size_t copies = 0, of_strong = 0, scans = 4000;
  for (std::uint32_t cycle = 0; cycle < scans; ++cycle) {
    std::vector<radar::Echo> echoes;
    for (std::uint64_t k = 0; k < 50; ++k) {
      const double azimuth = -1.1 + 0.044 * static_cast<double>(k);
      echoes.push_back(echo_of(Provenance::kStationary, 30.0, azimuth, -12.0, k % 2 == 0 ? -20.0 : 10.0, k));
    }
    radar::add_ambiguous_azimuths(series().azimuth_ambiguity, at_cycle(cycle), kView, series().strength, echoes);
    for (std::size_t i = 50; i < echoes.size(); ++i) {
      const radar::Echo& e = echoes[i];
      EXPECT_EQ(e.truth.cause, Cause::kAzimuthAmbiguity);
      EXPECT_EQ(e.range_rate_mps, -12.0);
      EXPECT_LE(std::abs(e.azimuth_rad), kView.azimuth_max_rad);
      double nearest = 9.0;
      for (std::size_t parent = 0; parent < 50; ++parent) {
        const double step = std::abs(std::sin(e.azimuth_rad) - std::sin(echoes[parent].azimuth_rad));
        if (std::abs(step - 0.72) >= std::abs(nearest - 0.72) || radar::key_of(0xA21B, parent) != e.key) continue;
        nearest = step;
        of_strong += parent % 2 == 1 ? 1 : 0;
      }
      steps.push_back(nearest);
      ++copies;
    }
  }
  EXPECT_NEAR(static_cast<double>(copies) / static_cast<double>(scans), 1.3, 0.08);
  EXPECT_NEAR(mean(steps), 0.72, 0.002);
  EXPECT_NEAR(std_of(steps), 0.02, 0.002);
  EXPECT_GT(of_strong, 9 * copies / 10);
}

TEST(SideLobes, HaveTheObjectsRangeRateAndTheStatedStrength) {
  const radar::Echo strongest = echo_of(Provenance::kMoving, 40.0, 0.2, 3.0, 10.0, 1);
  std::vector<double> strength;
  std::size_t number = 0, scans = 20'000;
  for (std::uint32_t cycle = 0; cycle < scans; ++cycle) {
    std::vector<radar::Echo> echoes;
    radar::add_side_lobes(series().side_lobe, strongest, at_cycle(cycle), kView, echoes);
    for (const radar::Echo& e : echoes) {
      EXPECT_EQ(e.range_m, 40.0);
      EXPECT_EQ(e.range_rate_mps, 3.0);
      EXPECT_EQ(e.truth.object_id, 5u);
      EXPECT_EQ(e.truth.provenance, Provenance::kClutter);
      EXPECT_GE(std::abs(e.azimuth_rad - 0.2), 4.0 / 180.0 * M_PI - 1e-9);
      strength.push_back(radar::rcs_of(e, kView) - 10.0);
      ++number;
    }
  }
  EXPECT_NEAR(static_cast<double>(number) / static_cast<double>(scans), 0.25 * (1.0 - 0.14 / 2.44), 0.015);
  EXPECT_NEAR(mean(strength), series().side_lobe.strength_db, 0.8);
  EXPECT_NEAR(std_of(strength), series().side_lobe.strength_std_db, 0.6);
}

TEST(Bursts, LastForSecondsInOneRangeInterval) {
  const radar::BurstSpec& spec = series().burst;
  double seconds = 0.0;
  std::vector<double> counts;
  constexpr double kStep_s = 0.1, kDrive_s = 6000.0;
  for (std::uint32_t cycle = 0; cycle * kStep_s < kDrive_s; ++cycle) {
    std::vector<radar::Echo> echoes;
    radar::add_bursts(spec, cycle * kStep_s, at_cycle(cycle), kView, series().strength, echoes);
    if (echoes.empty()) continue;
    seconds += kStep_s;
    double low = 1e9, high = 0.0, left = -9.0, right = 9.0;
    for (const radar::Echo& e : echoes) {
      EXPECT_EQ(e.truth.cause, Cause::kBurst);
      EXPECT_LT(std::abs(e.range_rate_mps), 2.0);
      low = std::min(low, e.range_m);
      high = std::max(high, e.range_m);
      left = std::max(left, e.azimuth_rad);
      right = std::min(right, e.azimuth_rad);
    }
    counts.push_back(static_cast<double>(echoes.size()));
    if (echoes.size() > 60) continue;  // two at a time
    EXPECT_LE(high - low, spec.depth_m);
    EXPECT_LE(left - right, spec.azimuth_width_rad);
  }
  EXPECT_NEAR(seconds / kDrive_s, 4.0 / 60.0, 0.02);
  EXPECT_NEAR(mean(counts), 35.0, 2.5);
}

TEST(Validity, FlagsPassTheStatedSharesOfRealAndFalse) {
  const radar::ValiditySpec spec = radar_profile("can_cluster").validity;
  std::map<bool, std::vector<double>> valid, unambiguous, existence;
  for (const bool real : {true, false}) {
    for (std::uint64_t key = 0; key < 20'000; ++key) {
      const radar::Verdict v = radar::verdict_on(spec, real, key, at_cycle(3));
      valid[real].push_back((v.flags & detection_flag::kInvalid) == 0 ? 1.0 : 0.0);
      unambiguous[real].push_back((v.flags & detection_flag::kAmbiguous) == 0 ? 1.0 : 0.0);
      existence[real].push_back(v.existence);
    }
  }
  EXPECT_NEAR(mean(valid[true]), 0.47, 0.012);
  EXPECT_NEAR(mean(valid[false]), 0.17, 0.012);
  EXPECT_NEAR(mean(unambiguous[true]), 0.56, 0.012);
  EXPECT_NEAR(mean(unambiguous[false]), 0.18, 0.012);
  std::size_t greater = 0;
  for (std::size_t i = 0; i < 20'000; ++i) greater += existence[true][i] > existence[false][19'999 - i] ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(greater) / 20'000.0, 0.69, 0.015) << "area under the ROC curve";
  EXPECT_EQ(radar::verdict_on({}, false, 1, at_cycle(3)).existence, 1.0);
  EXPECT_EQ(radar::verdict_on({}, false, 1, at_cycle(3)).flags, 0);
}

}  // namespace
}  // namespace boresight::simulator::returns_test
