// Radars without discovery: four ARS548 of a simulated drive with fragmented datagrams by multicast.
#include <fstream>
#include <iterator>
#include <sstream>

#include <signal.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/drive_writer.hpp"
#include "tests/system/network/story.hpp"

namespace boresight::network {
namespace {

class Ars548 : public Story {
 protected:
  void SetUp() override {
    Story::SetUp();
    scans_are_synthetic_ = false;
    const std::string demo = BORESIGHT_SOURCE_DIR "/config/vehicle/demo.toml";
    std::ifstream file(demo);
    std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    replace_all(text, "address = \"224.0.2.2\"", "address = \"224.0.2.2\", interface = \"radar0\"");
    // No CAN: few kernels in containers have it, and a missing link is a fault.
    replace_all(text, "profile = \"toyota\"", "profile = \"boresight\"");
    replace_all(text, "{link = \"can\", interface = \"can0\"}",
                "{link = \"someip\", address = \"10.77.0.2\", interface = \"radar0\", instance = 1}");
    write_vehicle_file(text);
    for (int sensor = 113; sensor <= 116; ++sensor) {
      hosts().run(Host::kSensors, "ip address add 10.13.1." + std::to_string(sensor) + "/24 dev sensor0");
    }
    hosts().run(Host::kSensors, "ip route add 224.0.0.0/4 dev sensor0");
    hosts().run(Host::kEcu, "ip address add 10.13.1.1/24 dev radar0");
    drive_ = simulator::write_drive(simulator::scenario("demo_drive"), config::read_vehicle_file(demo), 1, 2.0,
                                    "/tmp/drive", [](double) {});
  }
  void TearDown() override {
    Story::TearDown();
    hosts().run(Host::kSensors, "ip route del 224.0.0.0/4 dev sensor0");
    // The first one last: the kernel deletes the others of its network with it.
    for (int sensor = 116; sensor >= 113; --sensor) {
      hosts().run(Host::kSensors, "ip address del 10.13.1." + std::to_string(sensor) + "/24 dev sensor0");
    }
    hosts().run(Host::kEcu, "ip address del 10.13.1.1/24 dev radar0");
  }
  void play(const std::vector<std::string>& options) const {
    std::vector<std::string> all{"--via", "wire", drive_.radars.string()};
    all.insert(all.end(), options.begin(), options.end());
    const auto replay = start_replay(all);
    ASSERT_EQ(replay->wait_for(10.0), 0);
  }
  /// Datagrams that the kernel dropped, over all UDP sockets of the ECU (the last column).
  static unsigned long kernel_drops() {
    std::ifstream table("/proc/net/udp");
    unsigned long drops = 0;
    std::string line;
    for (std::getline(table, line); std::getline(table, line);) {
      std::istringstream words(line);
      std::vector<std::string> fields{std::istream_iterator<std::string>(words), {}};
      drops += fields.empty() ? 0 : std::stoul(fields.back());
    }
    return drops;
  }
  static std::uint64_t published(const ServiceStatus& status) {
    std::uint64_t sum = 0;
    for (const SourceStatistics& source : status.sources) sum += source.messages;
    return sum;
  }
  simulator::DriveFiles drive_;

 private:
  static void replace_all(std::string& text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
      text.replace(at, what.size(), by);
    }
  }
};

TEST_F(Ars548, EveryDatagramOfFourRadarsArrives) {
  start_gateway();
  play({});
  harness::sleep_s(0.2);
  const ServiceStatus after_drive = status_after_now();
  EXPECT_EQ(published(after_drive), drive_.scans);
  EXPECT_EQ(witness().size() - first_scan_, drive_.scans);
  std::uint64_t detections = 0;
  for (std::size_t i = first_scan_; i < witness().size(); ++i) detections += witness()[i].detections;
  EXPECT_EQ(detections, drive_.number_of_detections);

  // Twenty lists wait in the kernel while the gateway does not run.
  gateway_->send(SIGSTOP);
  play({"--duration", "0.24", "--speed", "max"});
  gateway_->send(SIGCONT);
  harness::sleep_s(0.2);
  const ServiceStatus after_burst = status_after_now();
  EXPECT_GE(published(after_burst), published(after_drive) + 19u);
  EXPECT_EQ(kernel_drops(), 0u);
  for (const SourceStatistics& source : after_burst.sources) EXPECT_EQ(source.rejected, 0u);
  EXPECT_EQ(after_burst.faults[static_cast<std::size_t>(Fault::kLink)], 0u) << after_burst.last_fault.data();
  std::printf("%llu lists, %llu at once from a queue, none lost\n",
              static_cast<unsigned long long>(published(after_burst)),
              static_cast<unsigned long long>(published(after_burst) - published(after_drive)));
}

}  // namespace
}  // namespace boresight::network
