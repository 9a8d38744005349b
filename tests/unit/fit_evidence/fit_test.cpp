// Rounds of the fit and its judgement, with drives of made evidence.
#include "services/boresight/fit_evidence/fit.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "services/boresight/fit_evidence/report.hpp"

namespace boresight::fit_evidence {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto kPast = static_cast<std::size_t>(ghosts::EvidenceKind::kPast);

/// `number` detections of each of two levels, in all lanes but that of true objects. `share`: of real ones at level 1,
/// and of false ones at level 0.
DriveEvidence made_drive(std::size_t number, double share, bool has_objects = false) {
  DriveEvidence drive;
  for (std::size_t i = 0; i < 2 * number; ++i) {
    fit_evidence::LabelledEvidence each;
    const bool is_high = i % 2 == 1;
    each.levels.of[kPast] = is_high ? 1 : 0;
    each.is_real = (static_cast<double>(i / 2) < share * static_cast<double>(number)) == is_high;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (lane == static_cast<std::size_t>(Lane::kPerfect) && !has_objects) continue;
      drive.lanes[lane].push_back(each);
    }
    drive.base_rates.push_back(0.5F);
  }
  return drive;
}

double high_minus_low(const ghosts::EvidenceWeights& weights) {
  return weights.alone.of[kPast][1] - weights.alone.of[kPast][0];
}

TEST(FitDrives, RunsEachDriveWithTheWeightsOfTheRoundBefore) {
  ghosts::EvidenceWeights start;
  start.alone.constant = 7.0;
  std::vector<std::pair<std::size_t, ghosts::EvidenceWeights>> runs;
  const Fit fit = fit_drives({"a", "b"}, start, [&](std::size_t drive, const ghosts::EvidenceWeights& weights) {
    runs.emplace_back(drive, weights);
    // Tracks, and so the evidence, depend on the weights: level 1 is surer in the second run.
    return made_drive(500, runs.size() <= 2 ? 0.7 : 0.9);
  });
  ASSERT_EQ(runs.size(), 6u);
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i].first, i % 2) << i;
  const double first_odds = 2.0 * std::log(0.7 / 0.3), second_odds = 2.0 * std::log(0.9 / 0.1);
  EXPECT_EQ(runs[0].second.alone.constant, 7.0);
  EXPECT_EQ(runs[1].second.alone.constant, 7.0);
  EXPECT_NEAR(high_minus_low(runs[2].second), first_odds, 0.05);
  EXPECT_NEAR(high_minus_low(runs[3].second), first_odds, 0.05);
  EXPECT_NEAR(high_minus_low(runs[4].second), second_odds, 0.1);
  EXPECT_NEAR(high_minus_low(fit.weights), second_odds, 0.1);
  EXPECT_EQ(fit.detections, 2000u);
  EXPECT_EQ(fit.real_detections, 1000u);
}

TEST(FitDrives, JudgesEachDriveByWeightsOfTheOthers) {
  // What the level says in one drive is the reverse of the other.
  const auto run = [](std::size_t drive, const ghosts::EvidenceWeights&) {
    return made_drive(500, drive == 0 ? 0.9 : 0.1);
  };
  const Fit both = fit_drives({"a", "b"}, {}, run);
  EXPECT_TRUE(both.judges_other_drives);
  EXPECT_NEAR(high_minus_low(both.weights), 0.0, 0.05) << "fitted on both";
  // p = 0.9 for nine false ones in ten.
  EXPECT_NEAR(both.of(Lane::kChain).fitted.brier(), 0.9 * 0.81 + 0.1 * 0.01, 0.01);
  EXPECT_EQ(both.of(Lane::kChain).fitted.detections(), 2000u);
  EXPECT_NEAR(both.of(Lane::kChain).start.brier(), 0.25, 1e-9) << "without weights all are as likely";
  EXPECT_NEAR(both.of(Lane::kChain).base_rate.brier(), 0.25, 1e-9);

  const Fit one = fit_drives({"a"}, {}, run);
  EXPECT_FALSE(one.judges_other_drives);
  EXPECT_NEAR(one.of(Lane::kWithout).fitted.brier(), 0.09, 0.005) << "of the fitted drive itself";
  EXPECT_TRUE(std::isnan(one.of(Lane::kPerfect).fitted.brier())) << "no true objects";
  const std::vector<FittedDrive> drives = {{"a", "7", "a", 10, 0, 1000, 500, false}};
  EXPECT_THAT(to_text(one, drives), HasSubstr("judged on the fitted drive itself"));
  EXPECT_EQ(origin_of(one, drives), "boresight fit-evidence: a (seed 7); 1000 moving detections");
  EXPECT_THAT(to_text(both, drives), Not(HasSubstr("itself")));
}

TEST(FitDrives, SaysWhyThereIsNoFit) {
  const auto problem_of = [](const std::vector<DriveEvidence>& drives) -> std::string {
    std::size_t runs = 0;
    try {
      static_cast<void>(
          fit_drives({"first", "second"}, {}, [&](std::size_t drive, const ghosts::EvidenceWeights&) -> DriveEvidence {
            ++runs;
            return drives[drive];
          }));
    } catch (const NoFit& error) {
      EXPECT_EQ(runs, 2u) << "found in the first round";
      return error.what();
    }
    return "";
  };
  DriveEvidence real = made_drive(10, 0.5), unreal = real;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (fit_evidence::LabelledEvidence& each : real.lanes[lane]) each.is_real = true;
    for (fit_evidence::LabelledEvidence& each : unreal.lanes[lane]) each.is_real = false;
  }
  EXPECT_THAT(problem_of({real, {}}), HasSubstr("second: has no labelled moving detection"));
  EXPECT_THAT(problem_of({real, real}), HasSubstr("all moving detections of the drives are real"));
  EXPECT_THAT(problem_of({unreal, unreal}), HasSubstr("no moving detection of the drives is real"));
  EXPECT_EQ(problem_of({real, unreal}), "") << "together both kinds";
}

}  // namespace
}  // namespace boresight::fit_evidence
