#include "services/health/dds/service_status.hpp"

#include <algorithm>
#include <string_view>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/names.hpp"
#include "services/health/dds/enumeration.hpp"

namespace boresight::dds {

namespace {

// A new layout of the messages needs a look at the IDL.
static_assert(ServiceStatus::kVersion == 5 && sizeof(SourceStatistics) == 72 && sizeof(ServiceHealth) == 64);
static_assert(kNumberOfFaults <= 32 && kMaxRadars == 16);
static_assert(static_cast<int>(ServiceCondition::kRestarted) == diagnostics::CONDITION_RESTARTED);
static_assert(static_cast<int>(ServiceState::kStopping) == diagnostics::SERVICE_STOPPING);

void fill_source(diagnostics::SourceStatistics& out, const SourceStatistics& source) {
  out.radar_id(source.source_id);
  out.conditions(source.conditions);
  out.messages(source.messages);
  out.rejected(source.rejected);
  out.lost(source.lost);
  out.suspect(source.suspect);
  out.e2e_lost(source.e2e_lost);
  out.e2e_repeated(source.e2e_repeated);
  out.e2e_wrong(source.e2e_wrong);
  out.last_measurement_time_ns(source.last_measurement_time_ns);
}

void fill_heartbeat(diagnostics::ServiceStatus& out, const ServiceStatus& status) {
  out.layout_version(status.header.version);
  out.service_index(status.header.source_id);
  out.sequence_number(status.header.source_sequence);
  out.heartbeat_time_ns(status.header.measurement_time_ns);
  out.incarnation_ns(status.incarnation_ns);
  out.pid(status.pid);
  out.state(enumerator(status.state, diagnostics::SERVICE_STOPPING));
  out.inputs(status.inputs);
  out.outputs(status.outputs);
  out.heap_allocations(status.heap_allocations);
  out.processing_mean_us(status.processing_mean_us);
  out.processing_max_us(status.processing_max_us);
  out.latency_mean_us(status.latency_mean_us);
  out.latency_max_us(status.latency_max_us);
  out.latency_count(status.latency_count);
  out.queueing_max_us(status.queueing_max_us);
  out.faults().resize(kNumberOfFaults);
  for (std::size_t i = 0; i < kNumberOfFaults; ++i) {
    out.faults()[i].name() = name_of(static_cast<Fault>(i));
    out.faults()[i].count(status.faults[i]);
  }
  const auto is_used = [](const SourceStatistics& source) { return source.source_id != 0; };
  out.sources().resize(static_cast<std::size_t>(std::count_if(status.sources.begin(), status.sources.end(), is_used)));
  auto next = out.sources().begin();
  for (const SourceStatistics& source : status.sources) {
    if (is_used(source)) fill_source(*next++, source);
  }
  const auto end = std::find(status.last_fault.begin(), status.last_fault.end(), '\0');
  out.last_fault().assign(status.last_fault.begin(), end);
}

}  // namespace

void fill(diagnostics::ServiceStatus& out, const ServiceHealth& health, const ServiceStatus* status,
          const std::string& vehicle_name, std::int64_t time_ns) {
  out.service_name() = health.service < catalogue::kNumberOfServices ? catalogue::kServiceNames[health.service] : "?";
  out.vehicle_name(vehicle_name);
  out.time_ns(time_ns);
  out.condition(enumerator(health.condition, diagnostics::CONDITION_RESTARTED));
  out.deadline_missed(health.deadline_missed != 0);
  out.last_heartbeat_s(health.last_heartbeat_s);
  out.output_rate_hz(health.output_rate_hz);
  out.window_latency_mean_us(health.latency_mean_us);
  out.window_latency_max_us(health.latency_max_us);
  out.restarts(health.restarts);
  out.lost_inputs(health.lost_inputs);
  out.dropped_inputs(health.dropped_inputs);
  out.rejected_inputs(health.rejected_inputs);
  out.has_heartbeat(status != nullptr);
  static const ServiceStatus kNoHeartbeat{};
  fill_heartbeat(out, status != nullptr ? *status : kNoHeartbeat);
}

}  // namespace boresight::dds
