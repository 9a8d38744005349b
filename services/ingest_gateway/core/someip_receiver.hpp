// Events of the Boresight service: datagrams → messages → reassembled messages → checked bodies → their source.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/common/e2e/checker.hpp"
#include "services/common/someip/message.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/someip/tp.hpp"
#include "services/ingest_gateway/core/sink.hpp"
#include "services/ingest_gateway/core/source.hpp"

namespace boresight::ingest {

class SomeIpReceiver {
 public:
  explicit SomeIpReceiver(Sink& sink) : sink_(sink) {}

  /// Before any take(): adds a source of the event; returns its index.
  std::size_t add(Source& source, std::uint16_t event, const E2eConfig& e2e);
  /// Current endpoint of the source's events, from its offer; nullopt: not offered.
  void set_server(std::size_t index, const std::optional<recording::Endpoint>& server);
  /// The source's server restarted: its first message has no predecessor.
  void forget_sequence(std::size_t index) { subscriptions_[index].checker.reset(); }
  [[nodiscard]] bool knows(const recording::Endpoint& server) const;
  /// After the last add(): allocates the memory for segmented messages.
  void prepare();

  /// Takes one datagram; calls `on_event(index)` for each valid message of a source.
  template <typename OnEvent>
  void take(const recording::Frame& datagram, const FrameStamp& stamp, OnEvent on_event) {
    std::uint32_t taken = 0;
    take_datagram(datagram, stamp, taken);
    for (std::size_t i = 0; taken != 0; ++i, taken >>= 1) {
      if ((taken & 1u) != 0) on_event(i);
    }
  }
  void tick(std::int64_t now_ns);
  /// Reports a fault of the source with that index.
  void fault(std::size_t index, Fault fault, std::string_view what) {
    subscriptions_[index].source->fault(fault, what);
  }

 private:
  struct Subscription {
    Source* source;
    std::uint16_t event;
    bool e2e_required;
    std::size_t body_offset;  // in the message's payload
    e2e::Checker checker;
    std::optional<recording::Endpoint> server;
  };
  void take_datagram(const recording::Frame& datagram, const FrameStamp& stamp, std::uint32_t& taken);
  void take_message(Subscription& subscription, const someip::Message& message, const recording::Frame& datagram,
                    const FrameStamp& stamp, std::uint32_t& taken);
  /// Counts a fault for the source with this sender, if there is one.
  void fault_of_sender(const recording::Endpoint& sender, Fault fault, std::string_view what);
  [[nodiscard]] bool passes_e2e(Subscription& subscription, const someip::Message& message);

  Sink& sink_;
  std::vector<Subscription> subscriptions_;
  std::optional<someip::TpReassembler> reassembler_;
  std::uint64_t incomplete_reported_ = 0;
};

}  // namespace boresight::ingest
