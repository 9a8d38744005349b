// Listens to the server's offers at the server's end of the cable, so that the time of the first offer is known
// independently of the ECU.
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

  /// Forgets all offers so far.
  void forget();
  /// CLOCK_MONOTONIC of the first offer (StopOffers aside) since then, by the kernel's stamp.
  [[nodiscard]] std::optional<std::int64_t> first_ns();

 private:
  void listen();
  int socket_;
  std::optional<std::int64_t> first_ns_;
};

}  // namespace boresight::network
