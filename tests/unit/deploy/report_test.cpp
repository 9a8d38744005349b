#include <sstream>

#include <Eigen/Geometry>

#include "services/boresight/report/html_report.hpp"
#include "services/boresight/report/truth_table.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "tests/unit/deploy/synthetic_drive.hpp"

namespace boresight::report {
namespace {

bool passed(const Summary& summary, const std::string& part) {
  for (const Check& check : summary.checks) {
    if (check.what.find(part) != std::string::npos) return check.passed;
  }
  ADD_FAILURE() << "no check about " << part;
  return false;
}

TEST(Summary, GoodDrivePassesAndNamesTheMisalignedRadar) {
  const Summary summary = summarise(synthetic_drive(), synthetic_truth());
  EXPECT_TRUE(summary.all_passed()) << render_summary(summary);
  ASSERT_EQ(summary.radars.size(), 4U);
  EXPECT_TRUE(summary.radars[1].expected_to_be_misaligned);
  EXPECT_NEAR(summary.radars[1].first_misaligned_s, 12.5, 0.01);
  EXPECT_THAT(verdict_line(summary.radars[1]), ::testing::StartsWith("front_right: MISALIGNED, yaw +2."));
  EXPECT_THAT(verdict_line(summary.radars[1]), ::testing::EndsWith("beyond the tolerance of 1.5°"));
  EXPECT_THAT(verdict_line(summary.radars[0]), ::testing::HasSubstr("AVAILABLE, yaw"));
  EXPECT_NEAR(summary.duration_s, 59.5, 0.01);
  EXPECT_EQ(summary.distinct_confirmed_tracks, 6U);
}

TEST(Summary, NamesTheAxisThatIsBeyondItsTolerance) {
  auto snapshots = synthetic_drive();
  for (auto& s : snapshots) {
    s.radars[1].yaw.value_rad = 0.0;
    if (s.radars[1].extended_qualifier == ExtendedQualifier::kMisaligned) {
      s.radars[1].explanation = "roll +4.20 ± 0.21°, reduced: beyond 3°";
    }
  }
  EXPECT_EQ(verdict_line(summarise(snapshots, synthetic_truth()).radars[1]),
            "front_right: MISALIGNED, roll +4.20 ± 0.21°, reduced: beyond 3°");
  for (auto& s : snapshots) s.radars[1].explanation.clear();
  EXPECT_EQ(verdict_line(summarise(snapshots, synthetic_truth()).radars[1]),
            "front_right: MISALIGNED, an axis other than yaw is beyond its tolerance");
}

TEST(Summary, NamesAWrongInput) {
  auto snapshots = synthetic_drive();
  for (auto& s : snapshots) {
    s.radars[0].data_qualifier = DataQualifier::kAvailableReduced;
    s.radars[0].extended_qualifier = ExtendedQualifier::kWrongInput;
    s.radars[0].explanation = "speed signal in km/h (3.6 times too large)";
  }
  EXPECT_EQ(verdict_line(summarise(snapshots, synthetic_truth()).radars[0]),
            "front_left: AVAILABLE_REDUCED (WRONG_INPUT), speed signal in km/h (3.6 times too large)");
}

TEST(Summary, MissedMisalignmentFails) {
  auto snapshots = synthetic_drive();
  for (auto& s : snapshots) s.radars[1].extended_qualifier = ExtendedQualifier::kNormal;
  const Summary summary = summarise(snapshots, synthetic_truth());
  EXPECT_FALSE(passed(summary, "front_right is misaligned in the truth"));
  EXPECT_FALSE(summary.all_passed());
}

TEST(Summary, FalseAlarmFailsEvenIfItWasWithdrawn) {
  auto snapshots = synthetic_drive();
  snapshots[30].radars[2].extended_qualifier = ExtendedQualifier::kMisaligned;
  EXPECT_FALSE(passed(summarise(snapshots, synthetic_truth()), "rear_left is within tolerance in the truth"));
}

TEST(Summary, FalseAlarmIsJudgedByAllAnglesOfTheTruthWhereTheyAreKnown) {
  auto snapshots = synthetic_drive();
  snapshots[30].radars[2].extended_qualifier = ExtendedQualifier::kMisaligned;
  Truth truth = synthetic_truth();
  truth.misaligned[3] = {.ever = false, .at_end = false};
  EXPECT_FALSE(summarise(snapshots, truth).all_passed());
  truth.misaligned[3] = {.ever = true, .at_end = false};
  EXPECT_TRUE(summarise(snapshots, truth).all_passed()) << "it was misaligned for a time";
  truth.misaligned[3] = {.ever = true, .at_end = true};
  EXPECT_FALSE(passed(summarise(snapshots, truth), "rear_left is misaligned in the truth"));
}

TEST(Summary, StatesThatAnotherPaceThanRealTimeHasNoVerdict) {
  Summary summary = summarise(synthetic_drive(), synthetic_truth());
  EXPECT_THAT(render_summary(summary), ::testing::Not(::testing::HasSubstr("no verdict")));
  summary.pace = "4 × real time";
  EXPECT_THAT(render_summary(summary), ::testing::HasSubstr("played in 60 s (4 × real time)"));
  EXPECT_THAT(render_summary(summary), ::testing::HasSubstr("latencies, rates and times have no verdict"));
}

TEST(Summary, ScansThatNeverArrivedFailThoughNoSequenceHasAGap) {
  const auto snapshots = synthetic_drive();
  Truth truth = synthetic_truth();
  truth.scans[1] = snapshots.back().radars[0].scans;
  EXPECT_TRUE(summarise(snapshots, truth).all_passed()) << render_summary(summarise(snapshots, truth));
  truth.scans[2] = snapshots.back().radars[1].scans + 1;
  EXPECT_FALSE(passed(summarise(snapshots, truth), "front_right: "));
}

TEST(Summary, LossRestartSilenceAndNoTracksFail) {
  auto lost = synthetic_drive();
  lost.back().radars[3].lost = 1;
  EXPECT_FALSE(passed(summarise(lost, {}), "no scan was lost"));
  auto service_lost = synthetic_drive();
  service_lost.back().services[4].faults[static_cast<std::size_t>(Fault::kInputLost)] = 2;
  EXPECT_FALSE(passed(summarise(service_lost, {}), "no scan was lost"));
  EXPECT_THAT(render_summary(summarise(service_lost, {})), ::testing::HasSubstr("tracker: 2 × input lost"));
  auto service_dropped = synthetic_drive();
  service_dropped.back().services[3].faults[static_cast<std::size_t>(Fault::kInputDropped)] = 5;
  service_dropped.back().services[3].latency_max_us = 61'000.0;
  EXPECT_TRUE(passed(summarise(service_dropped, {}), "no scan was lost")) << "a dropped scan is not counted as lost";
  EXPECT_THAT(render_summary(summarise(service_dropped, {})),
              ::testing::AllOf(::testing::HasSubstr("ghost_filter: 5 × input dropped"),
                               ::testing::HasSubstr("; 5 dropped for newer scans)"),
                               ::testing::ContainsRegex("ghost filter .* 61000\n")));
  auto restarted = synthetic_drive();
  restarted[50].services[2].restarts = 1;
  EXPECT_FALSE(passed(summarise(restarted, {}), "restarted"));
  auto silent = synthetic_drive();
  for (auto& s : silent) s.radars[0].scans = 0;
  EXPECT_FALSE(passed(summarise(silent, {}), "every radar"));
  auto no_tracks = synthetic_drive();
  for (auto& s : no_tracks) s.tracks.clear();
  EXPECT_FALSE(passed(summarise(no_tracks, {}), "objects were tracked"));
  EXPECT_FALSE(summarise({}, {}).all_passed());
}

TEST(Summary, VerdictIsThatOfTheDriveNotOfTheSilenceAfterIt) {
  auto snapshots = synthetic_drive();
  for (int i = 0; i < 4; ++i) {
    snapshots.push_back(snapshots.back());
    snapshots.back().time_ns += 500'000'000;
    for (auto& radar : snapshots.back().radars) {
      radar.rate_hz = 0.0;
      radar.data_qualifier = DataQualifier::kNotAvailable;
      radar.extended_qualifier = ExtendedQualifier::kNoData;
    }
  }
  const Summary summary = summarise(snapshots, synthetic_truth());
  EXPECT_TRUE(summary.all_passed()) << render_summary(summary);
  EXPECT_NEAR(summary.duration_s, 59.5, 0.01);
}

TEST(Summary, CountersThatBeginAgainAreAddedUp) {
  auto snapshots = synthetic_drive();
  for (std::size_t i = 60; i < snapshots.size(); ++i) {
    for (auto& radar : snapshots[i].radars) radar.scans -= 600;
    snapshots[i].latencies = snapshots[i - 60].latencies;
  }
  const Summary summary = summarise(snapshots, {});
  EXPECT_EQ(summary.radars[0].last.scans, 1200U);
  EXPECT_EQ(summary.latencies[0].total(), 4800U);
}

TEST(Summary, MissedAimIsReportedAndFailsNothing) {
  Summary summary = summarise(synthetic_drive(), synthetic_truth());
  summary.checks.push_back({"an aim", false, true});
  EXPECT_TRUE(summary.all_passed());
  EXPECT_EQ(summary.missed_aims(), 1u);
  EXPECT_THAT(render_summary(summary), ::testing::HasSubstr("  [MISSED] an aim\n"));
  EXPECT_THAT(result_text(summary), ::testing::EndsWith("checks passed, 1 of 1 aims was missed."));
  ReportInput input;
  input.snapshots = synthetic_drive();
  input.more_checks = {{"an aim", false, true}};
  EXPECT_THAT(render_html(input), ::testing::HasSubstr("missed:</span> an aim"));
  summary.checks.push_back({"a check", false, false});
  EXPECT_FALSE(summary.all_passed());
  EXPECT_THAT(result_text(summary), ::testing::MatchesRegex("1 of [0-9]+ checks FAILED, 1 of 1 aims was missed\\."));
}

TEST(Summary, LabelsAreSharesOfAllDetectionsAndSurviveARestartOfTheMonitor) {
  auto snapshots = synthetic_drive();
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    for (auto& radar : snapshots[i].radars) {
      const std::uint64_t n = i < 60 ? i : i - 60;  // the monitor was restarted
      radar.labels.classified = {0, 10 * n, 80 * n, n, 3 * n, n};
      radar.labels.rejected = 5 * n;
      radar.labels.scans = n;
    }
  }
  const Summary summary = summarise(snapshots, {});
  EXPECT_EQ(summary.radars[0].last.labels.of(Provenance::kMoving), 1180u);
  EXPECT_EQ(summary.labels.scans, 4u * 118u);
  EXPECT_EQ(labels_text(summary.labels),
            "moving 10.0 %, stationary 80.0 %, ghost type 1 1.0 %, ghost type 2 3.0 %, clutter 1.0 %, rejected by "
            "the corrector 5.0 %");
  EXPECT_THAT(render_summary(summary), ::testing::HasSubstr("47,200 detections classified: moving 10.0 %"));
  const std::string page = render_html(
      {.title = "", .snapshots = snapshots, .truth = {}, .vehicle = {}, .more_checks = {}, .ghosts = {}, .events = {}});
  EXPECT_THAT(page, ::testing::HasSubstr("<td class=n title=\"4720\">10.00 %</td>"));
  EXPECT_THAT(page, ::testing::HasSubstr("of all detections, %"));
}

TEST(TruthTable, SpeedScaleIncludesTheOwnRangeRateScaleOfEachRadar) {
  std::istringstream table(
      "quantity,radar,value,unit\nspeed_scale,,1.02,1\nrange_rate_scale,1,1.0025,1\nrange_rate_scale,2,0.998,1\n"
      "alignment_yaw,1,0.5,deg\nalignment_yaw,2,0.5,deg\nalignment_yaw,3,0.5,deg\n");
  VehicleConfig vehicle;
  for (const std::uint32_t id : {1u, 2u, 3u}) {
    vehicle.radars.emplace_back();
    vehicle.radars.back().id = id;
  }
  const Truth truth = truth_of(read_drive_truth(table), vehicle);
  EXPECT_DOUBLE_EQ(truth.speed_scales.at(1), 1.02 * 1.0025);
  EXPECT_DOUBLE_EQ(truth.speed_scales.at(2), 1.02 * 0.998);
  EXPECT_DOUBLE_EQ(truth.speed_scales.at(3), 1.02);

  auto snapshots = synthetic_drive();
  for (auto& snapshot : snapshots) snapshot.radars[1].speed_scale = 1.02 * 0.998 + 0.001;
  const Summary summary = summarise(snapshots, truth);
  EXPECT_THAT(speed_scale_error_text(summary.radars[1]), ::testing::StartsWith("+0.0010"));
}

TEST(TruthTable, SkipsValuesThatAreMissingOrNoNumbers) {
  std::istringstream table(
      "quantity,radar,value,unit\nspeed_scale,,1.012,1\n"
      "alignment_yaw,2,2.5,deg\nalignment_pitch,2,0.4,deg\nalignment_roll,2,-0.7,deg\nscans,2,899,1\n"
      "scans,3,3e29,1\n"
      "alignment_yaw,3,nan,deg\nalignment_yaw,4,,deg\nalignment_yaw,1\nalignment_yaw,17,1.0,deg\n"
      "alignment_yaw,1,0.5,deg\n");
  const DriveTruth drive = read_drive_truth(table);
  EXPECT_DOUBLE_EQ(drive.speed_scale, 1.012);
  ASSERT_EQ(drive.radars.size(), 2U);
  EXPECT_EQ(drive.radars.at(2).scans, 899u);
  EXPECT_FALSE(drive.radars.contains(3)) << "no number of scans";
  EXPECT_NEAR(drive.radars.at(2).yaw_rad, kMisaligned_rad, 1e-12);
  EXPECT_TRUE(std::isnan(drive.radars.at(1).pitch_rad));

  VehicleConfig vehicle;
  for (const std::uint32_t id : {1u, 2u}) {
    vehicle.radars.emplace_back();
    vehicle.radars.back().id = id;
    vehicle.radars.back().mounting_pose = {
        {3.6, -0.7, 0.5}, -45.0 * kRadiansPerDegree, 2.0 * kRadiansPerDegree, 1.0 * kRadiansPerDegree};
  }
  const Truth truth = truth_of(drive, vehicle);
  EXPECT_EQ(truth.speed_scales, (std::map<std::uint32_t, double>{{1, 1.012}, {2, 1.012}}));
  EXPECT_EQ(truth.scans.at(2), 899u);
  EXPECT_EQ(truth.yaw_rad.size(), 2U);
  ASSERT_EQ(truth.vehicle_rad.size(), 1U) << "radar 1 lacks its pitch and roll";
  // R(actual) = R_x(roll)·R_y(−pitch)·R_z(yaw)·R(nominal), as AlignmentEstimate defines it.
  const auto& [yaw, pitch, roll] = truth.vehicle_rad.at(2);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
      geometry::sensor_to_vehicle(-45.0 * kRadiansPerDegree, 2.0 * kRadiansPerDegree, 1.0 * kRadiansPerDegree);
  const Eigen::Matrix3d actual =
      geometry::sensor_to_vehicle(-42.5 * kRadiansPerDegree, 2.4 * kRadiansPerDegree, 0.3 * kRadiansPerDegree);
  EXPECT_LT((turned - actual).norm(), 1e-12);
  std::istringstream nothing("");
  EXPECT_FALSE(truth_of(read_drive_truth(nothing), vehicle).known());
}

TEST(Summary, ErrorsAgainstTheTruthInSigmasWithTheMeanNees) {
  auto snapshots = synthetic_drive();
  Truth truth = synthetic_truth();
  truth.vehicle_rad[2] = {kMisaligned_rad, 0.4 * kRadiansPerDegree, 0.0};
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    monitor::AlignmentDetails& d = snapshots[i].radars[1].details;
    d.yaw = {kMisaligned_rad + 0.02 * kRadiansPerDegree, 0.04 * kRadiansPerDegree, true};
    d.pitch = {0.1 * kRadiansPerDegree, 0.1 * kRadiansPerDegree, true};
    d.roll = {0.0, 4.0 * kRadiansPerDegree, false};
    d.nees = i < 10 ? NAN : (i % 2 == 0 ? 0.5 : 1.0);
  }
  const Summary summary = summarise(snapshots, truth);
  EXPECT_NEAR(summary.radars[1].mean_nees, 0.75, 0.01);
  EXPECT_TRUE(std::isnan(summary.radars[0].mean_nees));
  const std::string text = render_summary(summary);
  EXPECT_THAT(
      text,
      ::testing::ContainsRegex(
          "front_right +\\+0\\.00020 \\(0\\.4 σ\\) +\\+0\\.020° \\(0\\.5 σ\\) +-0\\.30° \\(3\\.0 σ\\) +not observable "
          "+0\\.50 +0\\.75"));
  const std::string page = render_html({.title = "",
                                        .snapshots = snapshots,
                                        .truth = truth,
                                        .vehicle = {},
                                        .more_checks = {},
                                        .ghosts = {},
                                        .events = {}});
  EXPECT_THAT(page, ::testing::HasSubstr("Estimation errors"));
  EXPECT_THAT(page, ::testing::HasSubstr("-0.30° (3.0 σ)"));
  EXPECT_THAT(page, ::testing::HasSubstr("0.75</td>"));
  EXPECT_THAT(page, ::testing::Not(::testing::ContainsRegex("[^A-Za-z]nan")));
  EXPECT_THAT(render_html({.title = "",
                           .snapshots = snapshots,
                           .truth = {},
                           .vehicle = {},
                           .more_checks = {},
                           .ghosts = {},
                           .events = {}}),
              ::testing::Not(::testing::HasSubstr("Estimation errors")));
}

TEST(HtmlReport, StandsAloneAndShowsEveryRadar) {
  const std::string page = render_html({.title = "a <drive>",
                                        .snapshots = synthetic_drive(),
                                        .truth = synthetic_truth(),
                                        .vehicle = {},
                                        .more_checks = {},
                                        .ghosts = {},
                                        .events = {"0.1 spawned roudi"}});
  EXPECT_THAT(page, ::testing::HasSubstr("a &lt;drive&gt;"));
  for (const char* name : {"front_left", "front_right", "rear_left", "rear_right"}) {
    EXPECT_THAT(page, ::testing::HasSubstr("<h3>" + std::string(name) + "</h3>"));
  }
  EXPECT_THAT(page, ::testing::HasSubstr("All checks passed."));
  EXPECT_THAT(page, ::testing::Not(::testing::HasSubstr("http")));
  EXPECT_THAT(page, ::testing::Not(::testing::ContainsRegex("[^A-Za-z]nan")));
  EXPECT_THAT(page, ::testing::Not(::testing::HasSubstr("inf")));
}

TEST(HtmlReport, SurvivesARunWithoutAnyData) {
  EXPECT_THAT(render_html({}), ::testing::HasSubstr("Not all checks passed."));
  monitor::Snapshot empty;
  empty.services.emplace_back();
  EXPECT_THAT(render_html({.title = "",
                           .snapshots = {empty},
                           .truth = {},
                           .vehicle = {},
                           .more_checks = {},
                           .ghosts = {},
                           .events = {}}),
              ::testing::HasSubstr("No scan reached the tracker."));
}

}  // namespace
}  // namespace boresight::report
