// Eight ARS548 as a process on the radars' side of the network.
#pragma once

#include <cstdint>
#include <memory>

#include "tests/system/harness/child.hpp"

namespace boresight::bench {

class Ars548Radars {
 public:
  /// Encodes the lists, opens the sockets and starts to send ego motion at 50 Hz.
  Ars548Radars();

  /// Each radar sends for `seconds`, their cycles evenly spaced. Returns immediately.
  void send_for(double seconds);
  /// Sends `lists` lists of all radars in turn as fast as possible; ego motion pauses. Returns immediately.
  void send_burst(std::uint32_t lists);
  [[nodiscard]] bool is_done() const { return control_->lists_to_send == 0; }

  [[nodiscard]] std::uint64_t sent() const { return control_->sent; }
  /// Lists that the kernel refused to send.
  [[nodiscard]] std::uint64_t refused() const { return control_->refused; }

 private:
  struct Control {
    volatile std::uint32_t lists_to_send;  // written last by the benchmark, counted down to 0 by the radars
    volatile bool at_once;
    volatile std::uint64_t sent, refused;
  };
  int run();

  harness::Shared<Control> control_;
  std::unique_ptr<harness::Child> process_;
};

/// A process that only receives the ARS548 datagrams, with the gateway's receive buffer: the cost of the kernel alone.
[[nodiscard]] std::unique_ptr<harness::Child> start_bare_receiver();

}  // namespace boresight::bench
