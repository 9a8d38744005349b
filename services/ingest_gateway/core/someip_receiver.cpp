#include "services/ingest_gateway/core/someip_receiver.hpp"

#include <algorithm>

#include "interfaces/wire/boresight_service.hpp"
#include "services/ingest_gateway/codecs/protection.hpp"
#include "services/ingest_gateway/codecs/someip/fault_kinds.hpp"

namespace boresight::ingest {

namespace wire_service = wire::boresight_service;

namespace {

// Segments of one message are sent within 5 ms; an incomplete message is dropped long before the second next cycle.
constexpr std::int64_t kReassemblyTimeout_ns = 100'000'000;

}  // namespace

std::size_t SomeIpReceiver::add(Source& source, std::uint16_t event, const E2eConfig& e2e) {
  // Messages have the E2E header also if the check is off.
  const std::size_t body_offset = e2e.protection.offset_bytes + e2e::header_bytes(e2e.protection.profile) -
                                  (someip::kHeaderBytes - wire_service::kProtectedFrom);
  subscriptions_.push_back({&source, event, e2e.required, body_offset, e2e::Checker(e2e.protection), std::nullopt});
  return subscriptions_.size() - 1;
}

void SomeIpReceiver::set_server(std::size_t index, const std::optional<recording::Endpoint>& server) {
  Subscription& subscription = subscriptions_[index];
  // A restarted server also restarts its counter; its first message has no predecessor.
  if (subscription.server != server) subscription.checker.reset();
  subscription.server = server;
}

bool SomeIpReceiver::knows(const recording::Endpoint& server) const {
  return std::any_of(subscriptions_.begin(), subscriptions_.end(),
                     [&](const Subscription& s) { return s.server == server; });
}

void SomeIpReceiver::prepare() {
  // Two messages per source: a segment with a damaged header starts another message that never ends.
  if (!subscriptions_.empty()) {
    reassembler_.emplace(2 * subscriptions_.size(), wire_service::kMaxMessageBytes, kReassemblyTimeout_ns);
  }
}

void SomeIpReceiver::tick(std::int64_t now_ns) {
  if (!reassembler_) return;
  reassembler_->expire(now_ns);
  const std::uint64_t incomplete = reassembler_->statistics().dropped_incomplete;
  for (; incomplete_reported_ < incomplete; ++incomplete_reported_) {
    sink_.fault(Fault::kWireLength, "SOME/IP-TP: a message was dropped because segments are missing", 0);
  }
}

void SomeIpReceiver::fault_of_sender(const recording::Endpoint& sender, Fault fault, std::string_view what) {
  std::uint32_t radar_id = 0;  // if ego motion has the same endpoint, faults count for the radar
  for (const Subscription& subscription : subscriptions_) {
    if (subscription.server == sender) radar_id = std::max(radar_id, subscription.source->id());
  }
  sink_.fault(fault, what, radar_id);
}

void SomeIpReceiver::take_datagram(const recording::Frame& datagram, const FrameStamp& stamp, std::uint32_t& taken) {
  someip::MessageReader reader(datagram.payload);
  someip::Message message;
  for (auto result = reader.next(message); result != someip::ReadResult::kEnd; result = reader.next(message)) {
    if (result != someip::ReadResult::kMessage) {
      fault_of_sender(datagram.source, someip::kind_of(result), someip::describe(result));
      continue;
    }
    if (message.service != wire_service::kServiceId) continue;  // other services of the same socket
    const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(), [&](const Subscription& s) {
      return s.event == message.method && s.server == datagram.source;
    });
    // Before segments use memory: unknown senders must not displace messages of known servers.
    if (found == subscriptions_.end()) {
      sink_.fault(Fault::kWireUnknown, "SOME/IP: event of the Boresight service from an unknown sender", 0);
      continue;
    }
    if (!message.tp) {
      take_message(*found, message, datagram, stamp, taken);
      continue;
    }
    someip::Message whole;
    const someip::TpResult part = reassembler_->take(message, datagram.source, stamp.received_ns, whole);
    if (part == someip::TpResult::kComplete) {
      take_message(*found, whole, datagram, stamp, taken);
    } else if (someip::is_fault(part)) {
      found->source->fault(someip::kind_of(part), someip::describe(part));
    }
  }
}

void SomeIpReceiver::take_message(Subscription& subscription, const someip::Message& message,
                                  const recording::Frame& datagram, const FrameStamp& stamp, std::uint32_t& taken) {
  Source& source = *subscription.source;
  if (message.interface_version != wire_service::kMajorVersion || message.type != someip::MessageType::kNotification ||
      message.return_code != 0) {
    source.fault(Fault::kWireValue, "SOME/IP: interface version, message type or return code is not 1, 0x02, 0");
    return;
  }
  if (!passes_e2e(subscription, message)) return;
  if (message.payload.size() < subscription.body_offset) {
    source.fault(Fault::kWireLength, "SOME/IP: message is shorter than its E2E header");
    return;
  }
  taken |= 1u << static_cast<unsigned>(&subscription - subscriptions_.data());
  recording::Frame body = datagram;
  body.payload = message.payload.subspan(subscription.body_offset);
  source.take(body, stamp);
}

bool SomeIpReceiver::passes_e2e(Subscription& subscription, const someip::Message& message) {
  if (!subscription.e2e_required) return true;
  const e2e::Status status = check_protection(subscription.checker, message.protected_data, *subscription.source);
  if (e2e::is_acceptable(status)) return true;
  subscription.source->fault(Fault::kWireValue, e2e::describe(status));
  return false;
}

}  // namespace boresight::ingest
