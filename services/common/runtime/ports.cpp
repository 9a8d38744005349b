#include "services/common/runtime/ports.hpp"

#include <stdexcept>
#include <string>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/node_impl.hpp"

namespace boresight::runtime::detail {

namespace {

iox::capro::IdString_t id_string(std::string_view text) {
  return iox::capro::IdString_t(iox::cxx::TruncateToCapacity, text.data(), text.size());
}

}  // namespace

iox::capro::ServiceDescription service_description(const catalogue::Topic& topic) {
  return {id_string("boresight"), id_string(topic.name), id_string(topic.type)};
}

std::unique_ptr<PublisherPort, PublisherPortDeleter> open_publisher(Node& node, const catalogue::Topic& topic) {
  if (!topic.writers.contains(node.self())) {
    throw std::logic_error(std::string(catalogue::name_of(node.self())) + " is not a writer of " +
                           std::string(topic.name) + " in the catalogue");
  }
  iox::popo::PublisherOptions options;
  options.historyCapacity = topic.history;
  options.subscriberTooSlowPolicy = iox::popo::ConsumerTooSlowPolicy::DISCARD_OLDEST_DATA;
  return std::unique_ptr<PublisherPort, PublisherPortDeleter>(
      new PublisherPort(node, topic, service_description(topic), options));
}

void PublisherPortDeleter::operator()(PublisherPort* port) const {
  delete port;
}

void* loan(PublisherPort& port) {
  constexpr std::uint32_t kCacheLine = 64;
  auto result = port.port.loan(static_cast<std::uint32_t>(port.topic.payload_bytes), kCacheLine);
  if (result.has_error()) {
    port.node.fault(Fault::kLoanFailed, port.topic.name);
    port.node.impl().output(port.topic.id).missed(monotonic_now_ns(), port.topic.deadline_ns);
    return nullptr;
  }
  return result.value();
}

void release(PublisherPort& port, void* payload) {
  port.port.release(payload);
}

void send(PublisherPort& port, void* payload, std::uint32_t version, const Origin& origin,
          const MessageHeader* upstream) {
  auto& header = *static_cast<MessageHeader*>(payload);
  header.version = version;
  header.source_id = origin.source_id;
  header.sequence = ++port.sequence;
  header.source_sequence = ++port.source_sequence[origin.source_id % port.source_sequence.size()];
  header.measurement_time_ns = origin.measurement_time_ns;
  header.time_source = origin.time_source;
  header.reserved = {};
  header.stages = upstream != nullptr ? upstream->stages : decltype(header.stages){};
  Node::Impl& node = port.node.impl();
  if (origin.stage) {
    const std::int64_t begin_ns = upstream != nullptr ? node.event_begin_ns : origin.begin_ns;
    const std::int64_t end_ns = monotonic_now_ns();
    header.stage(*origin.stage) = {begin_ns, end_ns};
    const std::int64_t arrival_ns = header.stage(Stage::kIngest).begin_ns;
    if (arrival_ns > 0 && arrival_ns <= end_ns) node.count_latency(end_ns - arrival_ns);
  }
  port.port.publish(payload);
  node.output(port.topic.id).published();
  if (port.topic.id != catalogue::TopicId::kServiceStatus) ++node.status.outputs;
}

}  // namespace boresight::runtime::detail
