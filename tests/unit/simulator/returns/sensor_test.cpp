// The statistics of a profile within the sensor: each effect can be switched off alone, and changes no draw of another.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/simulator/radar/returns/place.hpp"
#include "tests/unit/simulator/radar/bench_scene.hpp"
#include "tests/unit/simulator/returns/statistics.hpp"

namespace boresight::simulator::returns_test {
namespace {

/// Traffic between rails, with reflectors beside the road, measured by a radar with the profile of a series radar.
struct Street : Bench {
  Street() {
    effects = RadarEffects{};
    effects.clutter_per_scan = 0.0;
    effects.sensitivity.max_detections = 1024;
    effects.profile = series();
    effects.profile.burst.every_s = 2.0;
    effects.profile.validity = radar_profile("can_cluster").validity;
    config.field_of_view = {-1.2, 1.2, -0.3, 0.3, 100.0};
    config.cycle_time_s = 0.075;
    ego_body = {-5.0, 0.3, 0.9, 0.15, 1.5};
    Stream stream(1, "street");
    for (int i = 0; i < 300; ++i) {
      scene.scatterers.push_back({{stream.uniform(-50.0, 120.0), stream.uniform(8.0, 40.0) * (i % 2 == 0 ? 1.0 : -1.0),
                                   stream.uniform(0.2, 2.0)},
                                  stream.uniform(-5.0, 15.0),
                                  {Origin::Kind::kScatter, 0}});
    }
    for (const double y : {-7.0, 7.0}) add_rail({-100.0, y}, {150.0, y});
    for (std::uint32_t id = 1; id <= 8; ++id) {
      add_body(id, {10.0 * id, id % 2 == 0 ? 3.5 : -3.5, kHeight_m}, {12.0 + id, 0.0, 0.0});
    }
  }
};

struct Row {
  std::uint32_t cycle;
  float range, azimuth, rate, rcs, existence;
  std::uint16_t flags;
  Provenance provenance;
  Cause cause;
  std::uint32_t object;
  auto operator<=>(const Row&) const = default;
};

constexpr std::uint32_t kCycles = 40;

std::vector<Row> rows_of(Street street) {
  std::vector<Row> rows;
  RadarSensor sensor(street.config, street.effects, street.ego_body, street.seed);
  for (std::uint32_t cycle = 0; cycle < kCycles; ++cycle) {
    street.scene.t_s = street.config.cycle_time_s * cycle;
    Measured m;
    sensor.measure(street.scene, cycle, *m.scan, m.truth);
    for (std::size_t i = 0; i < m.count(); ++i) {
      rows.push_back({cycle, m.scan->range_m[i], m.scan->azimuth_rad[i], m.scan->range_rate_mps[i], m.scan->rcs_dbsm[i],
                      m.scan->existence_probability[i], m.scan->detection_flags[i], m.truth[i].provenance,
                      m.truth[i].cause, m.truth[i].object_id});
    }
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::vector<Row> rows_with(const std::function<void(radar::Profile&)>& change) {
  Street street;
  change(street.effects.profile);
  return rows_of(street);
}

std::vector<Row> only(std::vector<Row> rows, const std::function<bool(const Row&)>& wanted) {
  std::erase_if(rows, [&](const Row& r) { return !wanted(r); });
  return rows;
}

/// The rows without some of their values.
std::vector<Row> without(std::vector<Row> rows, const std::function<void(Row&)>& erase) {
  for (Row& row : rows) erase(row);
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// The switch of each effect.
std::map<std::string, std::function<bool&(radar::Profile&)>> switches() {
  return {{"presence", [](radar::Profile& p) -> bool& { return p.presence.on; }},
          {"count", [](radar::Profile& p) -> bool& { return p.count.on; }},
          {"spots", [](radar::Profile& p) -> bool& { return p.spots.on; }},
          {"micro_doppler", [](radar::Profile& p) -> bool& { return p.micro_doppler.on; }},
          {"strength", [](radar::Profile& p) -> bool& { return p.strength.on; }},
          {"mirror", [](radar::Profile& p) -> bool& { return p.mirror.on; }},
          {"false_mover", [](radar::Profile& p) -> bool& { return p.false_mover.on; }},
          {"doppler_ambiguity", [](radar::Profile& p) -> bool& { return p.doppler_ambiguity.on; }},
          {"azimuth_ambiguity", [](radar::Profile& p) -> bool& { return p.azimuth_ambiguity.on; }},
          {"side_lobe", [](radar::Profile& p) -> bool& { return p.side_lobe.on; }},
          {"burst", [](radar::Profile& p) -> bool& { return p.burst.on; }},
          {"stationary_world", [](radar::Profile& p) -> bool& { return p.stationary_world.on; }},
          {"validity", [](radar::Profile& p) -> bool& { return p.validity.on; }}};
}

TEST(ProfileInSensor, WithEveryEffectOffTheNumbersChangeNothing) {
  const std::vector<Row> off = rows_with([](radar::Profile& p) {
    for (const auto& [name, on] : switches()) on(p) = false;
  });
  EXPECT_GT(off.size(), 1000u);
  EXPECT_EQ(off, rows_with([](radar::Profile& p) { p = radar::Profile{}; }));
}

TEST(ProfileInSensor, EachEffectAloneChangesTheScan) {
  const std::vector<Row> none = rows_with([](radar::Profile& p) { p = radar::Profile{}; });
  for (const auto& [name, on] : switches()) {
    const std::vector<Row> alone = rows_with([&, &on = on](radar::Profile& p) {
      for (const auto& [other, other_on] : switches()) other_on(p) = false;
      on(p) = true;
    });
    // Places are those of the detections that `count` draws.
    if (name == "spots") {
      EXPECT_EQ(alone, none);
    } else {
      EXPECT_NE(alone, none) << name;
    }
  }
}

TEST(ProfileInSensor, AddedFalseDetectionsChangeNoOther) {
  const std::vector<Row> all = rows_with([](radar::Profile&) {});
  const std::map<std::string, Cause> added = {{"false_mover", Cause::kFalseMover},
                                              {"azimuth_ambiguity", Cause::kAzimuthAmbiguity},
                                              {"side_lobe", Cause::kSideLobe},
                                              {"burst", Cause::kBurst}};
  for (const auto& [name, cause] : added) {
    const std::vector<Row> fewer = rows_with([&, &n = name](radar::Profile& p) { switches().at(n)(p) = false; });
    EXPECT_LT(fewer.size(), all.size()) << name;
    EXPECT_EQ(fewer, only(all, [&, &c = cause](const Row& r) { return r.cause != c; })) << name;
  }
}

TEST(ProfileInSensor, AnEffectChangesOnlyItsOwnQuantity) {
  const std::vector<Row> all = rows_with([](radar::Profile&) {});
  const auto off = [](const std::string& name) {
    return rows_with([&](radar::Profile& p) { switches().at(name)(p) = false; });
  };
  const auto verdicts = [](Row& r) { r.existence = 1.0F, r.flags = 0; };
  EXPECT_EQ(without(off("validity"), verdicts), without(all, verdicts));
  // The direct echoes of objects and reflectors keep place and strength if range rates are resolved rightly.
  const auto place = [](Row& r) {
    r.rate = 0.0F, r.existence = 1.0F, r.flags = 0, r.cause = Cause::kNone, r.provenance = Provenance::kUnknown;
  };
  const auto moving = [](const Row& r) { return r.provenance == Provenance::kMoving; };
  EXPECT_EQ(without(only(off("doppler_ambiguity"), moving), place), without(only(all, moving), place));
  EXPECT_EQ(without(only(off("micro_doppler"), moving), place), without(only(all, moving), place));
  EXPECT_EQ(only(off("stationary_world"), moving), only(all, moving));
  const auto reflector = [](const Row& r) { return r.provenance == Provenance::kStationary && r.object == 0; };
  for (const char* name : {"presence", "count", "spots", "mirror", "micro_doppler"}) {
    EXPECT_EQ(only(off(name), reflector), only(all, reflector)) << name;
  }
  const auto no_ghost = [](const Row& r) {
    return r.provenance != Provenance::kGhostType1 && r.provenance != Provenance::kGhostType2;
  };
  EXPECT_EQ(only(off("mirror"), no_ghost), only(all, no_ghost));
}

TEST(ProfileInSensor, AScanDependsOnNoScanBefore) {
  Street street;
  street.scene.t_s = 2.0;
  RadarSensor used(street.config, street.effects, street.ego_body, street.seed);
  Measured first, again;
  for (std::uint32_t cycle = 0; cycle < 20; ++cycle) used.measure(street.scene, cycle, *first.scan, first.truth);
  used.measure(street.scene, 30, *first.scan, first.truth);
  RadarSensor fresh(street.config, street.effects, street.ego_body, street.seed);
  fresh.measure(street.scene, 30, *again.scan, again.truth);
  ASSERT_EQ(first.count(), again.count());
  for (std::size_t i = 0; i < first.count(); ++i) {
    ASSERT_EQ(first.scan->range_m[i], again.scan->range_m[i]);
    ASSERT_EQ(first.scan->rcs_dbsm[i], again.scan->rcs_dbsm[i]);
    ASSERT_EQ(first.truth[i].object_id, again.truth[i].object_id);
  }
}

/// RCS of the mirror images in 300 scans, less the level of a car's strongest detection at their range.
std::vector<double> images(const std::function<void(radar::Profile&)>& change) {
  Street street;
  radar::Profile& p = street.effects.profile;
  p.strength.radar_offset_db = 0.0;
  change(p);
  std::vector<double> relative;
  RadarSensor sensor(street.config, street.effects, street.ego_body, street.seed);
  for (std::uint32_t cycle = 0; cycle < 300; ++cycle) {
    Measured m;
    sensor.measure(street.scene, cycle, *m.scan, m.truth);
    for (std::size_t i = 0; i < m.count(); ++i) {
      if (m.truth[i].bounces == 0 || m.truth[i].object_id == 0) continue;
      const auto range = static_cast<double>(m.scan->range_m[i]);
      const double level = radar::strongest_level_dbsm(p.strength, BodyKind::kCar, range);
      relative.push_back(static_cast<double>(m.scan->rcs_dbsm[i]) - level);
    }
  }
  return relative;
}

TEST(ProfileInSensor, MirrorImagesHaveTheStatedStrengthAgainstTheLevelOfTheirObject) {
  for (const auto& [mean_db, std_db] : {std::pair(-12.0, 9.0), std::pair(-28.0, 7.0)}) {
    const std::vector<double> relative = images([&, m = mean_db, s = std_db](radar::Profile& p) {
      p.mirror = {true, m, s, 1.0};
      p.strength.stationary.low_dbsm.fill(-90.0);  // a radar that reports everything
      p.stationary_world.on = false;
    });
    ASSERT_GT(relative.size(), 300u);
    const double error = 4.0 * std_db / std::sqrt(static_cast<double>(relative.size()));
    EXPECT_NEAR(mean(relative), mean_db, error);
    EXPECT_NEAR(std_of(relative), std_db, error);
  }
}

TEST(ProfileInSensor, WeakerMirrorImagesAreReportedLessOften) {
  const auto number = [](double mean_db, double working_share) {
    return images([&](radar::Profile& p) {
             p.mirror = {true, mean_db, 7.0, working_share};
             p.stationary_world.on = false;
           })
        .size();
  };
  const std::size_t strong = number(-12.0, 1.0);
  EXPECT_LT(number(-28.0, 1.0), strong / 2);
  EXPECT_NEAR(static_cast<double>(number(-12.0, 0.25)) / static_cast<double>(strong), 0.25, 0.04);
  EXPECT_EQ(number(-12.0, 0.0), 0u);
}

TEST(ProfileInSensor, ClutterHasTheStrengthOfFalseMovers) {
  Street street;
  street.effects.clutter_per_scan = 5.0;
  street.effects.profile.strength.radar_offset_db = 0.0;
  const radar::StrengthSpec& s = street.effects.profile.strength;
  std::vector<double> deviation;
  for (const Row& r : rows_of(street)) {
    if (r.provenance != Provenance::kClutter || r.cause != Cause::kNone) continue;
    const auto range = static_cast<double>(r.range), rcs = static_cast<double>(r.rcs);
    const double median = radar::rcs_at(s, s.false_mover, range, 0.0);
    const double end = radar::rcs_at(s, s.false_mover, range, rcs < median ? -radar::kNormal90 : radar::kNormal90);
    deviation.push_back((rcs - median) / std::abs(end - median));
  }
  ASSERT_GT(deviation.size(), 100u);
  EXPECT_NEAR(mean(deviation), 0.0, 0.3);
  EXPECT_NEAR(share_of(deviation, [](double d) { return std::abs(d) > 1.0; }), 0.2, 0.12);
}

TEST(ProfileInSensor, HiddenObjectsAreNotDetected) {
  Street street;
  street.scene.scatterers.clear();
  street.scene.surfaces.clear();
  street.scene.bodies.clear();
  street.scene.centres.clear();
  Body& wall = street.add_body(1, {15.0, 0.0, kHeight_m}, {10.0, 0.0, 0.0});
  wall.kind = BodyKind::kTruck;
  wall.width_m = 8.0;
  wall.height_m = 4.0;
  wall.clearance_m = 0.0;
  street.add_body(2, {40.0, 0.0, kHeight_m}, {10.0, 0.0, 0.0});
  std::map<std::uint32_t, int> detected;
  for (const Row& r : rows_of(street)) detected[r.provenance == Provenance::kMoving ? r.object : 0] += 1;
  EXPECT_GT(detected[1], 30);
  EXPECT_EQ(detected[2], 0);
}

TEST(ProfileInSensor, ABlockedRadarLosesWhatTheProfileDraws) {
  Street clear, dirty;
  dirty.effects.blockages = {{1, 0.0, 0.0, 60.0, -3.2, 3.2}};
  const auto real = [](const Row& r) {
    return r.provenance == Provenance::kMoving || r.provenance == Provenance::kStationary;
  };
  const std::size_t all = only(rows_of(clear), real).size(), left = only(rows_of(dirty), real).size();
  EXPECT_GT(all, 2000u);
  EXPECT_LT(left, all / 20);
}

TEST(ProfileInSensor, RaisedNoiseCostsWeakDetections) {
  Street quiet, noisy;
  noisy.effects.interference = {{0, 0.0, 100.0, 15.0, 0.0}};
  EXPECT_LT(rows_of(noisy).size(), rows_of(quiet).size() * 9 / 10);
}

}  // namespace
}  // namespace boresight::simulator::returns_test
