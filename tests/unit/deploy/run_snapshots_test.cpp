// What a report knows of an offline run, from the tables of its folder.
#include "services/boresight/report/run_snapshots.hpp"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "services/boresight/report/html_report.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kRunStart_ns = 1'700'000'000'000'000'000;
constexpr double kTrueYaw_rad = 2.0 * kRadiansPerDegree;
constexpr double kRotationStd_rad = 0.1 * kRadiansPerDegree;

VehicleConfig one_radar() {
  VehicleConfig vehicle;
  RadarConfig& radar = vehicle.radars.emplace_back();
  radar.id = 2;
  radar.name = "front_left";
  radar.mounting_pose = {{3.6, 0.7, 0.5}, 45.0 * kRadiansPerDegree, 0.0, 0.0};
  radar.tolerance.yaw_rad = 1.5 * kRadiansPerDegree;
  return vehicle;
}

/// Three seconds of one radar at 10 Hz that is misaligned by 2° in yaw; health reports it from 1 s on.
class RunFolder {
 public:
  RunFolder() : folder_(std::filesystem::path(::testing::TempDir()) / "run_snapshots") {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    const Eigen::Vector3d turn =
        geometry::so3_log(geometry::sensor_to_vehicle(one_radar().radars[0].mounting_pose, kTrueYaw_rad, 0.0, 0.0) *
                          geometry::sensor_to_vehicle(one_radar().radars[0].mounting_pose, 0.0, 0.0, 0.0).transpose());
    std::string scans = "time_ns,radar,scan,detections,flags,sensor_x_m,sensor_y_m,ego_speed_mps,tracks,t_s\n";
    std::string detections =
        "time_ns,radar,scan,index,x_vehicle_m,y_vehicle_m,range_rate_over_ground_mps,origin,p_moving,p_stationary,"
        "p_ghost_type_1,p_ghost_type_2,p_clutter,p_ambiguity,rejected,t_s\n";
    std::string tracks =
        "time_ns,radar,scan,id,status,movement,x_vehicle_m,y_vehicle_m,vx_over_ground_mps,vy_over_ground_mps,age_s,"
        "heading_rad,length_m,width_m,detections,t_s\n";
    std::string alignment =
        "t_s,time_ns,radar,state,speed_scale,rotation_x_rad,rotation_y_rad,rotation_z_rad,cov_k_k,cov_x_x,cov_y_y,"
        "cov_z_z,cov_k_x,cov_k_y,cov_k_z,cov_x_y,cov_x_z,cov_y_z,observable,step_changes\n";
    std::string health;
    for (int k = 0; k < kScans; ++k) {
      const double t_s = 0.1 * k;
      const std::int64_t time_ns = kRunStart_ns + std::int64_t{100'000'000} * k;
      const std::string key = fmt::format("{},2,{}", time_ns, k + 1);
      scans += fmt::format("{},2,{},3.6,0.7,12.5,1,{}\n", key, k == 0 ? "no_tracks" : "", t_s);
      detections += fmt::format("{0},0,20,1,5,moving,1,0,0,0,0,0,,{1}\n{0},1,9,9,0,unknown,,,,,,,weak,{1}\n", key, t_s);
      tracks += fmt::format("{},7,confirmed,moving,20,1,10,0,2,0,4.5,1.8,1,{}\n", key, t_s);
      const double variance = kRotationStd_rad * kRotationStd_rad;
      alignment +=
          fmt::format("{},{},2,converged,1.01,{},{},{},1e-6,{},{},{},0,0,0,0,0,0,speed_scale+yaw+vehicle_yaw+slip,1\n",
                      t_s, time_ns, turn.x(), turn.y(), turn.z(), variance, variance, variance);
      health +=
          fmt::format(R"({{"t_s":{},"time_ns":{},"overall":"AVAILABLE","radars":[{{"radar":2,"data_qualifier":"{}",)"
                      R"("extended_qualifier":"{}","missed_scans":3}}]}})"
                      "\n",
                      t_s, time_ns, k < 10 ? "AVAILABLE" : "AVAILABLE_REDUCED", k < 10 ? "NORMAL" : "MISALIGNED");
    }
    write("scans.csv", scans);
    write("detections.csv", detections);
    write("tracks.csv", tracks);
    write("reflectors.csv", "time_ns,radar,scan,x1_vehicle_m,y1_vehicle_m,x2_vehicle_m,y2_vehicle_m,t_s\n");
    write("alignment.csv", alignment);
    write("health.jsonl", health);
  }
  void write(const char* name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  static constexpr int kScans = 30;

 private:
  std::filesystem::path folder_;
};

TEST(RunSnapshots, HoldWhatTheTablesOfAnOfflineRunState) {
  const RunFolder folder;
  const RunSnapshots run = snapshots_of_run(folder.path(), one_radar());
  EXPECT_EQ(run.problem, "");
  ASSERT_EQ(run.snapshots.size(), 6u) << "two a second, and one at the end";
  const monitor::Snapshot& last = run.snapshots.back();
  EXPECT_EQ(last.time_ns, kRunStart_ns + 2'900'000'000);
  EXPECT_EQ(last.ego_speed_mps, 12.5);
  EXPECT_TRUE(last.services.empty());
  ASSERT_EQ(last.radars.size(), 1u);
  const monitor::RadarSnapshot& radar = last.radars[0];
  EXPECT_EQ(radar.name, "front_left");
  EXPECT_EQ(radar.scans, 30u);
  EXPECT_EQ(radar.lost, 0u);
  EXPECT_EQ(radar.missed, 3u);
  EXPECT_EQ(radar.labels.of(Provenance::kMoving), 30u);
  EXPECT_EQ(radar.labels.rejected, 30u);
  EXPECT_EQ(radar.labels.scans_without_tracks, 1u);
  EXPECT_EQ(radar.extended_qualifier, ExtendedQualifier::kMisaligned);
  EXPECT_EQ(run.snapshots[0].radars[0].extended_qualifier, ExtendedQualifier::kNormal);
  EXPECT_NEAR(radar.yaw.value_rad, kTrueYaw_rad, 1e-6);
  EXPECT_NEAR(radar.yaw.std_rad, kRotationStd_rad, 1e-6);
  EXPECT_TRUE(radar.yaw.observable);
  EXPECT_FALSE(radar.roll.observable);
  EXPECT_FALSE(radar.details.slip.observable) << "the table does not hold its value";
  EXPECT_NEAR(radar.speed_scale, 1.01, 1e-6);
  EXPECT_NEAR(radar.speed_scale_std, 1e-3, 1e-8);
  ASSERT_EQ(last.tracks.size(), 1u);
  EXPECT_EQ(last.tracks[0].id, 7u);
}

TEST(RunSnapshots, ReportOfAnOfflineRunLeavesOutWhatOnlyServicesKnow) {
  const RunFolder folder;
  ReportInput input{};
  input.vehicle = one_radar();
  input.snapshots = snapshots_of_run(folder.path(), input.vehicle).snapshots;
  input.truth.yaw_rad = {{2, kTrueYaw_rad}};
  const Summary summary = summarise(input.snapshots, input.truth);
  EXPECT_TRUE(summary.all_passed()) << render_summary(summary);
  EXPECT_THAT(render_summary(summary), HasSubstr("front_left: MISALIGNED, yaw +2.0"));
  EXPECT_THAT(render_summary(summary), Not(HasSubstr("latency of a scan")));
  EXPECT_THAT(render_summary(summary), Not(HasSubstr("faults reported by services")));
  const std::string page = render_html(input);
  EXPECT_THAT(page, HasSubstr("An offline run has no latencies"));
  EXPECT_THAT(page, HasSubstr("no services run offline"));
  EXPECT_THAT(page, Not(HasSubstr("Errors of the vehicle's signals: ")));
  EXPECT_THAT(page, Not(::testing::ContainsRegex("[^a-z]nan[^a-z]"))) << "what is not known is a dash";
}

TEST(RunSnapshots, DamagedAlignmentFailsTheCheckAndKeepsTheRowsBefore) {
  const RunFolder folder;
  std::ofstream(folder.path() / "alignment.csv", std::ios::app) << "2.95,1700000000000000000,2,converged,fast\n";
  const RunSnapshots run = snapshots_of_run(folder.path(), one_radar());
  EXPECT_FALSE(run_check(run).passed);
  EXPECT_THAT(run_check(run).what, HasSubstr("alignment.csv:32: "));
  EXPECT_GE(run.snapshots.size(), 5u);
}

TEST(RunSnapshots, AlignmentAndHealthMayBeAbsent) {
  const RunFolder folder;
  std::filesystem::remove(folder.path() / "alignment.csv");
  std::filesystem::remove(folder.path() / "health.jsonl");
  const RunSnapshots run = snapshots_of_run(folder.path(), one_radar());
  EXPECT_TRUE(run_check(run).passed);
  ASSERT_EQ(run.snapshots.size(), 6u);
  EXPECT_FALSE(has_estimate(run.snapshots.back().radars[0]));
}

}  // namespace
}  // namespace boresight::report
