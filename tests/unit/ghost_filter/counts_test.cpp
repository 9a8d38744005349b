// The counts against a slow reference, and what they must not depend on.
#include "services/ghost_filter/core/evidence/counts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/allocation_counter.hpp"

namespace boresight::ghosts {
namespace {

constexpr std::int64_t kCountStart_ns = 5'000'000'000, kCountPeriod_ns = 40'000'000;

/// As many looks as there can be.
CountConfig unbounded() {
  CountConfig c;
  c.most_neighbours = 100'000;
  c.most_past_looks = 100'000;
  c.most_remembered = 100'000;
  return c;
}

/// A detection of a sensor at the origin of the frame.
Candidate candidate(double range_m, double azimuth_rad, double range_rate_mps, double over_ground_mps) {
  const Eigen::Vector2d direction(std::cos(azimuth_rad), std::sin(azimuth_rad));
  return {static_cast<float>(range_m),         static_cast<float>(azimuth_rad),     static_cast<float>(range_rate_mps),
          static_cast<float>(over_ground_mps), (range_m * direction).cast<float>(), direction.cast<float>()};
}

struct TimedScan {
  std::int64_t time_ns;
  std::vector<Candidate> detections;
};

/// Scans with groups of detections, so that all counts differ from 0.
std::vector<TimedScan> random_scans(unsigned seed, std::size_t number) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> range(2.0, 60.0), azimuth(-M_PI, M_PI), rate(-12.0, 12.0), chance(0.0, 1.0);
  std::normal_distribution<double> near(0.0, 1.0);
  std::vector<TimedScan> scans;
  std::vector<std::array<double, 3>> groups;
  for (int k = 0; k < 8; ++k) groups.push_back({range(random), azimuth(random), rate(random)});
  for (std::size_t s = 0; s < number; ++s) {
    TimedScan& scan = scans.emplace_back();
    scan.time_ns = kCountStart_ns + static_cast<std::int64_t>(s) * kCountPeriod_ns;
    for (int i = 0; i < 70; ++i) {
      std::array<double, 3> d{range(random), azimuth(random), rate(random)};
      if (i < 50) {
        const auto& g = groups[static_cast<std::size_t>(i) % groups.size()];
        d = {std::abs(g[0] + 1.5 * near(random)), g[1] + 0.06 * near(random), g[2] + 0.4 * near(random)};
        if (chance(random) < 0.3) d[1] = azimuth(random);
        d[1] = std::remainder(d[1], 2.0 * M_PI);
      }
      scan.detections.push_back(candidate(d[0], d[1], d[2] - 3.0, d[2]));
    }
  }
  return scans;
}

/// Whether a value is under a gate; `slack` widens all gates, or narrows them.
bool under(double value, double gate, double slack) {
  return value < gate + slack;
}

/// The counts of one detection, by their definition. A value within rounding of a gate makes the least and the most
/// count differ: `slack` is less or more than 0. The wide ring excludes what the ring includes, by the same slack.
struct SlowCounts {
  std::uint32_t past_scans = 0, company = 0, ring = 0, beside_or_wide = 0;
};
SlowCounts slow_counts(const std::vector<TimedScan>& scans, std::size_t s, std::size_t i, const CountConfig& config,
                       double slack) {
  SlowCounts out;
  const Candidate& c = scans[s].detections[i];
  for (const Candidate& o : scans[s].detections) {
    const double ranges = std::abs(static_cast<double>(o.range_m) - c.range_m);
    const double rates = std::abs(static_cast<double>(o.range_rate_mps) - c.range_rate_mps);
    const double angle = std::remainder(static_cast<double>(o.azimuth_rad) - c.azimuth_rad, 2.0 * M_PI);
    const double across = std::abs(angle) * c.range_m;
    const bool is_near =
        under(ranges, config.company_radius_m, slack) && under(rates, config.company_range_rate_mps, slack);
    const bool is_wide = under(ranges, config.wide_range_m, slack) && under(rates, config.wide_range_rate_mps, slack);
    const bool is_beside = under(across, config.company_radius_m, slack);
    const bool is_elsewhere = !under(across, config.company_radius_m, -slack);
    if (is_near && is_beside) ++out.company;
    if (is_near && is_elsewhere) ++out.ring;
    if (is_wide && is_elsewhere) ++out.beside_or_wide;
  }
  for (std::size_t earlier = 0; earlier < s; ++earlier) {
    const double elapsed_s = static_cast<double>(scans[s].time_ns - scans[earlier].time_ns) * 1e-9;
    if (!(elapsed_s > 0.0) || elapsed_s >= config.memory_s - 1e-9) continue;
    const double radius = config.past_radius_m + config.past_radius_per_range * static_cast<double>(c.range_m);
    for (const Candidate& o : scans[earlier].detections) {
      const double rates = std::abs(static_cast<double>(o.range_rate_over_ground_mps) - c.range_rate_over_ground_mps);
      const Eigen::Vector2d now = o.position_m.cast<double>() + elapsed_s *
                                                                    static_cast<double>(o.range_rate_over_ground_mps) *
                                                                    o.direction.cast<double>();
      if (!under((now - c.position_m.cast<double>()).norm(), radius, slack)) continue;
      if (!under(rates, config.past_range_rate_mps, slack)) continue;
      ++out.past_scans;
      break;
    }
  }
  return out;
}

std::vector<std::vector<Counts>> counted(Counter& counter, const std::vector<TimedScan>& scans) {
  std::vector<std::vector<Counts>> all;
  for (const TimedScan& scan : scans) {
    all.emplace_back(scan.detections.size());
    counter.count(scan.time_ns, scan.detections, all.back());
  }
  return all;
}

void expect_same(const Counts& a, const Counts& b) {
  EXPECT_EQ(a.past_scans, b.past_scans);
  EXPECT_EQ(a.company, b.company);
  EXPECT_EQ(a.ring, b.ring);
  EXPECT_EQ(a.wide_ring, b.wide_ring);
  EXPECT_EQ(a.moving, b.moving);
  EXPECT_EQ(a.range_m, b.range_m);
}

TEST(Counter, CountsAsItsDefinitionDoesOnRandomScans) {
  constexpr double kRounding = 2e-5;
  const CountConfig config = unbounded();
  std::size_t compared = 0, exact = 0, past = 0, ring = 0, wide = 0;
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    Counter counter(config);
    const std::vector<TimedScan> scans = random_scans(seed, 12);
    const auto all = counted(counter, scans);
    for (std::size_t s = 0; s < scans.size(); ++s) {
      for (std::size_t i = 0; i < scans[s].detections.size(); ++i) {
        const Counts& c = all[s][i];
        const SlowCounts least = slow_counts(scans, s, i, config, -kRounding);
        const SlowCounts most = slow_counts(scans, s, i, config, kRounding);
        const auto is_between = [](std::uint32_t n, std::uint32_t a, std::uint32_t b) { return a <= n && n <= b; };
        EXPECT_TRUE(is_between(c.past_scans, least.past_scans, most.past_scans)) << seed << ' ' << s << ' ' << i;
        EXPECT_TRUE(is_between(c.company, least.company, most.company)) << seed << ' ' << s << ' ' << i;
        EXPECT_TRUE(is_between(c.ring, least.ring, most.ring)) << seed << ' ' << s << ' ' << i;
        EXPECT_TRUE(is_between(c.ring + c.wide_ring, least.beside_or_wide, most.beside_or_wide))
            << seed << ' ' << s << ' ' << i;
        EXPECT_EQ(c.moving, scans[s].detections.size());
        EXPECT_EQ(c.range_m, scans[s].detections[i].range_m);
        ++compared;
        exact +=
            least.past_scans == most.past_scans && least.company == most.company && least.ring == most.ring ? 1 : 0;
        past += c.past_scans;
        ring += c.ring;
        wide += c.wide_ring;
      }
    }
  }
  EXPECT_GT(static_cast<double>(exact), 0.99 * static_cast<double>(compared)) << "else the reference says little";
  EXPECT_GT(past, compared / 4);
  EXPECT_GT(ring, compared / 4);
  EXPECT_GT(wide, compared / 4);
}

TEST(Counter, ATurnedAndShiftedFrameChangesNoCount) {
  const std::vector<TimedScan> scans = random_scans(11, 10);
  for (const double turn_rad : {0.7, -2.9, 1.5707963}) {
    std::vector<TimedScan> moved = scans;
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    Eigen::Matrix2d rotation;
    rotation << c, -s, s, c;
    for (TimedScan& scan : moved) {
      for (Candidate& d : scan.detections) {
        d.position_m = (rotation * d.position_m.cast<double>() + Eigen::Vector2d(150.0, -80.0)).cast<float>();
        d.direction = (rotation * d.direction.cast<double>()).cast<float>();
        d.azimuth_rad = static_cast<float>(std::remainder(static_cast<double>(d.azimuth_rad) + turn_rad, 2.0 * M_PI));
      }
    }
    Counter as_it_was(unbounded()), as_moved(unbounded());
    const auto before = counted(as_it_was, scans), after = counted(as_moved, moved);
    for (std::size_t k = 0; k < before.size(); ++k) {
      for (std::size_t i = 0; i < before[k].size(); ++i) expect_same(before[k][i], after[k][i]);
    }
  }
}

TEST(Counter, DetectionsToBothSidesOfTheRearAreBesideEachOther) {
  const double behind_rad = M_PI - 0.002;
  const std::vector<Candidate> scan = {candidate(20.0, behind_rad, -5.0, -5.0),
                                       candidate(20.0, -behind_rad, -5.0, -5.0), candidate(20.0, 0.0, -5.0, -5.0)};
  Counter counter{CountConfig{}};
  std::vector<Counts> counts(3);
  counter.count(kCountStart_ns, scan, counts);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_EQ(counts[i].company, 2U);
    EXPECT_EQ(counts[i].ring, 1U);
  }
  EXPECT_EQ(counts[2].company, 1U);
  EXPECT_EQ(counts[2].ring, 2U);
}

TEST(Counter, CountsScansWithADetectionWhereThisOneWouldHaveBeen) {
  Counter counter{CountConfig{}};
  std::vector<Counts> counts(2);
  for (int s = 0; s < 4; ++s) {
    const double elapsed_s = 0.05 * s;
    // The first one comes nearer as its range rate says. The second one stands still and claims to move by 60 m/s.
    const std::vector<Candidate> scan = {candidate(40.0 - 20.0 * elapsed_s, 0.1, -20.0, -20.0),
                                         candidate(30.0, 1.0, 60.0, 60.0)};
    counter.count(kCountStart_ns + static_cast<std::int64_t>(s) * 50'000'000, scan, counts);
    EXPECT_EQ(counts[0].past_scans, static_cast<std::uint32_t>(s));
    EXPECT_EQ(counts[1].past_scans, 0U);
  }
}

TEST(Counter, AScanOfTheSameInstantIsNoEarlierOne) {
  Counter counter{CountConfig{}};
  std::vector<Counts> counts(1);
  const std::vector<Candidate> scan = {candidate(40.0, 0.1, 5.0, 5.0)};
  counter.count(kCountStart_ns, scan, counts);
  counter.count(kCountStart_ns, scan, counts);
  EXPECT_EQ(counts[0].past_scans, 0U);
  counter.count(kCountStart_ns - 2'000'000, scan, counts);
  EXPECT_EQ(counts[0].past_scans, 0U) << "a scan that comes late";
}

TEST(Counter, TheMemoryEndsAfterItsTime) {
  CountConfig config;
  config.memory_s = 0.3;
  const std::vector<Candidate> scan = {candidate(30.0, 0.0, 0.0, 1.0)};
  for (const auto& [elapsed_ns, expected] : {std::pair(299'000'000, 1U), std::pair(300'000'000, 0U)}) {
    Counter counter(config);
    std::vector<Counts> counts(1);
    counter.count(kCountStart_ns, scan, counts);
    counter.count(kCountStart_ns + elapsed_ns, scan, counts);
    EXPECT_EQ(counts[0].past_scans, expected) << elapsed_ns;
  }
}

TEST(Counter, ClearedItKnowsNoEarlierScan) {
  Counter counter{CountConfig{}};
  std::vector<Counts> counts(1);
  const std::vector<Candidate> scan = {candidate(30.0, 0.0, 0.0, 1.0)};
  counter.count(kCountStart_ns, scan, counts);
  counter.clear();
  counter.count(kCountStart_ns + kCountPeriod_ns, scan, counts);
  EXPECT_EQ(counts[0].past_scans, 0U);
  counter.count(kCountStart_ns + 2 * kCountPeriod_ns, scan, counts);
  EXPECT_EQ(counts[0].past_scans, 1U);
}

TEST(Counter, ScansBeyondItsRingPushTheOldestOut) {
  CountConfig config = unbounded();
  config.memory_s = 2.0;
  Counter counter(config);
  std::vector<Counts> counts(1);
  const std::vector<Candidate> scan = {candidate(30.0, 0.0, 0.0, 0.0)};
  for (int s = 0; s < 200; ++s) counter.count(kCountStart_ns + static_cast<std::int64_t>(s) * 5'000'000, scan, counts);
  EXPECT_EQ(counts[0].past_scans, 64U);
}

TEST(Counter, EmptyScansAndLoneDetectionsHaveTheLeastCounts) {
  Counter counter{CountConfig{}};
  std::vector<Counts> counts(1);
  counter.count(kCountStart_ns, {}, counts);
  const std::vector<Candidate> scan = {candidate(30.0, 0.0, 2.0, 2.0)};
  counter.count(kCountStart_ns + kCountPeriod_ns, scan, counts);
  expect_same(counts[0], Counts{0, 1, 0, 0, 1, 30.0F});
}

TEST(Counter, AFullScanAtOnePlaceStaysWithinTheBudget) {
  CountConfig config;
  config.most_neighbours = 32;
  config.most_past_looks = 64;
  Counter counter(config);
  const std::vector<Candidate> scan(kMaxDetections, candidate(30.0, 0.2, 2.0, 2.0));
  std::vector<Counts> counts(scan.size());
  std::uint64_t before = 0;
  for (int s = 0; s < 10; ++s) {
    counter.count(kCountStart_ns + s * kCountPeriod_ns, scan, counts);
    EXPECT_LE(counter.looks() - before, scan.size() * (config.most_neighbours + config.most_past_looks));
    before = counter.looks();
    for (const Counts& c : counts) {
      EXPECT_EQ(c.company, 1U + config.most_neighbours);
      EXPECT_EQ(c.ring + c.wide_ring, 0U);
      EXPECT_EQ(c.past_scans, std::min(static_cast<std::uint32_t>(s), 1U)) << "the looks end in the latest scan";
    }
  }
}

TEST(Counter, PastScansStopAtTheMostThatCount) {
  Counter counter(CountConfig{}, 5);
  const std::vector<Candidate> scan(30, candidate(30.0, 0.2, 2.0, 2.0));
  std::vector<Counts> counts(scan.size());
  for (std::uint32_t s = 0; s < 8; ++s) {
    counter.count(kCountStart_ns + s * kCountPeriod_ns, scan, counts);
    EXPECT_EQ(counts[0].past_scans, std::min(s, 5U));
  }
}

TEST(Counter, TheLatestDetectionsAreRemembered) {
  CountConfig config;
  config.most_remembered = 60;
  Counter counter(config);
  const std::vector<Candidate> scan(30, candidate(30.0, 0.2, 2.0, 2.0));
  std::vector<Counts> counts(scan.size());
  for (std::uint32_t s = 0; s < 6; ++s) {
    counter.count(kCountStart_ns + s * kCountPeriod_ns, scan, counts);
    EXPECT_EQ(counts[0].past_scans, std::min(s, 2U));
  }
}

TEST(Counter, DetectionsWithoutRoomForTheirCountsAreNotCounted) {
  Counter counter{CountConfig{}};
  const std::vector<Candidate> scan(10, candidate(30.0, 0.2, 2.0, 2.0));
  std::vector<Counts> counts(4);
  counter.count(kCountStart_ns, scan, counts);
  for (const Counts& c : counts) EXPECT_EQ(c.company, 4U);
  const std::vector<Candidate> many(kMaxDetections + 10, candidate(30.0, 0.2, 2.0, 2.0));
  std::vector<Counts> for_many(many.size(), Counts{9, 9, 9, 9, 9, 9.0F});
  counter.count(kCountStart_ns, many, for_many);
  EXPECT_EQ(for_many[kMaxDetections - 1].moving, kMaxDetections);
  expect_same(for_many[kMaxDetections], Counts{9, 9, 9, 9, 9, 9.0F});
}

TEST(Counter, AllocatesNothingAfterConstruction) {
  Counter counter{CountConfig{}};
  const std::vector<TimedScan> scans = random_scans(21, 12);
  const std::vector<Candidate> full(kMaxDetections, candidate(30.0, 0.2, 2.0, 2.0));
  std::vector<Counts> counts(kMaxDetections);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int round = 0; round < 10; ++round) {
      const std::int64_t offset_ns = round * std::int64_t{1'000'000'000};
      for (const TimedScan& scan : scans) counter.count(scan.time_ns + offset_ns, scan.detections, counts);
      counter.count(scans.back().time_ns + offset_ns + 1'000'000, full, counts);
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::ghosts
