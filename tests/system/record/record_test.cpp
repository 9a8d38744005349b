// `boresight record` on a live interface: `lo` of a network namespace of the test's own.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "services/common/recording/reader.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight {
namespace {

using harness::Child;

/// A loopback interface with Ethernet's MTU, so that datagrams are fragmented.
bool enter_own_network() {
  if (unshare(CLONE_NEWNET) != 0) return false;
  const int control = socket(AF_INET, SOCK_DGRAM, 0);
  ifreq request{};
  std::string("lo").copy(request.ifr_name, IFNAMSIZ - 1);
  request.ifr_mtu = 1500;
  const bool mtu = ioctl(control, SIOCSIFMTU, &request) == 0;
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  const bool up = ioctl(control, SIOCSIFFLAGS, &request) == 0;
  close(control);
  return mtu && up;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::unique_ptr<Child> run_boresight(std::vector<std::string> arguments) {
  std::filesystem::remove("/tmp/output");  // what is in it is of the one before
  return std::make_unique<Child>([arguments = std::move(arguments)]() mutable {
    const int output = open("/tmp/output", O_CREAT | O_TRUNC | O_WRONLY, 0600);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    arguments.insert(arguments.begin(), BORESIGHT_BINARY_DIR "/boresight");
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv(pointers[0], pointers.data());
    return 98;
  });
}

class Record : public testing::Test {
 protected:
  static void SetUpTestSuite() { has_network_ = enter_own_network(); }
  void SetUp() override {
    if (!has_network_) GTEST_SKIP() << "skipped: network namespaces are not permitted";
  }
  /// From a fixed port, as radars send: of the ports that the kernel would choose from, some are those of other
  /// protocols (37008, 44818, 47000, 54328), as whose malformed datagrams tshark would show these.
  static void send(const std::string& data) {
    const int sender = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(42101);
    ASSERT_EQ(bind(sender, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    address.sin_port = htons(42102);
    ASSERT_EQ(sendto(sender, data.data(), data.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
              static_cast<ssize_t>(data.size()));
    close(sender);
  }
  static bool is_recording() { return text_of("/tmp/output").find("Ctrl-C ends") != std::string::npos; }
  inline static bool has_network_ = false;
};

constexpr int kDatagrams = 50;
constexpr std::size_t kSize = 35336;  // of an ARS548 detection list

TEST_F(Record, EveryDatagramOfALargeRadarIsInTheFileBitByBit) {
  const std::filesystem::path file = "/tmp/lo.pcap";
  const auto recorder = run_boresight(
      {"record", "--interface", "lo", "--filter", "udp port 42102 or ip[6:2] & 0x1fff != 0", "--out", file});
  ASSERT_TRUE(harness::eventually(10.0, is_recording)) << text_of("/tmp/output");
  for (int i = 0; i < kDatagrams; ++i) send(std::string(kSize, static_cast<char>(i)));
  harness::sleep_s(0.3);
  recorder->send(SIGINT);
  EXPECT_EQ(recorder->wait_for(5.0), 130) << text_of("/tmp/output");
  const std::string output = text_of("/tmp/output");
  EXPECT_NE(output.find("1200 frames of lo"), std::string::npos) << output;
  EXPECT_NE(output.find(" 0 dropped by the kernel"), std::string::npos) << output;

  const auto reader = recording::open_recording(file, [](const std::string& problem) { ADD_FAILURE() << problem; });
  recording::Frame frame;
  std::int64_t last_ns = 0;
  bool finer_than_microseconds = false;
  for (int i = 0; i < kDatagrams; ++i) {
    ASSERT_TRUE(reader->next(frame)) << i;
    ASSERT_EQ(frame.payload.size(), kSize);
    ASSERT_TRUE(std::all_of(frame.payload.begin(), frame.payload.end(), [i](std::uint8_t b) { return b == i; }));
    EXPECT_EQ(frame.destination.port, 42102);
    EXPECT_GE(frame.stamp_ns, last_ns);
    last_ns = frame.stamp_ns;
    finer_than_microseconds = finer_than_microseconds || last_ns % 1000 != 0;
  }
  EXPECT_FALSE(reader->next(frame));
  EXPECT_TRUE(finer_than_microseconds);
  EXPECT_NEAR(static_cast<double>(last_ns) * 1e-9, static_cast<double>(std::time(nullptr)), 30.0);

  if (std::system("command -v tshark > /dev/null") != 0) GTEST_SKIP() << "skipped: no tshark";
  ASSERT_EQ(std::system("tshark -r /tmp/lo.pcap -Y 'udp.length == 35344 && !_ws.malformed' -T fields -e udp.dstport"
                        " > /tmp/tshark.txt 2> /dev/null"),
            0);
  const std::string ports = text_of("/tmp/tshark.txt");
  EXPECT_EQ(std::count(ports.begin(), ports.end(), '\n'), kDatagrams);
}

TEST_F(Record, EndsByDurationAndBySize) {
  const auto timed = run_boresight({"record", "--interface", "lo", "--out", "/tmp/timed.pcap", "--duration", "0.5"});
  EXPECT_EQ(timed->wait_for(5.0), 0);
  EXPECT_NE(text_of("/tmp/output").find("duration reached"), std::string::npos) << text_of("/tmp/output");
  const auto sized = run_boresight({"record", "--interface", "lo", "--out", "/tmp/folder", "--max-size", "1"});
  ASSERT_TRUE(harness::eventually(5.0, is_recording));
  for (int i = 0; i < 100; ++i) send(std::string(kSize, 'x'));
  EXPECT_EQ(sized->wait_for(5.0), 0);
  EXPECT_NE(text_of("/tmp/output").find("size reached"), std::string::npos) << text_of("/tmp/output");
}

TEST_F(Record, WhatCannotBeRecordedIsSaidAndNoFileIsLeft) {
  struct Case {
    std::vector<std::string> options;
    std::string message;
    int exit_code;
  };
  const std::vector<Case> cases = {
      {{"--interface", "absent0", "--out", "/tmp/none.pcap"}, "absent0: no such interface", 3},
      {{"--interface", "lo", "--filter", "no filter", "--out", "/tmp/none.pcap"}, "filter \"no filter\"", 2},
      {{"--can", "absent0", "--out", "/tmp/none.log"}, "can absent0: ", 3},
      {{"--interface", "lo", "--can", "can0", "--out", "/tmp/none.pcap"}, "can0", 3},
      {{"--interface", "lo", "--out", "/tmp/none.log"}, "packets go into .pcap", 2},
      {{"--out", "/tmp/none.pcap"}, "nothing to record", 2}};
  for (const auto& [options, message, exit_code] : cases) {
    std::vector<std::string> arguments = {"record"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto recorder = run_boresight(arguments);
    EXPECT_EQ(recorder->wait_for(5.0), exit_code) << message;
    EXPECT_NE(text_of("/tmp/output").find(message), std::string::npos) << text_of("/tmp/output");
  }
  EXPECT_FALSE(std::filesystem::exists("/tmp/none.pcap"));
  EXPECT_FALSE(std::filesystem::exists("/tmp/none.log"));
}

}  // namespace
}  // namespace boresight
