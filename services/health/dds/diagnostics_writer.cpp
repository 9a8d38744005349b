#include "services/health/dds/diagnostics_writer.hpp"

#include <algorithm>
#include <chrono>

#include <fastdds/dds/publisher/DataWriter.hpp>

#include "generated/diagnostic_arrayPubSubTypes.h"
#include "generated/sensor_healthPubSubTypes.h"
#include "generated/system_healthPubSubTypes.h"
#include "services/health/dds/guarded_type.hpp"
#include "services/health/dds/system_health.hpp"
#include "services/health/dds/to_dds.hpp"

namespace boresight::dds {

DiagnosticsWriter::DiagnosticsWriter(Participant& participant, const VehicleConfig& vehicle)
    : vehicle_(vehicle),
      sensor_health_(
          participant.writer(kSensorHealthTopic, guarded<diagnostics::SensorHealthPubSubType>(kSensorHealthTopic))),
      system_health_(
          participant.writer(kSystemHealthTopic, guarded<diagnostics::SystemHealthPubSubType>(kSystemHealthTopic))),
      diagnostics_(participant.writer(
          kDiagnosticsTopic, guarded<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>(kDiagnosticsTopic))) {}

bool DiagnosticsWriter::write(const HealthReport& report, std::int64_t time_ns) {
  bool taken = true;
  const std::size_t sensors = std::min<std::size_t>(report.number_of_sensors, kMaxRadars);
  sent_radars_.clear();
  for (std::size_t i = 0; i < sensors; ++i) {
    diagnostics::SensorHealth sample = to_sensor_health(report, i, vehicle_, time_ns);
    taken = sensor_health_.write(&sample) && taken;
    sent_radars_.push_back(sample.radar_id());
  }
  diagnostics::SystemHealth system = to_system_health(report, vehicle_, time_ns);
  taken = system_health_.write(&system) && taken;
  sent_array_ = to_diagnostic_array(report, vehicle_, time_ns);
  return diagnostics_.write(&sent_array_) && taken;
}

void DiagnosticsWriter::end(std::int64_t time_ns, double at_most_s) {
  const eprosima::fastrtps::rtps::InstanceHandle_t by_key;
  // The writers dispose what they unregister.
  for (const std::uint32_t id : sent_radars_) {
    diagnostics::SensorHealth sample;
    sample.radar_id(id);
    sensor_health_.unregister_instance(&sample, by_key);
  }
  diagnostics::SystemHealth system;
  system.vehicle_name(vehicle_.name);
  if (!sent_array_.status_().empty()) system_health_.unregister_instance(&system, by_key);
  // This topic has no instances that could end.
  to_ended(sent_array_, time_ns);
  if (!sent_array_.status_().empty()) diagnostics_.write(&sent_array_);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(at_most_s);
  for (auto* const writer : {&sensor_health_, &system_health_, &diagnostics_}) {
    const std::chrono::duration<long double> left = end - std::chrono::steady_clock::now();
    if (left.count() > 0) writer->wait_for_acknowledgments(eprosima::fastrtps::Duration_t(left.count()));
  }
}

}  // namespace boresight::dds
