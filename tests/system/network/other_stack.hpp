// Another program on the ECU with SOME/IP service discovery: its sockets and received datagrams.
#pragma once

#include <string>

#include "tests/system/harness/two_hosts.hpp"

namespace boresight::network {

class OtherStack {
 public:
  /// A socket of the discovery group only, joined on an interface.
  [[nodiscard]] static OtherStack member_on(const TwoHosts& hosts, const std::string& interface);
  /// A stack on `address` ("0.0.0.0": all) and in the group on the radars' interface. It shares the port by
  /// SO_REUSEADDR, as common stacks do.
  [[nodiscard]] static OtherStack at(const TwoHosts& hosts, const std::string& address);
  ~OtherStack();
  OtherStack(OtherStack&& other) noexcept;
  OtherStack(const OtherStack&) = delete;
  OtherStack& operator=(const OtherStack&) = delete;

  /// True if an offer of the server arrives within the time.
  [[nodiscard]] bool hears_offer(double seconds) const;
  /// True if datagrams of a peer to the ECU's discovery port arrive here within the time.
  [[nodiscard]] bool gets_unicast(double seconds) const;

 private:
  OtherStack(const TwoHosts& hosts, const std::string& address, const std::string& interface);
  int unicast_ = -1;
  int multicast_ = -1;
  int peer_ = -1;  // on the sensors' side
};

}  // namespace boresight::network
