// Any order of starts, kills, stops and cable failures: detections flow again within one offer cycle.
#include <array>

#include <arpa/inet.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include "services/common/runtime/clock.hpp"
#include "tests/system/network/story.hpp"

namespace boresight::network {
namespace {

using Restarts = Story;

TEST_F(Restarts, OfTheServer) {
  start_gateway();
  EXPECT_TRUE(is_silent(0.2));
  start_server();
  expect_flow_after_offer("gateway first, then the server");

  kill_server();
  start_server();
  expect_flow_after_offer("server killed and restarted");

  kill_server();
  harness::sleep_s(3.5);  // its offers have expired meanwhile
  start_server();
  expect_flow_after_offer("server killed, restarted after its offers expired");

  stop_server();
  start_server();
  expect_flow_after_offer("server stopped (StopOffer) and started");
}

TEST_F(Restarts, ServerFirst) {
  start_server();
  harness::sleep_s(2.0);  // beyond its repetition phase
  const std::int64_t begin_ns = runtime::monotonic_now_ns();
  start_gateway();
  const std::int64_t flow_ns = wait_for_scans(begin_ns, 3.0);
  std::printf("%-58s %6.1f ms after its start\n", "server first, then the gateway",
              static_cast<double>(flow_ns - begin_ns) * 1e-6);
  EXPECT_LT(static_cast<double>(flow_ns - begin_ns) * 1e-9, kOfferCycle_s);

  stop_gateway();
  EXPECT_TRUE(is_silent(0.2));
  start_gateway();
  expect_flow("gateway stopped and started again", kOfferCycle_s);
}

class Cable : public Story {
 protected:
  /// As sent by the server, but to any group and port.
  static void send_stop_offer(const std::string& group, std::uint16_t port);
};

void Cable::send_stop_offer(const std::string& group, std::uint16_t port) {
  // Header of a SOME/IP-SD message (session 1, reboot), two entries of the service 0x4253, version 1.0, TTL 0.
  const std::array<std::uint8_t, 60> message{0xFF, 0xFF, 0x81, 0x00, 0,    0,    0, 52, 0, 0, 0, 1, 1, 1, 2, 0,
                                             0xC0, 0,    0,    0,                                                //
                                             0,    0,    0,    32,                                               //
                                             1,    0,    0,    0,    0x42, 0x53, 0, 1,  1, 0, 0, 0, 0, 0, 0, 0,  //
                                             1,    0,    0,    0,    0x42, 0x53, 0, 2,  1, 0, 0, 0, 0, 0, 0, 0,  //
                                             0,    0,    0,    0};
  hosts().as(Host::kSensors, [&] {
    const int from = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    setsockopt(from, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(30490);
    inet_pton(AF_INET, kServerAddress, &address.sin_addr);
    ip_mreqn outgoing{};
    outgoing.imr_ifindex = static_cast<int>(if_nametoindex(kServerInterface));
    setsockopt(from, IPPROTO_IP, IP_MULTICAST_IF, &outgoing, sizeof(outgoing));
    EXPECT_EQ(bind(from, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    inet_pton(AF_INET, group.c_str(), &address.sin_addr);
    address.sin_port = htons(port);
    EXPECT_EQ(
        sendto(from, message.data(), message.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
        static_cast<ssize_t>(message.size()));
    close(from);
  });
}

TEST_F(Cable, DownAndUpAndReplaced) {
  hosts().cut_cable();
  start_gateway();
  start_server();
  harness::sleep_s(2.0);
  EXPECT_TRUE(is_silent(0.0));
  hosts().lay_cable();
  expect_flow("gateway started before its interface was there", kOfferCycle_s);

  hosts().run(Host::kEcu, "ip link set radar0 down");
  harness::sleep_s(0.5);
  hosts().run(Host::kEcu, "ip link set radar0 up");
  expect_flow("ECU's link down for 0.5 s and up", kOfferCycle_s);

  hosts().run(Host::kEcu, "ip link set radar0 down");
  harness::sleep_s(5.2);  // offers have expired, and the client has stopped searching
  EXPECT_TRUE(is_silent(0.1));
  hosts().run(Host::kEcu, "ip link set radar0 up");
  expect_flow("ECU's link down for 5.3 s and up", kOfferCycle_s);

  hosts().run(Host::kSensors, "ip link set port0 down");
  harness::sleep_s(5.2);
  hosts().run(Host::kSensors, "ip link set port0 up");
  expect_flow("server's link down for 5.2 s and up", kOfferCycle_s);

  hosts().cut_cable();
  harness::sleep_s(0.5);
  hosts().lay_cable();
  expect_flow("interface deleted and made anew after 0.5 s", kOfferCycle_s);
}

/// Multicast depends on memberships, which the kernel drops with an interface.
TEST_F(Cable, WithMulticastEvents) {
  start_gateway();
  start_server(kServerAddress, {"--group", "239.77.0.1:30650"});
  expect_flow_after_offer("multicast: gateway first, then the server");
  kill_server();
  start_server(kServerAddress, {"--group", "239.77.0.1:30650"});
  expect_flow_after_offer("multicast: server killed and restarted");
  hosts().cut_cable();
  harness::sleep_s(0.5);
  hosts().lay_cable();
  expect_flow("multicast: interface deleted and made anew after 0.5 s", kOfferCycle_s);
  // The StopOffer arrives at the same socket that it closes.
  const std::int64_t stop_ns = runtime::monotonic_now_ns();
  send_stop_offer("239.77.0.1", 30650);
  const std::int64_t flow_ns = wait_for_scans(stop_ns + 100'000'000, 3.0);
  EXPECT_LT(static_cast<double>(flow_ns - stop_ns) * 1e-9, kOfferCycle_s + 0.2)
      << "after a StopOffer to the events' group";

  stop_server();
  start_server(kServerAddress, {"--group", "239.77.0.2:30651"});
  expect_flow_after_offer("multicast: server stopped, back with another group");
  hosts().cut_cable();
  harness::sleep_s(3.5);
  hosts().lay_cable();
  expect_flow("multicast: interface made anew after 3.5 s", kOfferCycle_s);
}

}  // namespace
}  // namespace boresight::network
