// Two hosts on one machine: the ECU with the services, and the side of the sensors or the station. Each is a separate
// network namespace; a virtual Ethernet cable connects the ECU with a switch on the sensors' side. A second cable
// carries the ECU's default route and all multicast routes, to detect use of the wrong interface.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/system/harness/child.hpp"

namespace boresight::network {

enum class Host { kEcu, kSensors };

inline constexpr const char* kEcuInterface = "radar0";
inline constexpr const char* kEcuAddress = "10.77.0.2";
inline constexpr const char* kEcuAddressV6 = "fd77::2";
inline constexpr const char* kServerInterface = "sensor0";  ///< the switch; stays when the cable is cut
inline constexpr const char* kServerPort = "port0";         ///< the switch's end of the cable
inline constexpr const char* kServerAddress = "10.77.0.1";
inline constexpr const char* kServerAddressV6 = "fd77::1";
/// The other cable.
inline constexpr const char* kEcuUplink = "uplink0";
inline constexpr const char* kForeignInterface = "foreign0";
inline constexpr const char* kForeignAddress = "10.99.0.1";

class TwoHosts {
 public:
  /// False where the kernel or the container does not permit namespaces or virtual cables.
  [[nodiscard]] static bool are_possible();

  /// The calling process becomes the ECU. Throws std::runtime_error if a tool fails.
  TwoHosts();
  ~TwoHosts();
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  /// Runs `ip` or another tool on a host; throws if it fails.
  void run(Host host, const std::string& command) const;
  [[nodiscard]] bool try_run(Host host, const std::string& command) const;
  /// A process on a host; its output goes to a file that show_log() prints.
  [[nodiscard]] std::unique_ptr<harness::Child> start(Host host, const std::string& program,
                                                      const std::vector<std::string>& arguments) const;
  /// Calls `make` on that host: sockets made there stay there.
  void as(Host host, const std::function<void()>& make) const;

  /// Makes the ECU's interface with its addresses, and the switch's end of the cable; both are deleted by cut_cable().
  void lay_cable() const;
  void cut_cable() const;

 private:
  void install_switch() const;
  void lay_uplink() const;
  int ecu_;
  int sensors_;
};

/// Copies the output of the programs with that name to the standard error of the test.
void show_log(const std::string& program);

/// main() of such tests: without permission for namespaces and cables all tests are skipped (exit code 77).
[[nodiscard]] int run_tests_on_two_hosts(int argc, char** argv);

}  // namespace boresight::network
