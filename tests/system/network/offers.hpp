// Listens to the offers of the server, on the server's own side of the cable: when the first one came, and whether any
// did, is known independently of what reaches the ECU.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tests/system/harness/two_hosts.hpp"

namespace boresight::network {

class Offers {
 public:
  /// `group`: of service discovery, IPv4 or IPv6.
  Offers(const TwoHosts& hosts, const std::string& group);
  ~Offers();
  Offers(const Offers&) = delete;
  Offers& operator=(const Offers&) = delete;

  /// Forgets what has been heard so far.
  void forget();
  /// CLOCK_MONOTONIC of the first offer (StopOffers aside) since then, by the kernel's stamp.
  [[nodiscard]] std::optional<std::int64_t> first_ns();

 private:
  void listen();
  int socket_;
  std::optional<std::int64_t> first_ns_;
};

}  // namespace boresight::network
