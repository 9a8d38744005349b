// Another program on the ECU that takes part in SOME/IP service discovery: the sockets of one, and what they receive.
#pragma once

#include <string>

#include "tests/system/harness/two_hosts.hpp"

namespace boresight::network {

class OtherStack {
 public:
  /// A socket of the discovery group alone, joined on an interface.
  [[nodiscard]] static OtherStack member_on(const TwoHosts& hosts, const std::string& interface);
  /// One that has the port for itself as far as it knows: on `address` ("0.0.0.0": all), and in the group on the
  /// radars' interface. It shares the port by SO_REUSEADDR, as stacks do.
  [[nodiscard]] static OtherStack at(const TwoHosts& hosts, const std::string& address);
  ~OtherStack();
  OtherStack(OtherStack&& other) noexcept;
  OtherStack(const OtherStack&) = delete;
  OtherStack& operator=(const OtherStack&) = delete;

  /// Whether an offer of the server comes within the time.
  [[nodiscard]] bool hears_offer(double seconds) const;
  /// Whether what a peer sends to the ECU's discovery port arrives here, tried for so long.
  [[nodiscard]] bool gets_unicast(double seconds) const;

 private:
  OtherStack(const TwoHosts& hosts, const std::string& address, const std::string& interface);
  int unicast_ = -1;
  int multicast_ = -1;
  int peer_ = -1;  // on the sensors' side
};

}  // namespace boresight::network
