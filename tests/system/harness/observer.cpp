#include "tests/system/harness/observer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <sstream>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/node.hpp"

namespace boresight::harness {

namespace {

using catalogue::TopicId;

/// Whether the address lies in a mapping of a file under /dev/shm.
bool lies_in_shared_memory(const void* address) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream fields(line);
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    char dash = 0;
    fields >> std::hex >> begin >> dash >> end;
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    if (at >= begin && at < end) return line.find("/dev/shm/") != std::string::npos;
  }
  return false;
}

/// The last scans of one radar, for comparison with the output of later stages.
template <typename Scan>
class Recent {
 public:
  void add(const Scan& scan) { kept_[scan.header.source_id][next_++ % kDepth] = scan; }
  [[nodiscard]] const Scan* find(const MessageHeader& header) const {
    for (const Scan& scan : kept_[header.source_id]) {
      if (scan.header.measurement_time_ns == header.measurement_time_ns && header.measurement_time_ns != 0)
        return &scan;
    }
    return nullptr;
  }

 private:
  static constexpr std::size_t kDepth = 32;
  std::vector<std::vector<Scan>> kept_{kMaxRadars + 1, std::vector<Scan>(kDepth)};
  std::size_t next_ = 0;
};

std::uint8_t verdict(bool same) {
  return same ? 1 : 2;
}

/// The corrector divides by the radar's own scale of range rates.
bool is_corrected_rate(float measured, float corrected) {
  constexpr float kLargestScaleError = 0.01F;
  return std::abs(measured - corrected) <= kLargestScaleError * std::abs(measured);
}

std::uint8_t compare(const RadarScan* scan, const CorrectedScan& corrected) {
  if (scan == nullptr) return 0;
  const std::size_t n = scan->number_of_valid_detections;
  return verdict(corrected.number_of_valid_detections == n && corrected.cycle_counter == scan->cycle_counter &&
                 std::equal(scan->range_rate_mps.data(), scan->range_rate_mps.data() + n,
                            corrected.range_rate_mps.data(), is_corrected_rate) &&
                 std::equal(scan->range_m.data(), scan->range_m.data() + n, corrected.range_m.data()));
}

std::uint8_t compare(const CorrectedScan* corrected, const ClassifiedScan& classified) {
  if (corrected == nullptr) return 0;
  const std::size_t n = corrected->number_of_valid_detections;
  return verdict(
      classified.number_of_valid_detections == n &&
      std::equal(corrected->x_vehicle_m.data(), corrected->x_vehicle_m.data() + n, classified.x_vehicle_m.data()) &&
      std::equal(corrected->detection_flags.data(), corrected->detection_flags.data() + n,
                 classified.detection_flags.data()));
}

}  // namespace

Observer::Observer(const std::string& name, double pause_s)
    : process_(std::make_unique<Child>([&] { return observe(name, pause_s); })) {}

std::vector<const Sample*> Observer::of(TopicId topic, std::size_t from) const {
  std::vector<const Sample*> found;
  for (std::size_t i = from; i < size(); ++i) {
    if ((*this)[i].topic == topic) found.push_back(&(*this)[i]);
  }
  return found;
}

int Observer::observe(const std::string& name, double pause_s) {
  runtime::Node node(catalogue::Service::kMonitor, name);
  Recent<RadarScan> scans;
  Recent<CorrectedScan> corrected_scans;
  std::array<bool, catalogue::kNumberOfTopics> located{};
  std::array<bool, catalogue::kNumberOfTopics> shared{};

  const auto note = [&](TopicId topic, const MessageHeader& header, const auto& fill) {
    const std::size_t index = log_->size;
    if (index >= kMaxSamples) return;
    const auto at = static_cast<std::size_t>(topic);
    if (!located[at]) {
      located[at] = true;
      shared[at] = lies_in_shared_memory(&header);
    }
    Sample& sample = log_->samples[index];
    sample.topic = topic;
    sample.received_ns = runtime::monotonic_now_ns();
    sample.header = header;
    sample.in_shared_memory = shared[at];
    fill(sample);
    log_->size = index + 1;
  };

  node.on<RadarScan>([&](const RadarScan& scan) {
    note(TopicId::kRadarScan, scan.header, [&](Sample& s) { s.count = scan.number_of_valid_detections; });
    scans.add(scan);
    if (pause_s > 0.0) sleep_s(pause_s);
  });
  node.on<CorrectedScan>([&](const CorrectedScan& scan) {
    note(TopicId::kCorrectedScan, scan.header, [&](Sample& s) {
      s.count = scan.number_of_valid_detections;
      s.flags = scan.flags;
      s.alignment_sequence = scan.alignment_sequence;
      s.correspondence = compare(scans.find(scan.header), scan);
    });
    corrected_scans.add(scan);
  });
  node.on<ClassifiedScan>([&](const ClassifiedScan& scan) {
    note(TopicId::kClassifiedScan, scan.header, [&](Sample& s) {
      s.count = scan.number_of_valid_detections;
      s.flags = scan.flags;
      s.segments = scan.number_of_reflector_segments;
      for (std::size_t i = 0; i < std::min<std::size_t>(s.count, kMaxDetections); ++i) {
        const auto label = static_cast<std::size_t>(scan.provenance[i]);
        if (label < s.labels.size()) ++s.labels[label];
      }
      s.correspondence = compare(corrected_scans.find(scan.header), scan);
    });
  });
  node.on<TrackList>([&](const TrackList& list) {
    note(TopicId::kTrackList, list.header, [&](Sample& s) {
      s.count = list.number_of_tracks;
      s.confirmed_tracks = list.number_of_confirmed_tracks;
      s.flags = list.flags;
    });
  });
  node.on<EgoMotion>([&](const EgoMotion& ego) {
    note(TopicId::kEgoMotion, ego.header, [&](Sample& s) { s.values = {ego.speed_mps, ego.yaw_rate_radps}; });
  });
  node.on<AlignmentEstimate>([&](const AlignmentEstimate& estimate) {
    note(TopicId::kAlignmentEstimate, estimate.header, [&](Sample& s) {
      s.values = {estimate.speed_scale, estimate.alignment_yaw_rad};
    });
  });
  node.on<ServiceStatus>([&](const ServiceStatus& status) {
    note(TopicId::kServiceStatus, status.header, [&](Sample& s) { s.status = status; });
  });
  node.on<HealthReport>([&](const HealthReport& report) {
    note(TopicId::kHealthReport, report.header, [&](Sample& s) {
      s.overall = report.overall;
      s.pipeline = report.pipeline;
      for (std::size_t i = 0; i < std::min<std::size_t>(report.number_of_sensors, kMaxRadars); ++i) {
        const SensorHealth& sensor = report.sensors[i];
        if (sensor.radar_id >= s.sensor.size()) continue;
        s.sensor[sensor.radar_id] = static_cast<std::uint32_t>(sensor.data_qualifier);
        s.sensor_reason[sensor.radar_id] = static_cast<std::uint32_t>(sensor.extended_qualifier);
      }
      for (std::size_t i = 0; i < std::min<std::size_t>(report.number_of_services, kMaxServices); ++i) {
        const ServiceHealth& service = report.services[i];
        if (service.service >= s.services.size()) continue;
        s.services[service.service] = service.condition;
        s.dropped_inputs[service.service] = service.dropped_inputs;
        s.latency_max_us[service.service] = service.latency_max_us;
      }
    });
  });
  log_->attached = true;
  return node.spin();
}

}  // namespace boresight::harness
