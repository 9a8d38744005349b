#include "services/boresight/run/writer.hpp"

#include <utility>

#include "services/boresight/run/rows.hpp"

namespace boresight::run {

namespace {
constexpr std::size_t kEnough_bytes = 1 << 16;
}

Writer::Writer(Put put, VehicleConfig vehicle, bool has_headers) : put_(std::move(put)), vehicle_(std::move(vehicle)) {
  if (has_headers) return;
  constexpr std::array<std::pair<File, std::string_view>, 7> kHeaders = {
      {{File::kScans, kScansHeader},
       {File::kDetections, kDetectionsHeader},
       {File::kReflectors, kReflectorsHeader},
       {File::kTracks, kTracksHeader},
       {File::kRoadEdges, kRoadEdgesHeader},
       {File::kCollisionWarnings, kCollisionWarningsHeader},
       {File::kAlignment, kAlignmentHeader}}};
  for (const auto& [file, header] : kHeaders) rows(file).append(header).append("\n");
}

void Writer::write(const ScanResult& result) {
  append_scan(rows(File::kScans), result);
  append_detections(rows(File::kDetections), result);
  append_reflectors(rows(File::kReflectors), result);
  append_tracks(rows(File::kTracks), result);
  append_road_edges(rows(File::kRoadEdges), result);
  append_collision_warnings(rows(File::kCollisionWarnings), result);
  hand_over(kEnough_bytes);
}

void Writer::write(const EstimateResult& result) {
  append_estimate(rows(File::kAlignment), result);
  hand_over(kEnough_bytes);
}

void Writer::write(const HealthResult& result) {
  rows(File::kHealth) += to_json_line(result, vehicle_);
  hand_over(kEnough_bytes);
}

void Writer::flush() {
  hand_over(1);
}

void Writer::hand_over(std::size_t least_bytes) {
  for (std::size_t i = rows_.size(); i-- > 0;) {
    if (rows_[i].size() < least_bytes) continue;
    put_(static_cast<File>(i), rows_[i]);
    rows_[i].clear();
  }
}

}  // namespace boresight::run
