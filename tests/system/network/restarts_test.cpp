// Whoever starts first, is killed, is stopped or loses its cable: detections flow again within one offer cycle.
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
  harness::sleep_s(3.5);  // its offers have run out meanwhile
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
}

using Cable = Story;

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
  harness::sleep_s(5.2);  // offers have expired, and the client has given up asking
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

/// With multicast, all depends on memberships, which the kernel forgets with an interface.
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
