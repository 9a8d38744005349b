// What a report states about ghosts, from a record of scans and the truth of a drive.
#include <memory>
#include <sstream>

#include "services/boresight/monitor/scan_record.hpp"
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
  void publish(std::uint32_t radar, int k, Provenance label) {
    ClassifiedScan& scan = *scan_;
    scan = {};
    scan.header.source_id = radar;
    scan.header.measurement_time_ns = time_ns(radar, k);
    scan.number_of_valid_detections = static_cast<std::uint32_t>(2 + k % 3);
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      scan.x_vehicle_m[i] = 20.0F;
      scan.y_vehicle_m[i] = i == 1 ? 9.0F : 0.0F;
      scan.provenance[i] = i == 0 ? Provenance::kMoving : i == 1 ? label : Provenance::kStationary;
    }
    if (k % 3 == 2) scan.detection_flags[3] = corrected_flag::kOutsideRegion;
    scan.number_of_reflector_segments = 1;
    scan.reflector_segments[0] = {{0.0F, 4.5F}, {40.0F, 4.5F}, 0.1F, 9};
    monitor::write_scan(record, scan);
    TrackList& list = *tracks_;
    list = {};
    list.header.source_id = radar;
    list.header.measurement_time_ns = time_ns(radar, k);
    list.number_of_tracks = list.number_of_confirmed_tracks = 2;
    for (std::size_t t : {0u, 1u}) {
      Track& track = list.tracks[t];
      track.tracking_id = static_cast<std::uint32_t>(4 + t);
      track.status = TrackStatus::kConfirmed;
      track.position_vehicle_m = {20.0F, t == 0 ? 0.0F : 9.0F, 0.0F};
      track.length_m = 4.5F;
      track.width_m = 1.8F;
      track.number_of_detections = 1;
    }
    monitor::write_tracks(record, list);
  }
  /// All scans except the lost ones; the ghost is classified as moving in the first `mistakes` scans of each radar.
  void publish_all(int mistakes) {
    constexpr int kLost = 7;
    for (int k = kLost; k < kScans; ++k) {
      for (std::uint32_t radar : {1u, 2u}) {
        publish(radar, k, k < kLost + mistakes ? Provenance::kMoving : Provenance::kGhostType2);
      }
    }
  }

  DetectionTruths truth;
  std::stringstream record;

 private:
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
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
  const GhostFindings found = find_ghosts(drive.record, "scans.txt", &drive.truth);
  EXPECT_EQ(found.scans, 2u * 393u);
  EXPECT_EQ(found.track_lists, 2u * 393u);
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
  const GhostFindings found = find_ghosts(drive.record, "scans.txt", &drive.truth);
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
  const GhostFindings found = find_ghosts(drive.record, "scans.txt", &drive.truth);
  EXPECT_EQ(found.unknown_scans, 393u);
  EXPECT_EQ(found.confusion->count(Provenance::kMoving), 393u);
  EXPECT_FALSE(check_about(ghost_checks(found), "found in the truth").passed);
}

TEST(GhostFindings, WithoutTruthThereAreViewsAndNoVerdict) {
  Drive drive;
  drive.publish_all(60);
  const GhostFindings found = find_ghosts(drive.record, "scans.txt", nullptr);
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

TEST(GhostFindings, DamagedLinesAreReportedWithFileAndLine) {
  Drive drive;
  drive.publish_all(0);
  const std::string whole = drive.record.str();
  // Damages the y of the second detection of the first scan, and the end of the last track list.
  std::string text = whole.substr(0, whole.size() - 20);
  const std::size_t at = text.find(" 9.00 ");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 6, " 9<0 ");
  std::istringstream record(text);
  const GhostFindings found = find_ghosts(record, "out/scans.txt", &drive.truth);
  EXPECT_EQ(found.damaged.count, 2u);
  EXPECT_EQ(found.damaged.first, "out/scans.txt:1: y of detection 2 is '9<0', allowed: a number");
  EXPECT_EQ(found.scans, 785u) << "nothing else is lost";
  EXPECT_EQ(found.track_lists, 785u);
  const std::vector<Check> checks = ghost_checks(found);
  const Check& check = check_about(checks, "could be read");
  EXPECT_FALSE(check.passed);
  EXPECT_FALSE(check.aim);
  EXPECT_EQ(check.what,
            "every line of the record of scans could be read (2 damaged; first: out/scans.txt:1: y of detection "
            "2 is '9<0', allowed: a number)");
  ReportInput input;
  input.ghosts = found;
  const std::string page = render_html(input);
  EXPECT_THAT(page, HasSubstr("2 lines of the record of scans could not be read"));
  EXPECT_THAT(page, HasSubstr("The first line: <code>out/scans.txt:1: y of detection 2 is '9&lt;0'"));

  std::istringstream nothing_whole("scan 1\n");
  input.ghosts = find_ghosts(nothing_whole, "scans.txt", nullptr);
  EXPECT_FALSE(check_about(ghost_checks(input.ghosts), "could be read").passed);
  const std::string empty_page = render_html(input);
  EXPECT_THAT(empty_page, HasSubstr("One line of the record of scans could not be read"));
  EXPECT_THAT(empty_page, HasSubstr("scans.txt:1: ends before source sequence"));
  EXPECT_THAT(empty_page, Not(HasSubstr("no record of its scans")));
}

TEST(GhostPage, ShowsMatrixTracksAndViews) {
  Drive drive;
  drive.publish_all(60);
  ReportInput input;
  input.ghosts = find_ghosts(drive.record, "scans.txt", &drive.truth);
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
  EXPECT_THAT(render_html({}), HasSubstr("This run has no record of its scans, so there is no comparison"));
  EXPECT_THAT(render_html({}), HasSubstr("No scan of the ghost filter was received."));
  Drive drive;
  drive.publish_all(0);
  ReportInput input;
  input.ghosts = find_ghosts(drive.record, "scans.txt", nullptr);
  const std::string page = render_html(input);
  EXPECT_THAT(page, HasSubstr("The true provenance of this drive's detections is not known"));
  EXPECT_THAT(page, Not(HasSubstr("differs from the truth")));
  EXPECT_THAT(page, Not(HasSubstr("Tracks that followed ghosts")));
}

}  // namespace
}  // namespace boresight::report
