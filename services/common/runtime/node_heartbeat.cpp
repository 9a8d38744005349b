// The heartbeat of a node: its state and figures on the bus, its faults in the log, and the watchdog.
#include <algorithm>
#include <utility>

#include "interfaces/messages/names.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/node_impl.hpp"
#include "services/common/runtime/systemd.hpp"

namespace boresight::runtime {

void Node::Impl::count(std::int64_t processing_ns) {
  ++status.inputs;
  processing_sum_ns += static_cast<double>(processing_ns);
  ++processing_count;
  processing_max_ns = std::max(processing_max_ns, processing_ns);
}

void Node::Impl::count_latency(std::int64_t latency_ns) {
  latency_sum_ns += static_cast<double>(latency_ns);
  ++latency_count;
  latency_max_ns = std::max(latency_max_ns, latency_ns);
}

void Node::Impl::count_queueing(std::int64_t waited_ns) {
  queueing_max_ns = std::max(queueing_max_ns, waited_ns);
}

/// A service that starts or stops has no data flow, and its watchdog is stroked.
void Node::Impl::stroke_watchdog() {
  watch.begin_look(monotonic_now_ns());
  if (status.state == ServiceState::kRunning || status.state == ServiceState::kDegraded) {
    look_at_inputs();
    look_at_outputs();
  }
  const bool was_withheld = std::exchange(is_stroke_withheld, !watch.stroke_is_due());
  if (!is_stroke_withheld) systemd::stroke_watchdog();
  if (was_withheld == is_stroke_withheld) return;
  if (was_withheld) {
    log::info("the data flow makes progress again");
    return;
  }
  log::error("the data flow stalls, and the watchdog is not stroked: {}", watch.reason());
}

void Node::Impl::look_at_inputs() {
  for (auto& input : inputs) {
    const bool waits = input->port.hasData() || (input->newest && input->newest->is_any_waiting());
    watch.look_at(input->watched, waits, input->handled + input->refused, input->topic.deadline_ns, input->topic.name);
    watch.look_at(input->answers, input->topic.deadline_ns, input->topic.name);
  }
  if (descriptors.empty() || poll_descriptors(0) < 0) return;
  // The descriptors of the gateway carry scans.
  const std::int64_t limit_ns = catalogue::topic(catalogue::TopicId::kRadarScan).deadline_ns;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    watch.look_at(descriptors[i].watched, polled[i].revents != 0, descriptors[i].handled, limit_ns, "a descriptor");
  }
}

void Node::Impl::look_at_outputs() {
  for (const catalogue::Topic& topic : catalogue::kTopics) {
    // The heartbeat itself is no part of the data flow.
    if (topic.id == catalogue::TopicId::kServiceStatus) continue;
    WatchedOutput& watched = output(topic.id);
    watch.look_at(watched, topic.deadline_ns, topic.name);
    if (is_periodic[static_cast<std::size_t>(topic.id)]) watch.look_at_periodic(watched, topic.deadline_ns, topic.name);
  }
}

void Node::Impl::heartbeat() {
  stroke_watchdog();
  log_new_faults();
  if (!status_port) return;
  if (status.state == ServiceState::kRunning && degraded) status.state = ServiceState::kDegraded;
  if (status.state == ServiceState::kDegraded && !degraded) status.state = ServiceState::kRunning;
  status.heap_allocations = counted_allocations();
  status.processing_mean_us =
      processing_count == 0 ? 0.0F
                            : static_cast<float>(processing_sum_ns * 1e-3 / static_cast<double>(processing_count));
  status.processing_max_us = static_cast<float>(static_cast<double>(processing_max_ns) * 1e-3);
  status.latency_count = latency_count;
  status.latency_mean_us =
      latency_count == 0 ? 0.0F : static_cast<float>(latency_sum_ns * 1e-3 / static_cast<double>(latency_count));
  status.latency_max_us = static_cast<float>(static_cast<double>(latency_max_ns) * 1e-3);
  status.queueing_max_us = static_cast<float>(static_cast<double>(queueing_max_ns) * 1e-3);
  processing_sum_ns = latency_sum_ns = 0.0;
  processing_count = latency_count = 0;
  processing_max_ns = latency_max_ns = queueing_max_ns = 0;
  const Origin origin{.source_id = static_cast<std::uint32_t>(self),
                      .measurement_time_ns = monotonic_now_ns(),
                      .time_source = TimeSource::kUserArrival,
                      .stage = std::nullopt,
                      .begin_ns = 0};
  status_port->publish(origin, [this](ServiceStatus& message) {
    const MessageHeader header = message.header;
    message = status;
    message.header = header;
  });
}

void Node::Impl::log_new_faults() {
  // At most one line per heartbeat and kind of fault, with the sum since the last line. The next line of a kind comes
  // after a growing number of events (1, 2, 4, …), so that a permanent fault does not fill the journal.
  for (std::size_t i = 0; i < kNumberOfFaults; ++i) {
    const std::uint64_t total = status.faults[i];
    if (total == 0 || (logged_faults[i] != 0 && total < 2 * logged_faults[i])) continue;
    logged_faults[i] = total;
    log::warning("{}: {} so far; latest: {}", name_of(static_cast<Fault>(i)), total, status.last_fault.data());
  }
  const std::uint64_t allocations = counted_allocations();
  if (allocations > 2 * logged_allocations) {
    log::warning("{} heap allocations on the data path", allocations);
    logged_allocations = allocations;
  }
}

}  // namespace boresight::runtime
