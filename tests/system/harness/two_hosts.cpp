#include "tests/system/harness/two_hosts.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

namespace boresight::network {

namespace {

namespace fs = std::filesystem;

std::string log_of(const std::string& program) {
  return "/tmp/" + fs::path(program).filename().string() + ".log";
}

int this_network() {
  return open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
}

void enter(int network) {
  if (setns(network, CLONE_NEWNET) != 0) throw std::runtime_error("cannot enter a network namespace");
}

}  // namespace

bool TwoHosts::are_possible() {
  harness::Child attempt([] {
    if (unshare(CLONE_NEWNET) != 0) return 1;
    const bool cables = std::system("ip link add name probe0 type veth peer name probe1 2>/dev/null") == 0;
    return cables && std::system("ip link add name probe2 type bridge 2>/dev/null") == 0 ? 0 : 1;
  });
  return attempt.wait_for(5.0) == 0;
}

TwoHosts::TwoHosts() {
  if (unshare(CLONE_NEWNET) != 0) throw std::runtime_error("no network namespace");
  sensors_ = this_network();
  if (unshare(CLONE_NEWNET) != 0) throw std::runtime_error("no network namespace");
  ecu_ = this_network();
  for (const Host host : {Host::kEcu, Host::kSensors}) run(host, "ip link set lo up");
  lay_uplink();
  install_switch();
  lay_cable();
}

TwoHosts::~TwoHosts() {
  close(ecu_);
  close(sensors_);
}

void TwoHosts::as(Host host, const std::function<void()>& make) const {
  const int wanted = host == Host::kEcu ? ecu_ : sensors_;
  enter(wanted);
  make();
  enter(ecu_);
}

bool TwoHosts::try_run(Host host, const std::string& command) const {
  bool done = false;
  as(host, [&] { done = std::system(command.c_str()) == 0; });
  return done;
}

void TwoHosts::run(Host host, const std::string& command) const {
  if (!try_run(host, command)) throw std::runtime_error("failed: " + command);
}

std::unique_ptr<harness::Child> TwoHosts::start(Host host, const std::string& program,
                                                const std::vector<std::string>& arguments) const {
  return std::make_unique<harness::Child>([&] {
    enter(host == Host::kEcu ? ecu_ : sensors_);
    const std::string log = log_of(program);
    const int output = open(log.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0644);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(program.c_str(), argv.data());
    return 127;
  });
}

void TwoHosts::install_switch() const {
  run(Host::kSensors,
      "ip link add name sensor0 type bridge mcast_snooping 0 && ip address add 10.77.0.1/24 dev sensor0 && "
      "ip -6 address add fd77::1/64 dev sensor0 nodad && ip link set sensor0 up");
}

void TwoHosts::lay_cable() const {
  const std::string sensors = "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(sensors_);
  run(Host::kEcu, "ip link add name radar0 type veth peer name port0 netns " + sensors);
  run(Host::kSensors, "ip link set port0 master sensor0 && ip link set port0 up");
  run(Host::kEcu,
      "ip address add 10.77.0.2/24 dev radar0 && ip -6 address add fd77::2/64 dev radar0 nodad && "
      "ip link set radar0 up");
}

void TwoHosts::cut_cable() const {
  run(Host::kEcu, "ip link delete radar0");
}

void TwoHosts::lay_uplink() const {
  const std::string sensors = "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(sensors_);
  run(Host::kEcu, "ip link add name uplink0 type veth peer name foreign0 netns " + sensors);
  run(Host::kSensors,
      "ip address add 10.99.0.1/24 dev foreign0 && ip -6 address add fd99::1/64 dev foreign0 nodad && "
      "ip link set foreign0 up");
  run(Host::kEcu,
      "ip address add 10.99.0.2/24 dev uplink0 && ip -6 address add fd99::2/64 dev uplink0 nodad && "
      "ip link set uplink0 up && ip route add default via 10.99.0.1 && "
      "ip route add 224.0.0.0/4 dev uplink0 && ip -6 route add default via fd99::1");
}

void show_log(const std::string& program) {
  std::ifstream log(log_of(program));
  std::cerr << "--- " << program << "\n" << log.rdbuf() << std::flush;
}

int run_tests_on_two_hosts(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!TwoHosts::are_possible()) {
    std::puts("skipped: network namespaces or virtual Ethernet cables are not permitted");
    constexpr int kSkipped = 77;
    return kSkipped;
  }
  return RUN_ALL_TESTS();
}

}  // namespace boresight::network
