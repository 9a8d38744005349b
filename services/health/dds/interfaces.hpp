// The configured network interfaces against those that the machine has at present.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace boresight::dds {

/// An IPv4 address of this machine, or an interface without one.
struct LocalInterface {
  std::string name;
  std::string address;  ///< IPv4; "": it has none
  bool is_up = false;   ///< configured to be up, and its link works

  [[nodiscard]] bool operator==(const LocalInterface&) const = default;
};

struct UsableInterfaces {
  std::vector<std::string> addresses;  ///< IPv4, sorted, each once
  std::vector<std::string>
      problems;  ///< "eth0: its link is down", one for each configured interface that cannot be used
};

/// Each entry of `configured` is a name, an IPv4 address or "all". "all" is a problem only if there is no address at
/// all.
[[nodiscard]] UsableInterfaces usable_interfaces(std::span<const std::string> configured,
                                                 std::span<const LocalInterface> present);

/// Those of this machine at present. Throws std::runtime_error if the kernel does not list them.
[[nodiscard]] std::vector<LocalInterface> local_interfaces();

/// "a; b"
[[nodiscard]] std::string joined(std::span<const std::string> problems);

}  // namespace boresight::dds
