// Any text as a table that `boresight run` and `boresight align` read. The first byte chooses detections or ego
// motions.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace {

using namespace boresight;

VehicleConfig two_radars() {
  VehicleConfig vehicle;
  for (const std::uint32_t id : {1u, 2u}) {
    RadarConfig radar;
    radar.id = id;
    radar.name = std::to_string(id);
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

void read_detections(recording::ByteSource& source, const VehicleConfig& vehicle, input::Problems& problems) {
  static const auto scan = std::make_unique<RadarScan>();
  input::DriveReader reader(source, vehicle, problems);
  std::uint64_t detections = 0;
  for (double time_s = NAN; reader.next(*scan, time_s);) {
    fuzz::require(std::abs(time_s) <= input::TimeOrder::kMax_s);
    fuzz::require(std::abs(1e-9 * static_cast<double>(reader.time_ns()) - time_s) < 1e-5);
    fuzz::require(vehicle.radar(scan->header.source_id) != nullptr);
    fuzz::require(scan->number_of_valid_detections >= 1 && scan->number_of_valid_detections <= kMaxDetections);
    fuzz::require(scan->has(scan_field::kAmbiguity) == (scan->range_rate_min_mps < scan->range_rate_max_mps));
    fuzz::require_finite(*scan);
    detections += scan->number_of_valid_detections;
  }
  fuzz::require(detections + reader.dropped_detections() == problems.lines() - problems.bad_lines());
}

void read_ego(recording::ByteSource& source, const VehicleConfig& vehicle, input::Problems& problems) {
  input::EgoReader reader(source, vehicle.ego, problems);
  std::uint64_t motions = 0;
  EgoMotion motion{};
  for (double time_s = NAN; reader.next(motion, time_s); ++motions) {
    fuzz::require(std::abs(time_s) <= input::TimeOrder::kMax_s);
    fuzz::require(std::isfinite(motion.speed_mps) && std::isfinite(motion.yaw_rate_radps));
  }
  fuzz::require(motions == problems.lines() - problems.bad_lines());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static fuzz::MemoryFile file;
  static const VehicleConfig vehicle = two_radars();
  file.fill({data + 1, size - 1});
  std::uint64_t reported = 0;
  input::Problems problems([&](const std::string& text) {
    ++reported;
    fuzz::require(text.find('\n') == std::string::npos);
  });
  try {
    recording::ByteSource source(file.path());
    if (data[0] % 2 == 0) {
      read_detections(source, vehicle, problems);
    } else {
      read_ego(source, vehicle, problems);
    }
  } catch (const input::TableError&) {
  }
  fuzz::require(reported == std::min(problems.bad_lines(), input::Problems::kShown));
  return 0;
}
