// A heartbeat and the verdict on its service leave the ECU whole.
#include "services/health/dds/service_status.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "generated/service_statusPubSubTypes.h"
#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/names.hpp"
#include "tests/unit/dds/samples.hpp"

namespace boresight::dds {
namespace {

using StatusType = diagnostics::ServiceStatusPubSubType;

ServiceHealth tracker_health() {
  auto health = samples::distinct<ServiceHealth>();
  health.service = static_cast<std::uint32_t>(catalogue::Service::kTracker);
  health.condition = ServiceCondition::kDegraded;
  health.deadline_missed = 0;
  return health;
}

ServiceStatus heartbeat() {
  auto status = samples::distinct<ServiceStatus>();
  status.state = ServiceState::kDegraded;
  status.last_fault = {'b', 'a', 'd', ' ', 'f', 'r', 'a', 'm', 'e', '\0', 'x'};
  return status;
}

diagnostics::ServiceStatus status_sample(const ServiceHealth& health, const ServiceStatus* status) {
  diagnostics::ServiceStatus sample;
  fill(sample, health, status, "test car", 123);
  return sample;
}

TEST(ServiceStatusByDds, HasVerdictAndHeartbeatInTheirPlaces) {
  const ServiceHealth health = tracker_health();
  const auto status = std::make_unique<ServiceStatus>(heartbeat());
  const auto got = samples::received<StatusType>(status_sample(health, status.get()));
  EXPECT_EQ(got.service_name(), "tracker");
  EXPECT_EQ(got.vehicle_name(), "test car");
  EXPECT_EQ(got.time_ns(), 123);
  EXPECT_EQ(got.condition(), diagnostics::CONDITION_DEGRADED);
  EXPECT_FALSE(got.deadline_missed());
  EXPECT_EQ(got.last_heartbeat_s(), health.last_heartbeat_s);
  EXPECT_EQ(got.output_rate_hz(), health.output_rate_hz);
  EXPECT_EQ(got.window_latency_mean_us(), health.latency_mean_us);
  EXPECT_EQ(got.window_latency_max_us(), health.latency_max_us);
  EXPECT_EQ(got.restarts(), health.restarts);
  EXPECT_EQ(got.lost_inputs(), health.lost_inputs);
  EXPECT_EQ(got.dropped_inputs(), health.dropped_inputs);
  EXPECT_EQ(got.rejected_inputs(), health.rejected_inputs);
  EXPECT_TRUE(got.has_heartbeat());
  EXPECT_EQ(got.layout_version(), status->header.version);
  EXPECT_EQ(got.service_index(), status->header.source_id);
  EXPECT_EQ(got.sequence_number(), status->header.source_sequence);
  EXPECT_EQ(got.heartbeat_time_ns(), status->header.measurement_time_ns);
  EXPECT_EQ(got.incarnation_ns(), status->incarnation_ns);
  EXPECT_EQ(got.pid(), status->pid);
  EXPECT_EQ(got.state(), diagnostics::SERVICE_DEGRADED);
  EXPECT_EQ(got.inputs(), status->inputs);
  EXPECT_EQ(got.outputs(), status->outputs);
  EXPECT_EQ(got.heap_allocations(), status->heap_allocations);
  EXPECT_EQ(got.processing_mean_us(), status->processing_mean_us);
  EXPECT_EQ(got.processing_max_us(), status->processing_max_us);
  EXPECT_EQ(got.latency_mean_us(), status->latency_mean_us);
  EXPECT_EQ(got.latency_max_us(), status->latency_max_us);
  EXPECT_EQ(got.latency_count(), status->latency_count);
  EXPECT_EQ(got.queueing_max_us(), status->queueing_max_us);
  EXPECT_EQ(got.last_fault(), "bad frame");
}

TEST(ServiceStatusByDds, HasEveryFaultByNameAndEverySource) {
  const auto status = std::make_unique<ServiceStatus>(heartbeat());
  const auto got = samples::received<StatusType>(status_sample(tracker_health(), status.get()));
  ASSERT_EQ(got.faults().size(), kNumberOfFaults);
  for (std::size_t i = 0; i < kNumberOfFaults; ++i) {
    EXPECT_EQ(got.faults()[i].name(), name_of(static_cast<Fault>(i)));
    EXPECT_EQ(got.faults()[i].count(), status->faults[i]);
  }
  ASSERT_EQ(got.sources().size(), kMaxRadars);
  for (std::size_t i = 0; i < kMaxRadars; ++i) {
    const SourceStatistics& source = status->sources[i];
    EXPECT_EQ(got.sources()[i].radar_id(), source.source_id);
    EXPECT_EQ(got.sources()[i].conditions(), source.conditions);
    EXPECT_EQ(got.sources()[i].messages(), source.messages);
    EXPECT_EQ(got.sources()[i].rejected(), source.rejected);
    EXPECT_EQ(got.sources()[i].lost(), source.lost);
    EXPECT_EQ(got.sources()[i].suspect(), source.suspect);
    EXPECT_EQ(got.sources()[i].e2e_lost(), source.e2e_lost);
    EXPECT_EQ(got.sources()[i].e2e_repeated(), source.e2e_repeated);
    EXPECT_EQ(got.sources()[i].e2e_wrong(), source.e2e_wrong);
    EXPECT_EQ(got.sources()[i].last_measurement_time_ns(), source.last_measurement_time_ns);
  }
}

TEST(ServiceStatusByDds, DependsOnEveryByteOfTheHeartbeat) {
  const auto status = std::make_unique<ServiceStatus>(heartbeat());
  const ServiceHealth health = tracker_health();
  const auto bytes = [&](const ServiceStatus& s) { return samples::sent<StatusType>(status_sample(health, &s)); };
  std::vector<std::size_t> unused;
  samples::append(unused, offsetof(ServiceStatus, reserved), 3);
  samples::append(unused, offsetof(ServiceStatus, last_fault) + 10, 118);  // behind the end of the text
  EXPECT_EQ(samples::without_effect(*status, sizeof(MessageHeader), sizeof(ServiceStatus), bytes), unused);
}

TEST(ServiceStatusByDds, DependsOnEveryByteOfTheVerdict) {
  const auto status = std::make_unique<ServiceStatus>(heartbeat());
  const auto bytes = [&](const ServiceHealth& h) { return samples::sent<StatusType>(status_sample(h, status.get())); };
  std::vector<std::size_t> unused;
  samples::append(unused, offsetof(ServiceHealth, reserved), 2);
  // The heartbeat has these two.
  samples::append(unused, offsetof(ServiceHealth, processing_max_us), sizeof(float));
  samples::append(unused, offsetof(ServiceHealth, heap_allocations), sizeof(std::uint64_t));
  // Of the index only the lowest byte leads to another service's name.
  std::vector<std::size_t> found =
      samples::without_effect(tracker_health(), sizeof(float), sizeof(ServiceHealth), bytes);
  EXPECT_EQ(found, unused);
}

TEST(ServiceStatusByDds, StatesAServiceWithoutHeartbeat) {
  ServiceHealth health{};
  health.service = static_cast<std::uint32_t>(catalogue::Service::kGhostFilter);
  health.condition = ServiceCondition::kSilent;
  health.last_heartbeat_s = -1.0F;
  // The sample that a service with a heartbeat left behind.
  const auto status = std::make_unique<ServiceStatus>(heartbeat());
  diagnostics::ServiceStatus sample = status_sample(tracker_health(), status.get());
  fill(sample, health, nullptr, "test car", 124);
  EXPECT_EQ(sample.service_name(), "ghost_filter");
  EXPECT_EQ(sample.condition(), diagnostics::CONDITION_SILENT);
  EXPECT_FALSE(sample.has_heartbeat());
  EXPECT_EQ(sample.pid(), 0);
  EXPECT_TRUE(sample.sources().empty());
  EXPECT_EQ(sample.last_fault(), "");
}

TEST(ServiceStatusByDds, EndsATextThatFillsItsArray) {
  const auto status = std::make_unique<ServiceStatus>(heartbeat());
  status->last_fault.fill('x');
  EXPECT_EQ(status_sample(tracker_health(), status.get()).last_fault(), std::string(status->last_fault.size(), 'x'));
}

}  // namespace
}  // namespace boresight::dds
