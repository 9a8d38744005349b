// What a report states about ghosts, from the tables of a run folder and the truth of a drive.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "services/boresight/report/html_report.hpp"

namespace boresight::report {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kBegin_ns = 77'000'000'123'456;  // the ECU's clock at the start of the drive

/// Twenty seconds of two radars; each scan has one detection of a car, its ghost of type 2, and `k % 3` stationary
/// ones.
class Drive {
 public:
  Drive() {
    for (std::uint32_t radar : {1u, 2u}) {
      for (int k = 0; k < kScans; ++k) {
        judge::TrueScan scan{time_s(radar, k), {}};
        scan.detections.resize(2 + static_cast<std::size_t>(k % 3));
        scan.detections[0].provenance = Provenance::kMoving;
        scan.detections[1].provenance = Provenance::kGhostType2;
        for (std::size_t i = 2; i < scan.detections.size(); ++i) {
          scan.detections[i].provenance = Provenance::kStationary;
        }
        truth.scans[radar].push_back(std::move(scan));
      }
    }
    std::istringstream objects("header\n0.0,1,20,0,0,5,0,4.5,1.8,1.5,car,0\n100.0,1,20,0,0,5,0,4.5,1.8,1.5,car,0\n");
    truth.objects = judge::TrueObjects(objects);
  }
  static constexpr int kScans = 400;
  static double time_s(std::uint32_t radar, int k) { return 0.05 * k + 0.0125 * radar; }
  static std::int64_t time_ns(std::uint32_t radar, int k) {
    return kBegin_ns + static_cast<std::int64_t>(time_s(radar, k) * 1e9) + (k % 2 == 0 ? 400'000 : -400'000);
  }

  /// The scan as it was published, with the ghost at (20, 9) classified as `label`; then two tracks, one on the ghost.
  void publish(std::uint32_t radar, int k, const char* label) {
    const int detections = 2 + k % 3;
    const std::string key = fmt::format("{},{},{},{}", time_s(radar, k), time_ns(radar, k), radar, k);
    scans += fmt::format("{},{},,3.5,0.5,2\n", key, detections);
    for (int i = 0; i < detections; ++i) {
      const bool is_rejected = k % 3 == 2 && i == 3;
      rows +=
          fmt::format("{},{},20.0,{},0.0,{},{},{}\n", key, i, i == 1 ? "9.00" : "0.0",
                      i == 0   ? "moving"
                      : i == 1 ? label
                               : "stationary",
                      i == 1 ? "0.2,0.1,0.1,0.4,0.15,0.05" : "0.9,0.1,0,0,0,0", is_rejected ? "outside_region" : "");
    }
    reflectors += key + ",0.0,4.5,40.0,4.5\n";
    for (const int t : {0, 1}) {
      tracks +=
          fmt::format("{},{},confirmed,moving,20.0,{},5.0,0.0,2.0,0.0,4.5,1.8,1\n", key, 4 + t, t == 0 ? 0.0 : 9.0);
    }
  }
  /// All scans except the lost ones; the ghost is classified as moving in the first `mistakes` scans of each radar.
  void publish_all(int mistakes) {
    constexpr int kLost = 7;
    for (int k = kLost; k < kScans; ++k) {
      for (std::uint32_t radar : {1u, 2u}) {
        publish(radar, k, k < kLost + mistakes ? "moving" : "ghost_type_2");
      }
    }
  }

  /// Writes the tables, and returns their folder.
  [[nodiscard]] std::filesystem::path folder() const {
    const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "ghost_findings";
    std::filesystem::create_directories(folder);
    const auto write = [&folder](const char* name, const char* header, const std::string& text) {
      std::ofstream(folder / name) << header << '\n' << text;
    };
    write("scans.csv", "t_s,time_ns,radar,scan,detections,flags,sensor_x_m,sensor_y_m,tracks", scans);
    write("detections.csv",
          "t_s,time_ns,radar,scan,index,x_vehicle_m,y_vehicle_m,range_rate_over_ground_mps,origin,p_moving,"
          "p_stationary,p_ghost_type_1,p_ghost_type_2,p_clutter,p_ambiguity,rejected",
          rows);
    write("reflectors.csv", "t_s,time_ns,radar,scan,x1_vehicle_m,y1_vehicle_m,x2_vehicle_m,y2_vehicle_m", reflectors);
    write(
        "tracks.csv",
        "t_s,time_ns,radar,scan,id,status,movement,x_vehicle_m,y_vehicle_m,vx_over_ground_mps,vy_over_ground_mps,age_s,"
        "heading_rad,length_m,width_m,detections",
        tracks);
    return folder;
  }

  DetectionTruths truth;
  std::string scans, rows, reflectors, tracks;  // of the four tables
};

const Check& check_about(const std::vector<Check>& checks, const std::string& part) {
  static const Check none{"", false, false};
  for (const Check& check : checks) {
    if (check.what.find(part) != std::string::npos) return check;
  }
  ADD_FAILURE() << "no check about " << part;
  return none;
}

TEST(GhostFindings, ScansAreMatchedToTheTruthWhenTheFirstAreMissingAndClocksDiffer) {
  Drive drive;
  drive.publish_all(0);
  const GhostFindings found = find_ghosts(drive.folder(), &drive.truth);
  EXPECT_EQ(found.scans, 2u * 393u);
  EXPECT_EQ(found.compared_scans, 2u * 393u);
  EXPECT_EQ(found.unknown_scans, 0u);
  const judge::Confusion& c = found.confusion.value();
  EXPECT_EQ(c.count(Provenance::kMoving, Provenance::kMoving), 786u);
  EXPECT_EQ(c.count(Provenance::kGhostType2, Provenance::kGhostType2), 786u);
  EXPECT_EQ(c.rejected(Provenance::kStationary), 262u);
  EXPECT_TRUE(found.ghost_tracks.empty()) << "a detection classified as a ghost is no evidence of a track";
  EXPECT_TRUE(found.most_mistakes.detections.empty());
  for (const Check& check : ghost_checks(found)) EXPECT_TRUE(check.passed) << check.what;
}

TEST(GhostFindings, MistakesAndTracksOfGhostsAreCountedAndFail) {
  Drive drive;
  drive.publish_all(60);
  const GhostFindings found = find_ghosts(drive.folder(), &drive.truth);
  EXPECT_EQ(found.confusion->count(Provenance::kGhostType2, Provenance::kMoving), 120u);
  ASSERT_EQ(found.ghost_tracks.size(), 1u);
  EXPECT_EQ(found.ghost_tracks[0].tracking_id, 5u);
  EXPECT_EQ(found.ghost_tracks[0].scans, 120u);
  EXPECT_NEAR(found.ghost_tracks[0].since_s, static_cast<double>(Drive::time_ns(1, 7)) * 1e-9, 1e-4);
  EXPECT_EQ(found.most_mistakes.detections.at(1).truth, Provenance::kGhostType2);
  EXPECT_EQ(found.first_scan_ns, Drive::time_ns(1, 7));
  EXPECT_GE(found.most_mistakes.time_ns, found.first_scan_ns + 2'000'000'000) << "not of the first moments";
  EXPECT_EQ(found.most_mistakes.objects.size(), 1u);
  const std::vector<Check> checks = ghost_checks(found);
  const Check& ghosts = check_about(checks, "ghosts of type 2");
  EXPECT_EQ(ghosts.what, "84.7 % of 786 ghosts of type 2 were classified as ghosts (aim: at least 90 %)");
  EXPECT_FALSE(ghosts.passed);
  const Check& tracks = check_about(checks, "followed a ghost");
  EXPECT_EQ(tracks.what, "no confirmed track followed a ghost for more than 5 scans (1 did)");
  EXPECT_FALSE(tracks.passed);
  EXPECT_TRUE(check_about(checks, "moving objects").passed);
}

TEST(GhostFindings, ScansThatAreMissingInTheTruthAreNotCompared) {
  Drive drive;
  drive.publish_all(0);
  for (auto& scan : drive.truth.scans[2]) scan.detections.emplace_back();
  const GhostFindings found = find_ghosts(drive.folder(), &drive.truth);
  EXPECT_EQ(found.unknown_scans, 393u);
  EXPECT_EQ(found.confusion->count(Provenance::kMoving), 393u);
  EXPECT_FALSE(check_about(ghost_checks(found), "found in the truth").passed);
}

TEST(GhostFindings, WithoutTruthThereAreViewsAndNoVerdict) {
  Drive drive;
  drive.publish_all(60);
  const GhostFindings found = find_ghosts(drive.folder(), nullptr);
  EXPECT_FALSE(found.confusion);
  ASSERT_EQ(ghost_checks(found).size(), 1u) << "that the record could be read";
  EXPECT_TRUE(ghost_checks(found)[0].passed);
  ASSERT_EQ(found.most_ghosts.sensors.size(), 2u);
  EXPECT_FALSE(found.most_ghosts.detections.at(1).truth);
  EXPECT_EQ(found.most_ghosts.detections.at(1).label, Provenance::kGhostType2);
  EXPECT_EQ(found.most_ghosts.tracks.size(), 2u);
  EXPECT_NEAR(found.most_ghosts.sensors[0].age_s, 0.0125, 1e-6);
  EXPECT_TRUE(found.most_ghosts.objects.empty());
}

TEST(GhostFindings, ADamagedTableIsReportedWithFileLineAndColumn) {
  Drive drive;
  drive.publish_all(0);
  // The y of the second detection of the first scan.
  const std::size_t at = drive.rows.find(",9.00,");
  ASSERT_NE(at, std::string::npos);
  drive.rows.replace(at, 6, ",9<0,");
  const std::string file = (drive.folder() / "detections.csv").string();
  const GhostFindings found = find_ghosts(drive.folder(), &drive.truth);
  EXPECT_THAT(found.problem, HasSubstr(file));
  EXPECT_THAT(found.problem, HasSubstr("9<0"));
  const std::vector<Check> checks = ghost_checks(found);
  const Check& check = check_about(checks, "read to their end");
  EXPECT_FALSE(check.passed);
  EXPECT_FALSE(check.aim);
  EXPECT_EQ(check.what, "the tables of scans could not be read to their end: " + found.problem);
  ReportInput input;
  input.ghosts = found;
  EXPECT_THAT(render_html(input), HasSubstr("9&lt;0"));
}

TEST(GhostFindings, AScanWithFewerRowsThanItStatesIsReported) {
  Drive drive;
  drive.publish_all(0);
  drive.rows.erase(drive.rows.rfind('\n', drive.rows.size() - 2) + 1);
  const GhostFindings found = find_ghosts(drive.folder(), &drive.truth);
  EXPECT_THAT(found.problem, HasSubstr("scans.csv states 2"));
  EXPECT_EQ(found.scans, 785u) << "nothing before it is lost";
}

TEST(GhostFindings, AFolderWithoutScansIsNotJudged) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "ghost_findings_empty";
  std::filesystem::create_directories(folder);
  const GhostFindings found = find_ghosts(folder, nullptr);
  EXPECT_FALSE(found.is_recorded);
  EXPECT_TRUE(ghost_checks(found).empty());
}

TEST(GhostPage, ShowsMatrixTracksAndViews) {
  Drive drive;
  drive.publish_all(60);
  ReportInput input;
  input.ghosts = find_ghosts(drive.folder(), &drive.truth);
  const std::string page = render_html(input);
  for (const char* part :
       {"title=\"120\">15.27 %</td>", "<td>#5</td><td class=n>120</td>", "Most detections classified as ghosts: at ",
        "Most wrong labels after the first 2 s: at ",
        "radar 1: ghost type 2, truth: ghost type 2; 20.0 m ahead, 9.0 m left", "true object 1", "track #5"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  EXPECT_THAT(page, Not(ContainsRegex("[^A-Za-z]nan")));
}

TEST(GhostPage, StatesHowManyDetectionsLieOutsideTheView) {
  ReportInput input;
  input.ghosts.scans = 1;
  input.ghosts.most_ghosts.detections = {{1, 20.0F, 0.0F, 5.0F, 0.1F, Provenance::kMoving, false, std::nullopt},
                                         {1, 250.0F, 0.0F, 5.0F, 0.9F, Provenance::kGhostType2, false, std::nullopt},
                                         {1, NAN, 0.0F, 5.0F, 0.9F, Provenance::kGhostType2, false, std::nullopt},
                                         {1, 300.0F, 0.0F, 0.0F, 0.0F, Provenance::kStationary, false, std::nullopt}};
  const std::string page = render_html(input);
  EXPECT_THAT(
      page,
      HasSubstr("detections: 4, 2 of them classified as ghosts; 2 detections that are not stationary lie outside"));
  EXPECT_THAT(page, Not(ContainsRegex("[^A-Za-z]nan")));
}

TEST(GhostPage, StatesThatTheRecordOrTheTruthIsMissing) {
  EXPECT_THAT(render_html({}), HasSubstr("This run has no table of its scans, so there is no comparison"));
  EXPECT_THAT(render_html({}), HasSubstr("No scan of the ghost filter was received."));
  Drive drive;
  drive.publish_all(0);
  ReportInput input;
  input.ghosts = find_ghosts(drive.folder(), nullptr);
  const std::string page = render_html(input);
  EXPECT_THAT(page, HasSubstr("The true provenance of this drive's detections is not known"));
  EXPECT_THAT(page, Not(HasSubstr("differs from the truth")));
  EXPECT_THAT(page, Not(HasSubstr("Tracks that followed ghosts")));
}

}  // namespace
}  // namespace boresight::report
