// A run beside its truth: clocks, absent tables, damaged tables, outputs.
#include "services/boresight/score/score.hpp"

#include <cmath>
#include <functional>
#include <sstream>
#include <string>

#include <gmock/gmock.h>

#include "services/boresight/score/detection_truth.hpp"
#include "services/boresight/score/object_truth.hpp"
#include "services/boresight/score/report_text.hpp"
#include "services/boresight/score/run_folder.hpp"
#include "services/common/geometry/angles.hpp"
#include "tests/unit/score/made_run.hpp"

namespace boresight::score {

namespace fs = std::filesystem;

namespace {

using ::testing::HasSubstr;

constexpr int kScans = 31;

Score score_of(const fs::path& run, const fs::path& truth, const VehicleConfig* vehicle = nullptr) {
  return score({run, find_truth(truth), vehicle, {}});
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

VehicleConfig one_radar() {
  VehicleConfig vehicle;
  vehicle.radars.emplace_back();
  vehicle.radars.back().id = 1;
  vehicle.radars.back().name = "front \"left\"";
  vehicle.radars.back().mounting_pose.yaw_rad = 0.8;
  return vehicle;
}

TEST(Score, RunIsJudgedByItsTruth) {
  const fs::path run = made::folder("run"), truth = made::folder("truth");
  made::write_run(run, kScans, 0.5);
  made::write_truth(truth, kScans);
  const Score result = score_of(run, truth);
  EXPECT_EQ(result.finding, "");
  const judge::FigureList& f = result.figures;
  EXPECT_EQ(f.value("run.scans"), kScans);
  EXPECT_NEAR(f.value("run.seconds"), 3.0, 1e-9);
  EXPECT_EQ(f.value("tracks.lists"), kScans);
  EXPECT_EQ(f.value("tracks.car.all_ranges.tracked_share"), 1.0);
  EXPECT_NEAR(f.value("tracks.car.all_ranges.along_rms_m"), 0.5, 1e-3) << "interpolated between rows of the truth";
  EXPECT_NEAR(f.value("tracks.car.all_ranges.across_rms_m"), 0.0, 1e-9);
  EXPECT_EQ(f.value("detections.scans"), kScans);
  EXPECT_EQ(f.value("detections.moving_that_is_moving_share"), 1.0);
  EXPECT_EQ(f.value("detections.confusion.clutter.stationary"), kScans);
  EXPECT_EQ(f.value("detections.cause.burst.count"), kScans);
  EXPECT_NEAR(f.value("detections.brier"), 0.01, 1e-12);
}

TEST(Score, TruthMayCountOnEachOfThreeClocks) {
  const fs::path run = made::folder("clocks_run"), truth = made::folder("clocks_truth");
  // Of a simulated drive whose first scan comes after 0.05 s, of another recording, and of a table from 0 on.
  struct Case {
    std::int64_t start_ns;
    double truth_from_s;
  };
  for (const Case& each : {Case{made::kStart_ns + 50'000'000, 0.05}, Case{1'600'000'000'000'000'000, 1.6e9},
                           Case{1'600'000'000'000'000'000, 0.0}, Case{0, 0.0}}) {
    made::write_run(run, kScans, 0.5, each.start_ns);
    made::write_truth(truth, kScans, each.truth_from_s);
    const Score result = score_of(run, truth);
    EXPECT_EQ(result.figures.value("tracks.lists"), kScans) << each.start_ns;
    EXPECT_EQ(result.figures.value("detections.scans"), kScans) << each.start_ns;
    EXPECT_NEAR(result.figures.value("tracks.car.all_ranges.along_rms_m"), 0.5, 1e-3) << each.start_ns;
  }
}

TEST(Score, ClockOfTheTruthIsTakenFromTheRunThatStatesIt) {
  const fs::path run = made::folder("stated_run"), truth = made::folder("stated_truth");
  // A record whose first five scans were not received: its first measurement is not the beginning of the truth.
  constexpr std::int64_t kBegin_ns = 34'000'000'000'000;
  made::write_run(run, kScans - 5, 0.0, kBegin_ns + 500'000'000);
  made::write_truth(truth, kScans);
  made::write_file(run / "run.json", fmt::format("{{\"truth_begin_ns\":{}}}", kBegin_ns));
  const Score result = score_of(run, truth);
  EXPECT_EQ(result.figures.value("tracks.lists"), kScans - 5);
  // The tracks of the made run begin at the object's first place, half a second behind it.
  EXPECT_NEAR(result.figures.value("tracks.car.all_ranges.along_rms_m"), 0.5, 1e-3);
  made::write_file(run / "run.json", "{\"truth_begin_ns\":\"now\"}");
  EXPECT_THAT(error_of([&] { static_cast<void>(score_of(run, truth)); }),
              HasSubstr("truth_begin_ns: is no whole number"));
}

TEST(Score, RowsOfAScanThatIsNotInTheTableOfScansArePassedOver) {
  const fs::path run = made::folder("orphans_run"), truth = made::folder("orphans_truth");
  made::write_run(run, kScans, 0.0);
  made::write_truth(truth, kScans);
  std::ifstream stream(run / "scans.csv");
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t third = text.find("0.200000,");
  ASSERT_NE(third, std::string::npos);
  text.erase(third, text.find('\n', third) + 1 - third);
  made::write_file(run / "scans.csv", text);
  const Score result = score_of(run, truth);
  EXPECT_EQ(result.figures.value("tracks.lists"), kScans - 1);
  EXPECT_EQ(result.figures.value("detections.scans"), kScans - 1);
}

TEST(Score, TruthOfAnotherTimeIsAFinding) {
  const fs::path run = made::folder("other_run"), truth = made::folder("other_truth");
  made::write_run(run, kScans, 0.0);
  made::write_truth(truth, kScans, 500.0);
  const Score result = score_of(run, truth);
  EXPECT_THAT(result.finding, HasSubstr("nothing could be judged"));
  EXPECT_THAT(result.finding, HasSubstr("500.000"));
  EXPECT_TRUE(std::isnan(result.figures.value("tracks.all.all_ranges.tracked_share")));
}

TEST(Score, EmptyRunIsAFinding) {
  const fs::path run = made::folder("empty_run"), truth = made::folder("empty_truth");
  made::write_run(run, 0, 0.0);
  made::write_truth(truth, kScans);
  EXPECT_EQ(score_of(run, truth).finding, "the run has no scan");
}

TEST(Score, AbsentTablesAreNamedAndTheirFiguresAreUnknown) {
  const fs::path run = made::folder("absent_run"), truth = made::folder("absent_truth");
  made::write_run(run, kScans, 0.0);
  made::write_truth(truth, kScans);
  fs::remove(run / "tracks.csv");
  Score result = score_of(run, truth);
  EXPECT_THAT(result.notes, ::testing::Contains(HasSubstr("no tracks.csv")));
  EXPECT_THAT(result.notes, ::testing::Contains(HasSubstr("no run.json")));
  EXPECT_TRUE(std::isnan(result.figures.value("tracks.all.all_ranges.objects")));
  EXPECT_TRUE(std::isnan(result.figures.value("health.judged_s")));
  EXPECT_EQ(result.figures.value("detections.scans"), kScans);
  made::write_run(run, kScans, 0.0);
  fs::remove(truth / "truth_detections.csv");
  result = score_of(run, truth);
  EXPECT_THAT(result.notes, ::testing::Contains(HasSubstr("the truth has no origins of detections")));
  EXPECT_TRUE(std::isnan(result.figures.value("detections.moving_lost_share")));
  EXPECT_EQ(result.figures.value("tracks.lists"), kScans);
  // One table of objects is a truth, too.
  EXPECT_EQ(score_of(run, truth / "truth_objects.csv").figures.value("tracks.lists"), kScans);
}

TEST(Score, BoxesAndLabelsAreATruth) {
  const fs::path run = made::folder("boxes_run"), truth = made::folder("boxes_truth");
  made::write_run(run, kScans, 0.5);
  std::string boxes = "class,id,t_s,x,y,yaw,length,width,vx,vy\n# by hand\n", labels = "t_s,radar,index,object,class\n";
  for (int i = 0; i < kScans; ++i) {
    const double t_s = made::kPeriod_s * i;
    if (i % 5 == 0) boxes += fmt::format("car,1,{:.3f},{:.3f},2,0,4.5,1.8,11,0\n", t_s, 20.0 + t_s);
    if (i % 5 == 0) boxes += fmt::format("car,2,{:.3f},40,-8,0,4.5,1.8,0.1,0\n", t_s);  // stands
    if (i % 2 == 0) labels += fmt::format("{:.6f},1,0,1,car\n", t_s);
  }
  made::write_file(truth / "boxes.csv", boxes);
  made::write_file(truth / "labels.csv", labels);
  const Score result = score_of(run, truth);
  EXPECT_EQ(result.finding, "");
  EXPECT_EQ(result.figures.value("tracks.car.all_ranges.objects"), 1.0);
  EXPECT_NEAR(result.figures.value("tracks.car.all_ranges.along_rms_m"), 0.5, 1e-3);
  EXPECT_EQ(result.figures.value("detections.scans"), 16.0);
  EXPECT_EQ(result.figures.value("detections.scans_without_truth"), 15.0);
  EXPECT_EQ(result.figures.value("detections.confusion.unknown.stationary"), 16.0);
  EXPECT_EQ(score_of(run, truth / "boxes.csv").figures.value("tracks.car.all_ranges.objects"), 1.0);
}

TEST(Score, HiddenObjectsAreNotDemanded) {
  const fs::path run = made::folder("hidden_run"), truth = made::folder("hidden_truth");
  made::write_run(run, kScans, 0.5);
  made::write_truth(truth, kScans);
  // Seen in the first second only, so in view until 1.5 s.
  std::string rows = "t_s,radar,scan,object,state,centres,in_view,seen\n";
  for (int i = 0; i < kScans; ++i) {
    rows += fmt::format("{:.6f},1,{},1,{},12,6,3\n", made::kPeriod_s * i, i + 1, i <= 10 ? "seen" : "occluded");
  }
  made::write_file(truth / "truth_visibility.csv", rows);
  const Score result = score_of(run, truth);
  EXPECT_EQ(result.figures.value("tracks.car.all_ranges.stays"), 1.0);
  EXPECT_EQ(result.figures.value("tracks.false.all_ranges.tracks"), 0.0);
  const auto demanded = [&](double t_s) {
    ObjectTruth objects(truth / "truth_objects.csv", false, truth / "truth_visibility.csv");
    std::vector<judge::TrueObject> at;
    EXPECT_TRUE(objects.at(t_s, at));
    return at.at(0).in_view;
  };
  EXPECT_TRUE(demanded(1.4));
  EXPECT_FALSE(demanded(1.6));
}

TEST(Score, AlignmentAndHealthAreJudgedWithAVehicle) {
  const fs::path run = made::folder("alignment_run"), truth = made::folder("alignment_truth");
  made::write_run(run, kScans, 0.0);
  made::write_truth(truth, kScans);
  made::write_file(truth / "truth.csv",
                   "quantity,radar,value,unit\nspeed_scale,,1.01,1\nalignment_yaw,1,2,deg\n"
                   "alignment_pitch,1,0,deg\nalignment_roll,1,0,deg\n");
  std::string rows =
      "t_s,time_ns,radar,state,speed_scale,yaw_rad,rotation_x_rad,rotation_y_rad,rotation_z_rad,cov_k_k,cov_x_x,cov_y_"
      "y,"
      "cov_z_z,observable,inlier_ratio,step_changes\n";
  rows += fmt::format("0,{},1,no_data,,,,,,,,,,,,\n", made::kStart_ns);
  std::string health;
  for (int i = 0; i < kScans; ++i) {
    const std::int64_t time_ns = made::kStart_ns + static_cast<std::int64_t>(i) * 100'000'000;
    const double t_s = made::kPeriod_s * i;
    rows += fmt::format("{:.6f},{},1,converging,1.011,0,0,0,{},1e-6,1e-4,1e-4,1e-4,15,0.9,{}\n", t_s, time_ns,
                        3.0 * M_PI / 180.0, i < 20 ? 0 : 1);
    health += fmt::format(
        R"({{"t_s":{},"time_ns":{},"radars":[{{"radar":1,"data_qualifier":"AVAILABLE_REDUCED","extended_qualifier":"{}"}}]}})"
        "\n",
        t_s, time_ns, i < 10 ? "INITIALISING" : "MISALIGNED");
  }
  made::write_file(run / "alignment.csv", rows);
  made::write_file(run / "health.jsonl", health);
  const VehicleConfig vehicle = one_radar();
  const Score result = score_of(run, truth, &vehicle);
  const judge::FigureList& f = result.figures;
  EXPECT_NEAR(f.value("alignment.radar_1.rotation_z.error_deg"), 1.0, 1e-6);
  EXPECT_NEAR(f.value("alignment.radar_1.rotation_x.error_deg"), 0.0, 1e-6);
  EXPECT_NEAR(f.value("alignment.radar_1.speed_scale.error"), 0.001, 1e-9);
  EXPECT_EQ(f.value("alignment.false_step_changes"), 1.0);
  EXPECT_TRUE(std::isnan(f.value("alignment.radar_1.rotation_z.rms_deg"))) << "shorter than a minute";
  EXPECT_NEAR(f.value("health.radar_1.not_misaligned_though_beyond_tolerance_s"), 1.0, 1e-6);
  EXPECT_NEAR(f.value("health.radar_1.misaligned_though_within_tolerance_s"), 0.0, 1e-6);
  EXPECT_NEAR(f.value("health.radar_1.tolerance_yaw_deg"), 1.5, 1e-3);
  EXPECT_THAT(score_of(run, truth).notes, ::testing::Contains(HasSubstr("without a vehicle")));
}

const std::string kAlignmentHeader =
    "t_s,time_ns,radar,state,speed_scale,rotation_x_rad,rotation_y_rad,rotation_z_rad,cov_k_k,cov_x_x,cov_y_y,cov_z_z,"
    "step_changes,load_pitch_rad,load_pitch_std_rad\n";

/// Figures of a run whose estimate has this pitch of the mounting and this pitch by load after so many scans, with a
/// true load of 2° from `load_time_s` on.
Score score_of_loaded_car(double load_time_s, int last_scan, double mounting_pitch_deg, double load_pitch_deg) {
  const fs::path run = made::folder("car_run"), truth = made::folder("car_truth");
  made::write_run(run, kScans, 0.0);
  made::write_truth(truth, kScans);
  made::write_file(truth / "truth.csv",
                   fmt::format("quantity,radar,value,unit\nspeed_scale,,1.01,1\nside_slip_std,,0.2,deg\n"
                               "load_pitch,,2,deg\nload_time,,{},s\nalignment_yaw,1,0,deg\nalignment_pitch,1,0,deg\n"
                               "alignment_roll,1,0,deg\nrange_rate_scale,1,1.002,1\n",
                               load_time_s));
  const VehicleConfig vehicle = one_radar();
  const std::int64_t time_ns = made::kStart_ns + static_cast<std::int64_t>(last_scan) * 100'000'000;
  // Nose up is a negative rotation about the y axis.
  made::write_file(run / "alignment.csv",
                   kAlignmentHeader + fmt::format("{:.6f},{},1,converged,{},0,{},0,1e-6,1e-4,1e-4,1e-4,0,{},{}\n",
                                                  made::kPeriod_s * last_scan, time_ns, 1.01 * 1.002,
                                                  -mounting_pitch_deg * kRadiansPerDegree,
                                                  load_pitch_deg * kRadiansPerDegree, 0.5 * kRadiansPerDegree));
  made::write_file(run / "health.jsonl", "");
  return score_of(run, truth, &vehicle);
}

TEST(Score, ALaterLoadIsJudgedAsLoadAndNotAsMounting) {
  const Score before = score_of_loaded_car(2.0, 19, 0.0, 0.0), after = score_of_loaded_car(2.0, 20, 0.0, 1.5);
  for (const Score* each : {&before, &after}) {
    EXPECT_NEAR(each->figures.value("alignment.radar_1.rotation_y.error_deg"), 0.0, 1e-6);
  }
  EXPECT_NEAR(before.figures.value("alignment.radar_1.load_pitch.error_deg"), 0.0, 1e-6);
  EXPECT_NEAR(after.figures.value("alignment.radar_1.load_pitch.error_deg"), -0.5, 1e-6);
  EXPECT_NEAR(after.figures.value("alignment.radar_1.load_pitch.nees"), 1.0, 1e-6);
  const Score as_mounting = score_of_loaded_car(2.0, 20, 2.0, 0.0);
  EXPECT_NEAR(as_mounting.figures.value("alignment.radar_1.rotation_y.error_deg"), -2.0, 1e-6);
  EXPECT_THAT(after.notes, ::testing::Contains(HasSubstr("the load from 2 s on, which pitches the car by +2°")));
}

TEST(Score, ALoadFromTheStartIsPartOfTheTrueMounting) {
  const Score score = score_of_loaded_car(0.0, 20, 2.0, 0.0);
  EXPECT_NEAR(score.figures.value("alignment.radar_1.rotation_y.error_deg"), 0.0, 1e-6);
  EXPECT_NEAR(score.figures.value("alignment.radar_1.load_pitch.error_deg"), 0.0, 1e-6);
  EXPECT_THAT(score.notes, ::testing::Contains(HasSubstr("include the load, which pitches the car by +2°")));
}

TEST(Score, TheTrueSpeedScaleIncludesTheRadarsOwnScale) {
  const Score score = score_of_loaded_car(2.0, 19, 0.0, 0.0);
  EXPECT_NEAR(score.figures.value("alignment.radar_1.speed_scale.error"), 0.0, 1e-9);
  EXPECT_THAT(score.notes, ::testing::Contains(HasSubstr("radar 1 includes its own scale of range rates, 1.002")));
  EXPECT_THAT(score.notes, ::testing::Contains(HasSubstr("side slip of the car, 0.2°")));
}

TEST(Score, LoadDoesNotMakeARadarMisaligned) {
  const fs::path run = made::folder("load_run"), truth = made::folder("load_truth");
  made::write_run(run, kScans, 0.0);
  made::write_truth(truth, kScans);
  made::write_file(truth / "truth.csv",
                   "quantity,radar,value,unit\nspeed_scale,,1,1\nload_pitch,,5,deg\nload_time,,0,s\n"
                   "alignment_yaw,1,0,deg\nalignment_pitch,1,0,deg\nalignment_roll,1,0,deg\n");
  std::string health;
  for (int i = 0; i < kScans; ++i) {
    health += fmt::format(
        R"({{"t_s":{},"time_ns":{},"radars":[{{"radar":1,"data_qualifier":"AVAILABLE","extended_qualifier":"NORMAL"}}]}})"
        "\n",
        made::kPeriod_s * i, made::kStart_ns + static_cast<std::int64_t>(i) * 100'000'000);
  }
  made::write_file(run / "health.jsonl", health);
  const VehicleConfig vehicle = one_radar();
  const Score result = score_of(run, truth, &vehicle);
  EXPECT_NEAR(result.figures.value("health.radar_1.judged_s"), 3.0, 1e-6);
  EXPECT_EQ(result.figures.value("health.radar_1.not_misaligned_though_beyond_tolerance_s"), 0.0);
}

TEST(Score, ScansOfLateStampsAreJudgedAtTheTimeOfMeasurement) {
  const fs::path run = made::folder("late_run"), truth = made::folder("late_truth");
  // Stamps are 40 ms late, in which the car moves on by 0.04 m.
  made::write_run(run, kScans, -0.04);
  made::write_truth(truth, kScans);
  const auto along_m = [&] { return score_of(run, truth).figures.value("tracks.car.all_ranges.along_rms_m"); };
  EXPECT_NEAR(along_m(), 0.04, 1e-3);
  made::write_file(truth / "truth.csv", "quantity,radar,value,unit\nspeed_scale,,1,1\nstamp_offset,1,0.04,s\n");
  EXPECT_LT(along_m(), 0.01) << "only the first scan lies before the truth";
  EXPECT_THAT(score_of(run, truth).notes, ::testing::Contains(HasSubstr("radar 1 are +40.0 ms off")));
  made::write_file(truth / "truth.csv", "quantity,radar,value,unit\nstamp_offset,1,4,s\n");
  EXPECT_THAT(error_of([&] { static_cast<void>(score_of(run, truth)); }),
              HasSubstr("truth.csv:2: value: read \"4\", allowed is a number -1 … 1"));
}

TEST(Score, UnknownVisibilityIsNoted) {
  const fs::path run = made::folder("seen_run"), truth = made::folder("seen_truth");
  made::write_run(run, kScans, 0.0);
  made::write_truth(truth, kScans);
  EXPECT_THAT(score_of(run, truth).notes, ::testing::Contains(HasSubstr("visibility not known")));
  made::write_file(truth / "truth_visibility.csv", "t_s,object,state\n0,1,seen\n");
  EXPECT_THAT(score_of(run, truth).notes, ::testing::Not(::testing::Contains(HasSubstr("visibility not known"))));
}

TEST(Score, DamagedTablesAreNamedWithLineAndColumn) {
  const fs::path run = made::folder("damaged_run"), truth = made::folder("damaged_truth");
  const auto error = [&](const char* file, const std::string& from, const std::string& to) {
    made::write_run(run, kScans, 0.0);
    made::write_truth(truth, kScans);
    const fs::path path = fs::exists(run / file) ? run / file : truth / file;
    std::ostringstream content;
    content << std::ifstream(path).rdbuf();
    std::string text = content.str();
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    made::write_file(path, text.replace(at, from.size(), to));
    return error_of([&] { static_cast<void>(score_of(run, truth)); });
  };
  EXPECT_THAT(error("tracks.csv", "confirmed", "sure"),
              HasSubstr("tracks.csv:2: status: read \"sure\", allowed is tentative, confirmed"));
  EXPECT_THAT(error("tracks.csv", ",7,", ",0,"), HasSubstr("id: read \"0\", allowed is a whole number 1 …"));
  EXPECT_THAT(error("tracks.csv", "status", "state"), HasSubstr("the header lacks the column status"));
  EXPECT_THAT(error("detections.csv", "0.9", "1.9"), HasSubstr("detections.csv:2: p_moving: read \"1.9\""));
  EXPECT_THAT(error("detections.csv", ",0,moving", ",1,moving"), HasSubstr("detections.csv:2: index"));
  EXPECT_THAT(error("scans.csv", ",x\n", ",x,y\n"), HasSubstr("scans.csv:2: has 10 columns, the header has 9"));
  EXPECT_THAT(error("scans.csv", ",2,0,1,1,x", ",3,0,1,1,x"),
              HasSubstr("scan 1 of radar 1 has 2 detections, scans.csv states 3"));
  EXPECT_THAT(error("scans.csv", "radar,scan", "radar,radar"), HasSubstr("given twice"));
  EXPECT_THAT(error("truth_objects.csv", "20.000", "twenty"), HasSubstr("truth_objects.csv:2: x_vehicle_m"));
  EXPECT_THAT(error("truth_detections.csv", "clutter", "dust"), HasSubstr("truth_detections.csv:3: provenance"));
  EXPECT_THAT(error("truth_objects.csv", "0.5000,", "-0.5000,"), HasSubstr("t_s: read \"-0.5000\""));
}

TEST(Score, TruthWithoutTablesIsRefused) {
  const fs::path folder = made::folder("no_truth");
  EXPECT_THAT(error_of([&] { static_cast<void>(find_truth(folder)); }), HasSubstr("holds no truth"));
  made::write_file(folder / "table.csv", "a,b\n1,2\n");
  EXPECT_THAT(error_of([&] { static_cast<void>(find_truth(folder / "table.csv")); }),
              HasSubstr("is no table of objects"));
}

TEST(RunHealth, DamagedLineIsNamed) {
  const fs::path run = made::folder("health");
  const auto error = [&](const std::string& line) {
    made::write_file(run / "health.jsonl", "\n" + line + "\n");
    return error_of([&] {
      RunHealth health(run);
      RunVerdicts verdicts;
      static_cast<void>(health.next(verdicts));
    });
  };
  EXPECT_EQ(error(R"({"t_s":1.5,"time_ns":5,"radars":[{"radar":3,"extended_qualifier":"NORMAL"}]})"), "");
  EXPECT_THAT(error("{"), HasSubstr("health.jsonl:2: is no JSON object"));
  EXPECT_THAT(error(R"({"t_s":1,"radars":[]})"), HasSubstr("time_ns"));
  EXPECT_THAT(error(R"({"t_s":1,"time_ns":1,"radars":[{"radar":99,"extended_qualifier":"NORMAL"}]})"),
              HasSubstr("1 … 16"));
  EXPECT_THAT(error(R"({"t_s":1,"time_ns":1,"radars":[{"radar":1}]})"), HasSubstr("extended_qualifier"));
  EXPECT_THAT(error(R"({"t_s":1,"time_ns":1,"radars":[{"radar":1,"extended_qualifier":"TWISTED"}]})"),
              HasSubstr("\"TWISTED\" is no such word"));
  EXPECT_THAT(
      error(R"({"t_s":1,"time_ns":1,"radars":[{"radar":1,"extended_qualifier":"NORMAL","data_qualifier":"MAYBE"}]})"),
      HasSubstr("\"MAYBE\" is no such word"));
  EXPECT_THAT(error(R"({"t_s":1,"time_ns":1,"radars":[{"radar":1,"extended_qualifier":"NORMAL","data_qualifier":7}]})"),
              HasSubstr("data_qualifier: is no word"));
}

TEST(RunSummary, NumbersOfTheTimingAreTakenWithTheirPaths) {
  const fs::path run = made::folder("summary");
  made::write_file(
      run / "run.json",
      R"({"vehicle":"demo","radars":[{"id":2,"name":"a \"b\""}],"timing":{"wall_s":2.5,"stages":{"tracker":{"cpu_s":1}}}})");
  const RunSummary summary = read_run_summary(run);
  EXPECT_EQ(summary.vehicle, "demo");
  ASSERT_EQ(summary.radars.size(), 1u);
  EXPECT_EQ(summary.radars[0].second, "a \"b\"");
  ASSERT_EQ(summary.timing.size(), 2u);
  EXPECT_EQ(summary.timing[1].first, "stages.tracker.cpu_s");
  EXPECT_EQ(summary.timing[0].second, 2.5);
}

TEST(DetectionTruth, ScanOfARadarWithWrongStampsIsFoundByItsNumber) {
  const fs::path truth = made::folder("stamps");
  made::write_truth(truth, kScans);
  DetectionTruth late(truth / "truth_detections.csv", false);
  ASSERT_NE(late.find(1, 0.14, 2, 2), nullptr) << "40 ms late";
  EXPECT_EQ(late.find(1, 0.24, 3, 5), nullptr) << "another number of detections";
  EXPECT_EQ(late.find(2, 0.2, 3, 2), nullptr) << "another radar";
  const std::vector<TrueOrigin>* const origins = late.find(1, 0.3, 99, 2);
  ASSERT_NE(origins, nullptr);
  EXPECT_EQ(origins->at(1).cause, "burst");
}

TEST(DetectionTruth, StatesTheObjectOfADetectionIfTheTableDoes) {
  const fs::path truth = made::folder("objects_of_detections");
  made::write_file(truth / "with.csv", "t_s,radar,scan,index,provenance,object\n0,1,1,0,moving,7\n0,1,1,1,clutter,0\n");
  made::write_file(truth / "without.csv", "t_s,radar,scan,index,provenance\n0,1,1,0,moving\n");
  made::write_file(truth / "labels.csv", "t_s,radar,index,object,class\n0,1,0,7,car\n0,1,2,7,ghost_type_1\n");
  const auto origins_of = [&](const char* file, bool is_labels, bool has_objects, std::size_t detections) {
    DetectionTruth table(truth / file, is_labels);
    EXPECT_EQ(table.has_objects(), has_objects) << file;
    const std::vector<TrueOrigin>* const origins = table.find(1, 0.0, 1, detections);
    return origins == nullptr ? std::vector<TrueOrigin>(3) : *origins;
  };
  const std::vector<TrueOrigin> with = origins_of("with.csv", false, true, 2);
  EXPECT_EQ(with[0].object, 7u);
  EXPECT_EQ(with[1].object, 0u);
  EXPECT_EQ(origins_of("without.csv", false, false, 1)[0].object, 0u);
  const std::vector<TrueOrigin> labels = origins_of("labels.csv", true, true, 3);
  EXPECT_EQ(labels[0].provenance, Provenance::kMoving);
  EXPECT_EQ(labels[0].object, 7u);
  EXPECT_EQ(labels[1].object, 0u) << "no row";
  EXPECT_EQ(labels[2].provenance, Provenance::kGhostType1);
  EXPECT_EQ(labels[2].object, 7u) << "of its ghost, too";
}

TEST(Outputs, OfAScoreShowWhatIsUnknown) {
  const fs::path run = made::folder("outputs_run"), truth = made::folder("outputs_truth");
  made::write_run(run, kScans, 0.5);
  made::write_truth(truth, kScans);
  const NamedScore named{"my \"run\"", score_of(run, truth)};
  const std::string text = to_text(named);
  EXPECT_THAT(text, HasSubstr("car, all ranges"));
  EXPECT_THAT(text, HasSubstr("31 lists judged, 0 without truth; 0 pairs of track and object not considered"));
  EXPECT_THAT(text, HasSubstr("Alignment: –"));
  EXPECT_THAT(text, HasSubstr("Health: –"));
  EXPECT_THAT(text, HasSubstr("Time: –"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("nan")));
  const std::string json = to_json({named}, "truth", "0.1");
  EXPECT_THAT(json, HasSubstr("\"tracks.truck.all_ranges.tracked_share\": null"));
  EXPECT_THAT(json, HasSubstr("\"tracks.car.all_ranges.tracked_share\": 1.0"));
  EXPECT_THAT(json, HasSubstr("\"run\": \"my \\\"run\\\"\""));
  EXPECT_THAT(json, ::testing::Not(HasSubstr("nan")));
  EXPECT_THAT(to_comparison({named, named}), HasSubstr("tracked share of the time"));
}

TEST(Outputs, LimitThatIsExceededOrUnknownFails) {
  const fs::path run = made::folder("limits_run"), truth = made::folder("limits_truth");
  made::write_run(run, kScans, 0.5);
  made::write_truth(truth, kScans);
  const NamedScore named{"<run>", score_of(run, truth)};
  const std::string xml =
      to_junit({named}, {limit_of("tracks.car.all_ranges.along_rms_m=0.6"),
                         limit_of("tracks.car.all_ranges.along_rms_m=0.4"), limit_of("health.judged_s=1")});
  EXPECT_THAT(xml, HasSubstr("tests=\"3\" failures=\"2\""));
  EXPECT_THAT(xml, HasSubstr("classname=\"&lt;run&gt;\""));
  EXPECT_THAT(xml, HasSubstr("health.judged_s is –"));
  for (const char* const wrong : {"a", "a=", "=1", "a=x", "a=1x", "a=nan"}) {
    EXPECT_THROW(static_cast<void>(limit_of(wrong)), std::invalid_argument) << wrong;
  }
}

}  // namespace
}  // namespace boresight::score
