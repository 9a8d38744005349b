#include "tests/benchmarks/ingest/load/network.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

namespace boresight::bench {

namespace {

constexpr const char* kVariable = "BORESIGHT_RADAR_NETNS";

/// A value of /proc/net/snmp, whose lines come in pairs: names, then numbers.
std::uint64_t snmp(const std::string& protocol, const std::string& counter) {
  std::ifstream file("/proc/net/snmp");
  for (std::string names, numbers; std::getline(file, names) && std::getline(file, numbers);) {
    std::istringstream name_fields(names), number_fields(numbers);
    std::string name, number;
    name_fields >> name;
    number_fields >> number;
    if (name != protocol + ":") continue;
    while (name_fields >> name && number_fields >> number) {
      if (name == counter) return std::stoull(number);
    }
  }
  return 0;
}

}  // namespace

bool has_network() {
  return std::getenv(kVariable) != nullptr;
}

void enter_radars_network() {
  const char* const path = std::getenv(kVariable);
  const int descriptor = path == nullptr ? -1 : open(path, O_RDONLY | O_CLOEXEC);
  const bool entered = descriptor >= 0 && setns(descriptor, CLONE_NEWNET) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!entered) throw std::runtime_error("cannot enter the radars' network");
}

std::uint64_t kernel_drops() {
  return snmp("Udp", "RcvbufErrors") + snmp("Ip", "ReasmFails");
}

double cpu_time_s(int pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  // The name in brackets may hold blanks; utime and stime are the 12th and 13th field behind it.
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::string write_configuration() {
  namespace fs = std::filesystem;
  const fs::path folder = "/tmp/ingest_load";
  fs::create_directories(folder / "vehicle");
  fs::copy(fs::path(BORESIGHT_SOURCE_DIR) / "config" / "services", folder / "services",
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  for (const bool ars548 : {true, false}) {
    const std::string name = ars548 ? "ars548" : "someip";
    std::ofstream file(folder / "vehicle" / (name + ".toml"));
    file << "name = \"" << name << "\"\n[ego]\nprofile = \"boresight\"\n"
         << "source = {link = \"someip\", address = \"10.13.0.1\", interface = \"ecu0\", instance = 1";
    // No service offers ego motion beside the ARS548: it comes from a configured endpoint.
    if (ars548) file << ", sender = \"10.13.2.1\", sender_port = " << kEgoServer.port;
    file << "}\n";
    for (std::uint32_t id = 1; id <= kRadars; ++id) {
      file << "[[radar]]\nid = " << id << "\nname = \"radar_" << id << "\"\n";
      if (ars548) {
        file << "profile = \"ars548\"\nsource = {link = \"udp\", address = \"224.0.2.2\", port = " << kArs548Group.port
             << ", sender = \"10.13.1." << id << "\", interface = \"ecu0\"}\n";
      } else {
        file << "profile = \"boresight\"\nsource = {link = \"someip\", address = \"10.13.0.1\", interface = \"ecu0\", "
             << "instance = " << id << "}\n";
      }
      file << "mounting_pose = {position_m = [0.0, " << 0.1 * id << ", 0.5], yaw_deg = 0.0}\n";
    }
  }
  return folder;
}

}  // namespace boresight::bench
