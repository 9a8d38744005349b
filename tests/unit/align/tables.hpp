// Drives as tables for the tests of the offline tool.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "services/simulator/alignment/drive.hpp"

namespace boresight::align::testing {

struct Tables {
  std::string drive, ego;
};

/// A cell of column `is_stationary`, from the truth.
using Truth = std::function<std::string(bool stationary)>;

/// Simulated, with every digit that floats have. Times begin at 1 s.
inline Tables simulated_tables(const simulator::AlignmentSpec& spec, const Truth& truth) {
  Tables tables{"t,radar,range,az,el,vr,is_stationary\n", "t,v,yaw_rate\n"};
  simulator::AlignmentDrive drive(spec);
  for (simulator::AlignmentEvent event; drive.next(event);) {
    if (event.ego != nullptr) {
      tables.ego += fmt::format("{:.6f},{},{}\n", event.time_s, event.ego->speed_mps, event.ego->yaw_rate_radps);
      continue;
    }
    const RadarScan& scan = *event.scan;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      const bool has_elevation = scan.has(scan_field::kElevation);
      tables.drive += fmt::format("{:.6f},{},{},{},{},{},{}\n", event.time_s, scan.header.source_id, scan.range_m[i],
                                  scan.azimuth_rad[i], has_elevation ? fmt::format("{}", scan.elevation_rad[i]) : "",
                                  scan.range_rate_mps[i], truth((*event.truth)[i].stationary));
    }
  }
  return tables;
}

inline void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace boresight::align::testing
