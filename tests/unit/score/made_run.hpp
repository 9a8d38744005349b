// A small run folder and its truth, written by hand: one car with one track, two scans of one radar each second.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>

namespace boresight::score::made {

namespace fs = std::filesystem;

inline constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
inline constexpr double kPeriod_s = 0.1;

inline void write_file(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// A new, empty folder.
inline fs::path folder(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("score_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

inline const std::string kTrackHeader =
    "t_s,time_ns,radar,scan,id,status,update,movement,class,existence,age_s,since_update_s,x_vehicle_m,y_vehicle_m,"
    "z_vehicle_m,vx_over_ground_mps,vy_over_ground_mps,heading_rad,length_m,width_m,height_m,detections,cov_x_x,"
    "cov_x_y,cov_y_y\n";

/// `scans` scans of radar 1 with two detections and a track `track_error_m` ahead of the car. `start_ns`: time of the
/// first scan.
inline void write_run(const fs::path& run, int scans, double track_error_m, std::int64_t start_ns = kStart_ns) {
  std::string scan_rows = "t_s,time_ns,radar,scan,detections,flags,tracks,confirmed,new_column\n";
  std::string detection_rows = "t_s,time_ns,radar,scan,index,origin,p_moving,rejected\n";
  std::string track_rows = kTrackHeader;
  for (int i = 0; i < scans; ++i) {
    const std::string key =
        fmt::format("{:.6f},{},1,{}", kPeriod_s * i, start_ns + static_cast<std::int64_t>(i) * 100'000'000, i + 1);
    scan_rows += key + ",2,0,1,1,x\n";
    detection_rows += key + ",0,moving,0.9,\n" + key + ",1,stationary,0.1,\n";
    track_rows +=
        fmt::format("{},7,confirmed,measured,moving,car,0.99,1,0,{:.3f},2,0,11,0,0,4.5,1.8,1.5,2,0.04,0,0.04\n", key,
                    20.0 + 1.0 * kPeriod_s * i + track_error_m);
  }
  write_file(run / "scans.csv", scan_rows);
  write_file(run / "detections.csv", detection_rows);
  write_file(run / "tracks.csv", track_rows);
}

/// The truth of the same drive: the car goes 1 m/s faster than the ego vehicle; rows every half second. `from_s`: time
/// of its first row on its own clock.
inline void write_truth(const fs::path& truth, int scans, double from_s = 0.0) {
  std::string objects =
      "t_s,object,x_vehicle_m,y_vehicle_m,heading_rad,vx_over_ground_mps,vy_over_ground_mps,length_m,width_m,height_m,"
      "kind,parked\n";
  std::string detections = "t_s,radar,scan,index,provenance,object,bounces,mirror,source,cause\n";
  for (int i = 0; i < scans; ++i) {
    const double t_s = from_s + kPeriod_s * i;
    if (i % 5 == 0 || i + 1 == scans) {
      objects += fmt::format("{:.4f},1,{:.3f},2,0,11,0,4.5,1.8,1.5,car,0\n", t_s, 20.0 + 1.0 * kPeriod_s * i);
    }
    detections +=
        fmt::format("{0:.6f},1,{1},0,moving,1,0,0,body,none\n{0:.6f},1,{1},1,clutter,0,0,0,none,burst\n", t_s, i + 1);
  }
  write_file(truth / "truth_objects.csv", objects);
  write_file(truth / "truth_detections.csv", detections);
}

}  // namespace boresight::score::made
