// Levels of the evidence: at each edge, and for what a sensor or the tracks do not say.
#include "services/ghost_filter/core/evidence/evidence_of.hpp"

#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace boresight::ghosts {
namespace {

std::uint8_t level_of(EvidenceKind kind, const Counts& counts, const SensorVerdict& verdict = {},
                      const Expected& expected = {}, bool has_tracks = false) {
  return levels_of(counts, verdict, expected, has_tracks, EvidenceConfig{}).of[static_cast<std::size_t>(kind)];
}

/// Each edge begins a level; just below it is the level before.
template <std::size_t N>
void expect_edges(const std::array<double, N>& edges, double below, std::uint8_t first,
                  const std::function<std::uint8_t(double)>& level) {
  EXPECT_EQ(level(edges[0] - below), first);
  for (std::size_t k = 0; k < N; ++k) {
    EXPECT_EQ(level(edges[k]), first + k + 1) << "at " << edges[k];
    EXPECT_EQ(level(edges[k] - below), first + k) << "below " << edges[k];
  }
  EXPECT_EQ(level(1e3 * std::abs(edges[N - 1])), first + N) << "the last level has no end";
}

TEST(Levels, OfCountsBeginAtTheirEdges) {
  const LevelConfig c;
  expect_edges(c.past_scans, 1.0, 0, [](double n) {
    Counts counts;
    counts.past_scans = static_cast<std::uint32_t>(n);
    return level_of(EvidenceKind::kPast, counts);
  });
  expect_edges(c.company, 1.0, 0, [](double n) {
    Counts counts;
    counts.company = static_cast<std::uint32_t>(n);
    return level_of(EvidenceKind::kCompany, counts);
  });
  expect_edges(c.wide_ring, 1.0, 0, [](double n) {
    Counts counts;
    counts.wide_ring = static_cast<std::uint32_t>(n);
    return level_of(EvidenceKind::kWideRing, counts);
  });
  expect_edges(c.burst, 1.0, 0, [](double n) {
    Counts counts;
    counts.moving = static_cast<std::uint32_t>(n);
    return level_of(EvidenceKind::kBurst, counts);
  });
  expect_edges(c.range_m, 0.01, 0, [](double range_m) {
    Counts counts;
    counts.range_m = static_cast<float>(range_m);
    return level_of(EvidenceKind::kRange, counts);
  });
}

TEST(Levels, OfTheRingFollowTheShareOfTheOwnPlace) {
  const auto ring = [](std::uint32_t company, std::uint32_t others) {
    Counts counts;
    counts.company = company;
    counts.ring = others;
    return level_of(EvidenceKind::kRing, counts);
  };
  EXPECT_EQ(ring(1, 0), 0) << "no other";
  EXPECT_EQ(ring(9, 0), 0);
  EXPECT_EQ(ring(9, 1), 1);
  EXPECT_EQ(ring(1, 1), 1) << "a half";
  EXPECT_EQ(ring(4, 5), 2);
  EXPECT_EQ(ring(3, 7), 2) << "three tenths";
  EXPECT_EQ(ring(2, 5), 3);
  EXPECT_EQ(ring(1, 50), 3);
}

TEST(Levels, OfTheVerdictAreOneForEachCombination) {
  const auto verdict = [](bool is_doubted, bool is_ambiguous) {
    return level_of(EvidenceKind::kVerdict, {}, {is_doubted, is_ambiguous, {}});
  };
  EXPECT_EQ(verdict(false, false), 0);
  EXPECT_EQ(verdict(false, true), 1);
  EXPECT_EQ(verdict(true, false), 2);
  EXPECT_EQ(verdict(true, true), 3);
}

TEST(Levels, OfExistenceKeepTheLowestForASensorThatStatesNone) {
  EXPECT_EQ(level_of(EvidenceKind::kExistence, {}), 0);
  EXPECT_EQ(level_of(EvidenceKind::kExistence, {}, {false, false, 0.0}), 1) << "stated as 0";
  expect_edges(LevelConfig{}.existence, 1e-6, 1, [](double p) {
    return level_of(EvidenceKind::kExistence, {}, {false, false, p});
  });
}

TEST(Levels, OfImagesFollowTheirShareInWhatIsExpected) {
  const EvidenceConfig config;
  for (const bool is_type1 : {true, false}) {
    const EvidenceKind kind = is_type1 ? EvidenceKind::kImageType1 : EvidenceKind::kImageType2;
    const EvidenceKind other = is_type1 ? EvidenceKind::kImageType2 : EvidenceKind::kImageType1;
    const auto expected = [&](double share) {
      // Half of the rest is objects, what is left is anything else.
      Expected e;
      const double all = config.intensity.other_intensity * 2.0 / (1.0 - share);
      (is_type1 ? e.images_type1 : e.images_type2) = share * all;
      e.objects = 0.5 * (1.0 - share) * all;
      return e;
    };
    for (std::size_t k = 0; k < config.levels.image_share.size(); ++k) {
      const double edge = config.levels.image_share[k];
      EXPECT_EQ(level_of(kind, {}, {}, expected(edge + 1e-6), true), k + 1) << edge;
      EXPECT_EQ(level_of(kind, {}, {}, expected(edge - 1e-6), true), k) << edge;
    }
    EXPECT_EQ(level_of(other, {}, {}, expected(0.9), true), 0);
    EXPECT_EQ(level_of(kind, {}, {}, {}, true), 0) << "none is mirrored here";
  }
}

TEST(Levels, OfTheTrackFollowTheStrongestObjectAndItsExistence) {
  const EvidenceConfig config;
  const auto levels = [&](double intensity, double existence) {
    Expected e;
    e.strongest = e.objects = intensity;
    e.existence = existence;
    return levels_of({}, {}, e, true, config);
  };
  EXPECT_EQ(levels(0.0, 0.0).track, 0);
  for (std::size_t k = 0; k < config.levels.track_log10_intensity.size(); ++k) {
    const double edge = config.levels.track_log10_intensity[k];
    EXPECT_EQ(levels(std::pow(10.0, edge + 1e-3), 1.0).track, k + 1);
    EXPECT_EQ(levels(std::pow(10.0, edge - 1e-3), 1.0).track, k);
  }
  EXPECT_FLOAT_EQ(levels(1e-3, 0.8).sure, static_cast<float>(std::pow(0.8, config.intensity.certainty_power)));
  EXPECT_EQ(levels(1e-3, 1.0).sure, 1.0F);
  EXPECT_TRUE(levels(1e-3, 1.0).has_tracks);
  EXPECT_FALSE(levels_of({}, {}, {}, false, config).has_tracks);
}

TEST(Levels, StayWithinThoseThatHaveAWeight) {
  Counts most;
  most.past_scans = most.company = most.ring = most.wide_ring = most.moving = 100'000;
  most.range_m = 1e6F;
  const Expected images{0.0, 1e9, 1.0, 1e9, 1e9};
  const Levels levels = levels_of(most, {true, true, 1.0}, images, true, EvidenceConfig{});
  for (std::size_t k = 0; k < kEvidences; ++k)
    EXPECT_LT(levels.of[k], kEvidenceSpecs[k].levels) << kEvidenceSpecs[k].key;
  EXPECT_LT(levels.track, kTrackLevels);
}

}  // namespace
}  // namespace boresight::ghosts
