// Arithmetic of the ablation on hand-made evidence.
#include "tests/benchmarks/ghosts/drives/judge/ablation.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace boresight::bench::ghosts_drives {
namespace {

using ghosts::EvidenceKind;

EvidencePart part_of(const std::string& name) {
  for (const EvidencePart& part : evidence_parts()) {
    if (part.name == name) return part;
  }
  ADD_FAILURE() << name;
  return {};
}

fit_evidence::LabelledEvidence labelled(std::uint8_t past, std::uint8_t range, bool is_real) {
  fit_evidence::LabelledEvidence each;
  each.levels.of[static_cast<std::size_t>(EvidenceKind::kPast)] = past;
  each.levels.of[static_cast<std::size_t>(EvidenceKind::kRange)] = range;
  each.is_real = is_real;
  return each;
}

TEST(Ablation, EachKindIsAPart) {
  const std::vector<EvidencePart> parts = evidence_parts();
  EXPECT_EQ(parts.size(), ghosts::kEvidences + 3);
  EXPECT_EQ(std::count_if(parts.begin(), parts.end(), [](const EvidencePart& p) { return p.is_tracks; }), 1);
}

TEST(Ablation, AMissingPartHasTheLowestLevel) {
  ghosts::Levels levels;
  levels.of.fill(2);
  levels.track = 3;
  levels.has_tracks = true;
  const ghosts::Levels no_past = without(part_of("past"), levels);
  EXPECT_EQ(no_past.of[static_cast<std::size_t>(EvidenceKind::kPast)], 0);
  EXPECT_EQ(no_past.of[static_cast<std::size_t>(EvidenceKind::kRange)], 2);
  EXPECT_TRUE(no_past.has_tracks);
  const ghosts::Levels no_mirrors = without(part_of("image_type_1 and image_type_2"), levels);
  EXPECT_EQ(std::count(no_mirrors.of.begin(), no_mirrors.of.end(), 0), 2);
  const ghosts::Levels no_tracks = without(part_of("tracks"), levels);
  EXPECT_FALSE(no_tracks.has_tracks);
  EXPECT_EQ(no_tracks.of, levels.of);
}

TEST(Ablation, OnlyPartsWithInformationChangeTheScore) {
  // The level of `past` decides, the level of `range` says nothing.
  std::vector<fit_evidence::LabelledEvidence> fit;
  for (int i = 0; i < 400; ++i) {
    const bool is_real = i % 2 == 0;
    fit.push_back(labelled(is_real == (i % 10 < 8) ? 1 : 0, static_cast<std::uint8_t>(i / 2 % 2), is_real));
  }
  EvidenceByLane judged;
  judged.fill(fit);
  const ghosts::EvidenceWeights full = fit_evidence::fit_weights(fit, {});
  const auto change = [&](const char* name) { return brier_change_percent(part_of(name), fit, judged, full); };
  // 0.8 · 0.2 with the part, 0.25 without.
  for (const double lane : change("past")) EXPECT_NEAR(lane, 100.0 * (0.25 / 0.16 - 1.0), 1.0);
  for (const double lane : change("range")) EXPECT_NEAR(lane, 0.0, 0.5);
  for (const double lane : change("tracks")) EXPECT_EQ(lane, 0.0) << "none were known";
}

TEST(Ablation, WithoutTracksTheOtherEvidenceJudges) {
  fit_evidence::LabelledEvidence real = labelled(0, 0, true);
  real.levels.has_tracks = true;
  real.levels.track = 1;
  real.levels.sure = 1.0F;
  ghosts::EvidenceWeights full;
  full.track_sure[1] = std::log(3.0);
  EvidenceByLane judged;
  judged.fill({real});
  for (const double lane : brier_change_percent(part_of("tracks"), {}, judged, full)) {
    EXPECT_NEAR(lane, 300.0, 1e-4) << "0.5² instead of 0.25²";
  }
}

}  // namespace
}  // namespace boresight::bench::ghosts_drives
