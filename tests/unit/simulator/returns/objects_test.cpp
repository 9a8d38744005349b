// Each effect on objects has the statistic that its profile states.
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "services/simulator/radar/returns/micro_doppler.hpp"
#include "services/simulator/radar/returns/object_count.hpp"
#include "services/simulator/radar/returns/presence.hpp"
#include "services/simulator/radar/returns/spots.hpp"
#include "services/simulator/radar/returns/strength.hpp"
#include "tests/unit/simulator/returns/statistics.hpp"

namespace boresight::simulator::returns_test {
namespace {

using radar::ObjectClass;

constexpr std::uint32_t kObjects = 200, kScans = 200;

TEST(Held, KeepsTheDistributionAndHasTheStatedCorrelation) {
  std::vector<double> values;
  for (std::uint32_t cycle = 0; cycle < 40'000; ++cycle) {
    values.push_back(at_cycle(cycle).held("test", 3, 0.7).gaussian());
  }
  EXPECT_NEAR(mean(values), 0.0, 0.04);
  EXPECT_NEAR(std_of(values), 1.0, 0.03);
  EXPECT_NEAR(correlation(values, 1), 0.7, 0.02);
  EXPECT_NEAR(correlation(values, 3), 0.343, 0.03);
  EXPECT_EQ(at_cycle(17).held("test", 3, 0.7).gaussian(), values[17]) << "whatever was drawn before";
}

struct Misses {
  double none, after_none;
};
Misses misses(ObjectClass c, double range_m) {
  double none = 0.0, after = 0.0;
  for (std::uint32_t object = 1; object <= kObjects; ++object) {
    bool before = true;
    for (std::uint32_t cycle = 0; cycle < kScans; ++cycle) {
      const bool present = radar::is_present(series().presence, c, range_m, object, at_cycle(cycle));
      none += present ? 0.0 : 1.0;
      after += !present && !before ? 1.0 : 0.0;
      before = present;
    }
  }
  return {none / (kObjects * kScans), after / none};
}

TEST(Presence, MissesAreAsFrequentAndAsLongAsStated) {
  const Misses car = misses(ObjectClass::kCar, 72.5), truck = misses(ObjectClass::kTruck, 25.0),
               person = misses(ObjectClass::kPedestrian, 25.0);
  EXPECT_NEAR(car.none, 0.36, 0.015);
  EXPECT_NEAR(car.after_none, 0.67, 0.015);
  EXPECT_NEAR(truck.none, series().presence.truck[2], 0.02);
  EXPECT_NEAR(truck.after_none, 0.76, 0.02);
  EXPECT_NEAR(person.none, 0.44, 0.025);
  EXPECT_NEAR(person.after_none, 0.80, 0.015);
}

TEST(Presence, AScanDoesNotDependOnEarlierCalls) {
  std::vector<bool> forward, backward;
  for (std::uint32_t c = 0; c < 50; ++c) {
    forward.push_back(radar::is_present(series().presence, ObjectClass::kCar, 60.0, 1, at_cycle(c)));
    backward.insert(backward.begin(),
                    radar::is_present(series().presence, ObjectClass::kCar, 60.0, 1, at_cycle(49 - c)));
  }
  EXPECT_EQ(forward, backward);
  EXPECT_NE(forward, std::vector<bool>(50, true));
}

TEST(Count, HasTheStatedMeanByClassRangeAndAspect) {
  const auto mean_of = [](ObjectClass c, double range_m, double aspect_rad) {
    std::vector<double> counts;
    for (std::uint32_t cycle = 0; cycle < 20'000; ++cycle) {
      const double m = radar::mean_count(series().count, c, range_m, aspect_rad);
      counts.push_back(radar::count_of(series().count, m, 1 + cycle % 50, at_cycle(cycle)));
    }
    return mean(counts);
  };
  EXPECT_NEAR(mean_of(ObjectClass::kCar, 15.0, 0.0), 3.8 * 0.85, 0.05);
  EXPECT_NEAR(mean_of(ObjectClass::kCar, 15.0, 0.5 * M_PI), 3.8 * 1.7, 0.08);
  EXPECT_NEAR(mean_of(ObjectClass::kCar, 35.0, M_PI), 1.9 * series().count.front_factor, 0.05);
  EXPECT_NEAR(mean_of(ObjectClass::kTruck, 25.0, 0.0), 4.0 * 0.85, 0.06);
  EXPECT_NEAR(mean_of(ObjectClass::kPedestrian, 25.0, 0.5 * M_PI), 1.7, 0.04) << "aspect is a matter of vehicles";
}

TEST(Count, SuccessiveScansCorrelateAndManyAreSeenBesideTheEgoVehicle) {
  std::vector<double> counts;
  const double m = radar::mean_count(series().count, ObjectClass::kCar, 5.0, 0.5 * M_PI);
  for (std::uint32_t cycle = 0; cycle < 20'000; ++cycle) {
    counts.push_back(radar::count_of(series().count, m, 1, at_cycle(cycle)));
  }
  EXPECT_NEAR(correlation(counts, 1), 0.4, 0.03);
  EXPECT_NEAR(correlation(counts, 5), 0.01, 0.03);
  EXPECT_GE(quantile(counts, 1.0), 18.0);
}

Body car_body() {
  Body b{};
  b.id = 4;
  b.kind = BodyKind::kCar;
  b.length_m = 4.5;
  b.width_m = 1.9;
  b.height_m = 1.5;
  return b;
}

TEST(Spots, LieAtTheNearEndAndAreExponentiallyFewBehindIt) {
  // Seen from behind at 40 m.
  const Eigen::Vector2d sensor(-40.0, 0.0);
  std::vector<double> behind, across;
  for (std::uint32_t cycle = 0; cycle < 20'000; ++cycle) {
    const Eigen::Vector3d p = radar::spot_of(series().spots, car_body(), sensor, cycle % 4, at_cycle(cycle));
    behind.push_back(p.x() + 2.25);
    across.push_back(p.y());
  }
  const auto beyond = [&](double m) { return share_of(behind, [m](double b) { return b > m; }); };
  // An exponential distribution that ends with the body.
  const auto stated = [](double m) {
    const double mean_m = series().spots.car_behind_m, end = std::exp(-4.5 / mean_m);
    return (std::exp(-m / mean_m) - end) / (1.0 - end);
  };
  for (const double m : {1.0, 2.0, 3.0}) EXPECT_NEAR(beyond(m), stated(m), 0.03) << m;
  EXPECT_NEAR(std_of(across), 0.55, 0.03);
  EXPECT_LE(quantile(behind, 1.0), 4.5);
}

TEST(Spots, AShareOfTheNearSideIsInsideTheBox) {
  const Eigen::Vector2d sensor(0.0, 30.0);  // abeam, on the left
  Body truck = car_body();
  truck.kind = BodyKind::kTruck;
  truck.length_m = 12.0;
  truck.width_m = 2.5;
  for (const auto& [body, share, tolerance] : {std::tuple(car_body(), 0.15, 0.02), std::tuple(truck, 0.43, 0.03)}) {
    std::vector<double> depth, along;
    for (std::uint32_t cycle = 0; cycle < 20'000; ++cycle) {
      const Eigen::Vector3d p = radar::spot_of(series().spots, body, sensor, cycle % 4, at_cycle(cycle));
      depth.push_back(0.5 * body.width_m - p.y());
      along.push_back(p.x());
    }
    EXPECT_NEAR(share_of(depth, [](double d) { return d > radar::kInside_m; }), share, tolerance);
    EXPECT_GT(std_of(along), 0.2 * body.length_m) << "the whole side is lit";
  }
}

TEST(Spots, LastForTwoToThreeScans) {
  std::vector<double> behind;
  for (std::uint32_t cycle = 0; cycle < 20'000; ++cycle) {
    behind.push_back(radar::spot_of(series().spots, car_body(), {-40.0, 0.0}, 0, at_cycle(cycle)).x());
  }
  EXPECT_NEAR(correlation(behind, 1), 0.67, 0.03);
  EXPECT_NEAR(correlation(behind, 3), 0.30, 0.04);
}

TEST(MicroDoppler, TheStatedShareDeviatesByAspect) {
  const auto shares = [](BodyKind kind, double aspect_rad) {
    std::vector<double> deviations;
    for (std::uint32_t cycle = 0; cycle < 40'000; ++cycle) {
      Stream stream = at_cycle(cycle).once("test");
      deviations.push_back(
          std::abs(radar::micro_doppler(series().micro_doppler, kind, aspect_rad, 8.0, stream).deviation_mps));
    }
    return std::pair(share_of(deviations, [](double d) { return d > 0.5; }),
                     share_of(deviations, [](double d) { return d >= 1.0; }));
  };
  EXPECT_NEAR(shares(BodyKind::kCar, 0.0).first, 0.022, 0.004);
  EXPECT_NEAR(shares(BodyKind::kCar, 0.5 * M_PI).first, series().micro_doppler.side, 0.01);
  EXPECT_LT(shares(BodyKind::kCar, 0.5 * M_PI).second,
            series().micro_doppler.side * series().micro_doppler.large_share);
  EXPECT_NEAR(shares(BodyKind::kTruck, M_PI).first, 0.040, 0.005);
  EXPECT_NEAR(shares(BodyKind::kCyclist, M_PI).first, 0.015, 0.004);
  // Of pedestrians the other detections scatter as well.
  EXPECT_NEAR(shares(BodyKind::kPedestrian, 1.0).first, 0.18 + 0.82 * 0.064, 0.02);
}

TEST(MicroDoppler, LargeDeviationsHaveTheStatedRatioToTheRadialSpeed) {
  std::vector<double> ratios;
  for (std::uint32_t cycle = 0; cycle < 40'000; ++cycle) {
    Stream stream = at_cycle(cycle).once("test");
    const double d =
        radar::micro_doppler(series().micro_doppler, BodyKind::kCar, 0.5 * M_PI, 1000.0, stream).deviation_mps;
    if (std::abs(d) > 1.0) ratios.push_back(d / 1000.0);
  }
  const radar::FiveQuantiles& stated = series().micro_doppler.ratio;
  EXPECT_NEAR(quantile(ratios, 0.05), stated[0], 0.04);
  EXPECT_NEAR(quantile(ratios, 0.25), stated[1], 0.06);
  EXPECT_NEAR(quantile(ratios, 0.95), stated[4], 0.04);
}

TEST(MicroDoppler, IsSmallIfTheBodyHardlyMovesAlongTheLineOfSight) {
  std::vector<double> deviations;
  for (std::uint32_t cycle = 0; cycle < 40'000; ++cycle) {
    Stream stream = at_cycle(cycle).once("test");
    deviations.push_back(
        std::abs(radar::micro_doppler(series().micro_doppler, BodyKind::kCar, 0.5 * M_PI, 0.5, stream).deviation_mps));
  }
  EXPECT_NEAR(share_of(deviations, [](double d) { return d >= 0.5; }), series().micro_doppler.side, 0.01);
  EXPECT_EQ(share_of(deviations, [](double d) { return d > 1.0; }), 0.0);
}

TEST(RangeOfABody, IsThatOfItsNearestPoint) {
  Body truck{};
  truck.length_m = 16.0;
  truck.width_m = 2.5;
  truck.position_m = {30.0, 0.0};
  EXPECT_NEAR(radar::range_of(truck, {10.0, 0.0}), 12.0, 1e-9);
  EXPECT_NEAR(radar::range_of(truck, {30.0, 11.25}), 10.0, 1e-9);
  EXPECT_NEAR(radar::range_of(truck, {41.0, -5.25}), 5.0, 1e-9);
  EXPECT_EQ(radar::range_of(truck, {31.0, 1.0}), 0.0);
  truck.heading_rad = 0.5 * M_PI;
  EXPECT_NEAR(radar::range_of(truck, {10.0, 0.0}), 18.75, 1e-9);
}

TEST(Strength, HasTheStatedQuantilesByRange) {
  const auto of_knot = [](std::size_t k) {
    const radar::StrengthSpec& s = series().strength;
    return std::tuple(s.range_m[k], s.vehicle.low_dbsm[k], s.vehicle.median_dbsm[k], s.vehicle.high_dbsm[k]);
  };
  for (const auto& [range_m, low, median, high] : {of_knot(0), of_knot(2), of_knot(5)}) {
    std::vector<double> rcs;
    for (std::uint32_t object = 1; object <= 300; ++object) {
      for (std::uint32_t cycle = 0; cycle < 2000; cycle += 20) {
        const radar::Draws draws = at_cycle(cycle);
        const radar::CommonStrength common = radar::common_strength(series().strength, object, draws);
        rcs.push_back(radar::object_rcs(series().strength, BodyKind::kCar, range_m, common, object, draws));
      }
    }
    EXPECT_NEAR(quantile(rcs, 0.1), low, 0.4);
    EXPECT_NEAR(quantile(rcs, 0.5), median, 0.4);
    EXPECT_NEAR(quantile(rcs, 0.9), high, 0.4);
  }
}

TEST(Strength, ChangesAmongTheDetectionsOfAScanAndFromScanToScan) {
  // A pedestrian's distribution is symmetric.
  std::vector<double> within, between;
  for (std::uint32_t cycle = 0; cycle < 4000; ++cycle) {
    const radar::Draws draws = at_cycle(cycle), next = at_cycle(cycle + 1);
    const auto rcs = [&](const radar::Draws& d, std::uint64_t part) {
      const radar::CommonStrength common = radar::common_strength(series().strength, 1, d);
      return radar::object_rcs(series().strength, BodyKind::kPedestrian, 20.0, common, part, d);
    };
    within.push_back((rcs(draws, 1) - rcs(draws, 2)) / std::sqrt(2.0));
    double mean_now = 0.0, mean_next = 0.0;
    for (std::uint64_t part = 1; part <= 64; ++part) {
      mean_now += rcs(draws, part) / 64.0;
      mean_next += rcs(next, part) / 64.0;
    }
    between.push_back((mean_next - mean_now) / std::sqrt(2.0));
  }
  EXPECT_NEAR(std_of(within), series().strength.detection_std_db, 0.6);
  EXPECT_NEAR(std_of(between), series().strength.scan_std_db, 0.3);
}

TEST(Strength, OfADetectionLastsForSomeScans) {
  std::vector<double> rcs;
  radar::StrengthSpec spec = series().strength;
  spec.scan_std_db = 0.0;
  spec.person_std_db = spec.detection_std_db;
  for (std::uint32_t cycle = 0; cycle < 20'000; ++cycle) {
    const radar::Draws draws = at_cycle(cycle);
    const radar::CommonStrength common = radar::common_strength(spec, 1, draws);
    rcs.push_back(radar::object_rcs(spec, BodyKind::kPedestrian, 20.0, common, 1, draws));
  }
  EXPECT_GT(spec.detection_correlation, 0.5);
  EXPECT_NEAR(correlation(rcs, 1), spec.detection_correlation, 0.03);
  EXPECT_NEAR(correlation(rcs, 3), std::pow(spec.detection_correlation, 3), 0.05);
}

TEST(Strength, EachRadarHasAnOffsetOfItsOwnPerDrive) {
  std::vector<double> offsets;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    for (std::uint32_t radar = 1; radar <= 4; ++radar) {
      offsets.push_back(radar::radar_offset_db(series().strength, {seed, radar, 0}));
      EXPECT_EQ(offsets.back(), radar::radar_offset_db(series().strength, {seed, radar, 99}));
    }
  }
  EXPECT_NEAR(mean(offsets), 0.0, 1.0);
  EXPECT_NEAR(std_of(offsets), 20.0 / std::sqrt(12.0), 0.4);
  EXPECT_LE(quantile(offsets, 1.0), 10.0);
  radar::StrengthSpec off = series().strength;
  off.on = false;
  EXPECT_EQ(radar::radar_offset_db(off, at_cycle(0)), 0.0);
}

}  // namespace
}  // namespace boresight::simulator::returns_test
