#include "services/health/dds/system_health.hpp"

#include <algorithm>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/names.hpp"
#include "services/health/core/faults/event.hpp"

namespace boresight::dds {

namespace {

diagnostics::DataQualifier to_qualifier(DataQualifier qualifier) {
  return static_cast<diagnostics::DataQualifier>(qualifier);
}

std::string conditions_of(const HealthReport& report) {
  std::string text;
  const std::size_t services = std::min<std::size_t>(report.number_of_services, kMaxServices);
  for (std::size_t i = 0; i < services; ++i) {
    const ServiceHealth& service = report.services[i];
    if (service.service >= catalogue::kNumberOfServices) continue;
    if (!text.empty()) text += ' ';
    text += catalogue::kServiceNames[service.service];
    text += ':';
    text += name_of(service.condition);
  }
  return text;
}

}  // namespace

std::string pipeline_trouble_codes(const PipelineHealth& pipeline) {
  std::string codes;
  for (std::size_t i = 0; i < kNumberOfPipelineEvents; ++i) {
    if ((pipeline.failed_events >> i & 1U) == 0) continue;
    if (!codes.empty()) codes += ' ';
    codes += health::code_text(health::dtc_of({health::kind_of(static_cast<PipelineEvent>(i))}));
  }
  return codes;
}

diagnostics::SystemHealth to_system_health(const HealthReport& report, const VehicleConfig& vehicle,
                                           std::int64_t time_ns) {
  diagnostics::PipelineHealth pipeline;
  pipeline.data_qualifier(to_qualifier(report.pipeline.data_qualifier));
  pipeline.trouble_codes(pipeline_trouble_codes(report.pipeline));
  pipeline.lost_scans(report.pipeline.lost_scans);
  pipeline.budget_hits(report.pipeline.budget_hits);
  pipeline.queueing_max_ms(report.pipeline.queueing_max_ms);
  pipeline.latency_p99_ms(report.pipeline.latency_p99_ms);
  diagnostics::SystemHealth out;
  out.vehicle_name(vehicle.name);
  out.time_ns(time_ns);
  out.overall(to_qualifier(report.overall));
  out.pipeline(pipeline);
  out.services(conditions_of(report));
  out.latency_p50_ms(report.latency_p50_ms);
  out.latency_max_ms(report.latency_max_ms);
  out.stored_trouble_codes(report.stored_events);
  return out;
}

}  // namespace boresight::dds
