// Whoever starts first, is killed, is stopped or loses its cable: detections flow again within one offer cycle.
#include "services/common/runtime/clock.hpp"
#include "tests/system/network/story.hpp"

namespace boresight::network {
namespace {

class Restarts : public Story {
 protected:
  void restart_and_break(const std::vector<std::string>& options);
};

/// The whole life of a server and of its cable, in front of one gateway.
void Restarts::restart_and_break(const std::vector<std::string>& options) {
  start_gateway();
  EXPECT_TRUE(is_silent(0.2));
  start_server(kServerAddress, options);
  expect_flow_after_offer("gateway first, then the server");

  kill_server();
  start_server(kServerAddress, options);
  expect_flow_after_offer("server killed and restarted");

  kill_server();
  harness::sleep_s(3.5);  // its offers have run out meanwhile
  start_server(kServerAddress, options);
  expect_flow_after_offer("server killed, restarted after its offers expired");

  stop_server();
  start_server(kServerAddress, options);
  expect_flow_after_offer("server stopped (StopOffer) and started");

  hosts().run(Host::kEcu, "ip link set radar0 down");
  harness::sleep_s(0.5);
  hosts().run(Host::kEcu, "ip link set radar0 up");
  expect_flow("ECU's link down for 0.5 s and up", kOfferCycle_s);

  hosts().run(Host::kEcu, "ip link set radar0 down");
  harness::sleep_s(3.5);
  hosts().run(Host::kEcu, "ip link set radar0 up");
  expect_flow("ECU's link down for 3.5 s and up", kOfferCycle_s);

  hosts().run(Host::kSensors, "ip link set sensor0 down");
  harness::sleep_s(3.5);
  hosts().run(Host::kSensors, "ip link set sensor0 up");
  expect_flow("server's link down for 3.5 s and up", kOfferCycle_s);
}

TEST_F(Restarts, WithUnicastEvents) {
  restart_and_break({});
}

TEST_F(Restarts, WithMulticastEvents) {
  restart_and_break({"--group", "239.77.0.1:30650"});
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

}  // namespace
}  // namespace boresight::network
