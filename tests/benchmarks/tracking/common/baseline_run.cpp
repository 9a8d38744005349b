#include "tests/benchmarks/tracking/common/baseline_run.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "services/boresight/score/table.hpp"

namespace boresight::bench {

namespace {

namespace fs = std::filesystem;

constexpr double kAnything = 1e9;
/// Columns of the covariance over (x, y, vx, vy), upper triangle row by row.
constexpr std::array<const char*, 4> kStateNames = {"x", "y", "vx", "vy"};

std::string covariance_header() {
  std::string header;
  for (std::size_t row = 0; row < kStateNames.size(); ++row) {
    for (std::size_t column = row; column < kStateNames.size(); ++column) {
      header += fmt::format(",cov_{}_{}", kStateNames.at(row), kStateNames.at(column));
    }
  }
  return header;
}

std::string row_of(const std::string& key, const BaselineTrack& track, const BaselineSettings& settings) {
  std::string row =
      fmt::format("{},{},{},{},moving,unknown,,{:.3f},{:.3f},{:.4f},{:.4f},0,{:.4f},{:.4f},{:.5f},{},{},0,{}", key,
                  track.id, track.confirmed ? "confirmed" : "tentative", track.measured ? "measured" : "predicted",
                  track.age_s, track.since_update_s, track.position_m.x(), track.position_m.y(), track.velocity_mps.x(),
                  track.velocity_mps.y(), std::atan2(track.velocity_mps.y(), track.velocity_mps.x()), settings.length_m,
                  settings.width_m, track.detections);
  for (Eigen::Index i = 0; i < track.covariance.rows(); ++i) {
    for (Eigen::Index j = i; j < track.covariance.cols(); ++j) row += fmt::format(",{:.6g}", track.covariance(i, j));
  }
  return row + fmt::format(",{}\n", track.hits);
}

}  // namespace

void run_baseline(const fs::path& run, const VehicleConfig& vehicle, const fs::path& out,
                  const BaselineSettings& settings) {
  score::Table scans(run / "scans.csv", {"t_s", "time_ns", "radar", "scan", "detections", "sensor_x_m", "sensor_y_m",
                                         "sensor_vx_mps", "sensor_vy_mps", "ego_speed_mps", "ego_yaw_rate_radps"});
  score::Table rows(run / "detections.csv", {"time_ns", "radar", "scan", "x_vehicle_m", "y_vehicle_m",
                                             "range_rate_over_ground_mps", "rejected"});
  fs::create_directories(out);
  std::ofstream scans_out(out / "scans.csv"), tracks_out(out / "tracks.csv");
  scans_out << "t_s,time_ns,radar,scan,detections,moving,tracks,confirmed\n";
  tracks_out << "t_s,time_ns,radar,scan,id,status,update,movement,class,existence,age_s,since_update_s,x_vehicle_m,"
                "y_vehicle_m,z_vehicle_m,vx_over_ground_mps,vy_over_ground_mps,heading_rad,length_m,width_m,height_m,"
                "detections" +
                    covariance_header() + ",hits\n";
  BaselineTracker tracker(vehicle, settings);
  bool has_row = rows.next();
  std::vector<BaselineDetection> detections;
  while (scans.next()) {
    const std::string scan_key =
        fmt::format("{},{},{}", scans.text("time_ns"), scans.text("radar"), scans.text("scan"));
    detections.clear();
    for (; has_row && scan_key == fmt::format("{},{},{}", rows.text("time_ns"), rows.text("radar"), rows.text("scan"));
         has_row = rows.next()) {
      if (!rows.text("rejected").empty()) continue;
      const auto number = [&rows](const char* column) { return rows.number_or_nan(column, -kAnything, kAnything); };
      detections.push_back({{number("x_vehicle_m"), number("y_vehicle_m")}, number("range_rate_over_ground_mps")});
    }
    // Empty without ego motion: the range rates are not compensated then, and no detection counts as moving.
    const auto number = [&scans](const char* column) {
      const double value = scans.number_or_nan(column, -kAnything, kAnything);
      return std::isnan(value) ? 0.0 : value;
    };
    BaselineScan scan;
    scan.t_s = number("t_s");
    scan.radar = static_cast<std::uint32_t>(scans.integer("radar", 1, std::numeric_limits<std::int32_t>::max()));
    scan.sensor_m = {number("sensor_x_m"), number("sensor_y_m")};
    scan.sensor_velocity_mps = {number("sensor_vx_mps"), number("sensor_vy_mps")};
    scan.ego_speed_mps = number("ego_speed_mps");
    scan.ego_yaw_rate_radps = number("ego_yaw_rate_radps");
    scan.detections = detections;
    tracker.step(scan);
    const std::vector<BaselineTrack> tracks = tracker.tracks();
    std::size_t confirmed = 0, moving = 0;
    for (const BaselineDetection& detection : detections) moving += tracker.is_moving(detection, scan) ? 1 : 0;
    const std::string key = fmt::format("{},{}", scans.text("t_s"), scan_key);
    for (const BaselineTrack& track : tracks) {
      confirmed += track.confirmed ? 1 : 0;
      tracks_out << row_of(key, track, settings);
    }
    scans_out << fmt::format("{},{},{},{},{}\n", key, scans.text("detections"), moving, tracks.size(), confirmed);
  }
  scans_out.flush();
  tracks_out.flush();
  if (!scans_out || !tracks_out) throw std::runtime_error(out.string() + ": cannot be written");
}

}  // namespace boresight::bench
