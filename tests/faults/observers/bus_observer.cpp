// Prints what the domain publishes in shared memory, one JSON object a line, for the fault campaign. `at_ns` is the
// time of reception on CLOCK_MONOTONIC. Ends with the domain; the campaign starts another one for the next domain.
#include <cmath>
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/node.hpp"

namespace boresight {
namespace {

constexpr std::size_t kYawVariance =
    static_cast<std::size_t>(AlignmentParameter::kYaw) * (kNumberOfAlignmentParameters + 1);  // on the diagonal

/// One write() a line, so that a killed observer leaves no half of a line before a whole one.
void print(const std::string& line) {
  static_cast<void>(write(STDOUT_FILENO, line.data(), line.size()));
}

std::string text_of(const HealthReport& report) {
  std::string text =
      fmt::format(R"({{"at_ns":{},"topic":"health_report","sequence":{},"overall":{},"pipeline":{},"radars":[)",
                  runtime::monotonic_now_ns(), report.header.sequence, static_cast<int>(report.overall),
                  static_cast<int>(report.pipeline.data_qualifier));
  for (std::size_t i = 0; i < report.number_of_sensors && i < kMaxRadars; ++i) {
    const SensorHealth& sensor = report.sensors[i];
    text += fmt::format("{}[{},{},{}]", i == 0 ? "" : ",", sensor.radar_id, static_cast<int>(sensor.data_qualifier),
                        static_cast<int>(sensor.extended_qualifier));
  }
  text += R"(],"failed_events":[)";  // RadarEvent bits: which axis, for those who look into a finding
  for (std::size_t i = 0; i < report.number_of_sensors && i < kMaxRadars; ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ",", report.sensors[i].failed_events);
  text += R"(],"services":[)";
  for (std::size_t i = 0; i < report.number_of_services && i < kMaxServices; ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ",", static_cast<int>(report.services[i].condition));
  return text + "]}\n";
}

int observe() {
  runtime::log::initialise("observer");
  runtime::Node node(catalogue::Service::kMonitor, "-faults" + std::to_string(getpid()));
  // At the time of publication: on a busy machine the observer itself may be late.
  node.on<RadarScan>([](const RadarScan& scan) {
    print(fmt::format("{{\"at_ns\":{},\"topic\":\"radar_scan\",\"radar\":{}}}\n",
                      scan.header.stage(Stage::kIngest).end_ns, scan.header.source_id));
  });
  node.on<TrackList>([](const TrackList& list) {
    print(fmt::format("{{\"at_ns\":{},\"topic\":\"track_list\",\"radar\":{}}}\n",
                      list.header.stage(Stage::kTracker).end_ns, list.header.source_id));
  });
  node.on<AlignmentEstimate>([](const AlignmentEstimate& estimate) {
    print(
        fmt::format("{{\"at_ns\":{},\"topic\":\"alignment_estimate\",\"radar\":{},\"sequence\":{},\"yaw_rad\":{:.6f},"
                    "\"yaw_std_rad\":{:.6f}}}\n",
                    runtime::monotonic_now_ns(), estimate.header.source_id, estimate.header.sequence,
                    estimate.vehicle_yaw_rad, std::sqrt(estimate.vehicle_covariance[kYawVariance])));
  });
  node.on<HealthReport>([](const HealthReport& report) { print(text_of(report)); });
  print(fmt::format("{{\"at_ns\":{},\"topic\":\"attached\"}}\n", runtime::monotonic_now_ns()));
  return node.spin();
}

}  // namespace
}  // namespace boresight

int main() {
  return boresight::observe();
}
