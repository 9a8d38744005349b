// Any text as a table of truth, as `boresight score` reads it. The first byte chooses the table. A second text, after a
// zero byte, is the table of visibility.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/boresight/score/detection_truth.hpp"
#include "services/boresight/score/mounting_truth.hpp"
#include "services/boresight/score/object_truth.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace {

using namespace boresight;

/// Times at which the truth is asked for: a drive of some seconds, and a time far away.
constexpr std::array<double, 7> kTimes_s = {-5.0, 0.0, 0.05, 0.5, 1.0, 2.5, 1e6};
constexpr std::uint32_t kRadar = 1;

void read_objects(const fuzz::MemoryFile& file, bool is_boxes, const fuzz::MemoryFile* visibility) {
  const std::filesystem::path seen = visibility == nullptr ? "" : visibility->path();
  score::ObjectTruth truth(file.path(), is_boxes, seen);
  std::vector<judge::TrueObject> objects;
  for (const double t_s : kTimes_s) {
    if (!truth.at(t_s, objects)) continue;
    for (const judge::TrueObject& object : objects) {
      fuzz::require(object.box.position_m.allFinite() && object.box.velocity_mps.allFinite());
      fuzz::require(std::isfinite(object.box.heading_rad) && object.box.length_m >= 0.0 && object.box.width_m >= 0.0);
    }
  }
}

void read_detections(const fuzz::MemoryFile& file, bool is_labels) {
  score::DetectionTruth truth(file.path(), is_labels);
  for (const double t_s : kTimes_s) {
    constexpr std::size_t kDetections = 2;
    const auto* const origins = truth.find(kRadar, t_s, 1, kDetections);
    fuzz::require(origins == nullptr || origins->size() <= kDetections);
  }
}

VehicleConfig one_radar() {
  VehicleConfig vehicle;
  RadarConfig radar;
  radar.id = kRadar;
  vehicle.radars.push_back(radar);
  return vehicle;
}

void read_mountings(const score::TruthSource& source) {
  static const VehicleConfig vehicle = one_radar();
  score::MountingTruthReader truth(source, vehicle);
  for (const double t_s : kTimes_s) {
    const judge::MountingTruth at = truth.at(kRadar, t_s);
    if (at.has_rotation) fuzz::require(at.rotation.allFinite());
    static_cast<void>(truth.is_misaligned(kRadar, t_s));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static fuzz::MemoryFile table, visibility;
  const std::span<const std::uint8_t> texts(data + 1, size - 1);
  const auto length = static_cast<std::size_t>(std::find(texts.begin(), texts.end(), 0) - texts.begin());
  table.fill(texts.first(length));
  visibility.fill(texts.subspan(std::min(length + 1, texts.size())));
  score::TruthSource source;
  try {
    switch (data[0] % 7) {
      case 0:
        read_objects(table, false, nullptr);
        break;
      case 1:
        read_objects(table, true, nullptr);
        break;
      case 2:
        read_objects(table, true, &visibility);
        break;
      case 3:
        read_detections(table, false);
        break;
      case 4:
        read_detections(table, true);
        break;
      case 5:
        source.sensors = table.path();
        read_mountings(source);
        break;
      default:
        source.drive = table.path();
        read_mountings(source);
        break;
    }
    static_cast<void>(score::find_truth(table.path()));
  } catch (const score::InputError&) {
  }
  return 0;
}
