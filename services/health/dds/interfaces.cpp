#include "services/health/dds/interfaces.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include "services/common/runtime/config/network_values.hpp"

namespace boresight::dds {

namespace {

/// Adds the addresses of the interfaces for which `is_meant`; returns what is wrong with them, "" if nothing is.
template <typename IsMeant>
std::string add_addresses(std::span<const LocalInterface> present, const IsMeant& is_meant,
                          std::vector<std::string>& addresses) {
  bool exists = false;
  bool is_up = false;
  bool has_address = false;
  for (const LocalInterface& interface : present) {
    if (!is_meant(interface)) continue;
    exists = true;
    is_up = is_up || interface.is_up;
    if (!interface.is_up || interface.address.empty()) continue;
    has_address = true;
    addresses.push_back(interface.address);
  }
  if (has_address) return {};
  if (!exists) return "this machine has no such interface";
  return is_up ? "it has no IPv4 address" : "it is down";
}

}  // namespace

UsableInterfaces usable_interfaces(std::span<const std::string> configured, std::span<const LocalInterface> present) {
  UsableInterfaces usable;
  for (const std::string& entry : configured) {
    const std::string problem = add_addresses(
        present,
        [&](const LocalInterface& interface) {
          return entry == config::kAllInterfaces || entry == interface.name || entry == interface.address;
        },
        usable.addresses);
    if (!problem.empty()) usable.problems.push_back(entry + ": " + problem);
  }
  std::sort(usable.addresses.begin(), usable.addresses.end());
  usable.addresses.erase(std::unique(usable.addresses.begin(), usable.addresses.end()), usable.addresses.end());
  return usable;
}

std::vector<LocalInterface> local_interfaces() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) {
    throw std::runtime_error("cannot list the network interfaces: " + std::generic_category().message(errno));
  }
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, &freeifaddrs);
  std::vector<LocalInterface> present;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    constexpr unsigned kWorks = IFF_UP | IFF_RUNNING;
    LocalInterface interface { .name = entry->ifa_name, .address = {}, .is_up = (entry->ifa_flags & kWorks) == kWorks };
    if (entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET) {
      std::array<char, INET_ADDRSTRLEN> text{};
      inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr, text.data(), text.size());
      interface.address = text.data();
    }
    present.push_back(std::move(interface));
  }
  return present;
}

std::string joined(std::span<const std::string> problems) {
  std::string text;
  for (const std::string& problem : problems) {
    if (!text.empty()) text += "; ";
    text += problem;
  }
  return text;
}

}  // namespace boresight::dds
