// The gateway receives groups only on the interface of the vehicle file; also with IPv6.
#include <fstream>

#include "tests/system/network/other_stack.hpp"
#include "tests/system/network/story.hpp"

namespace boresight::network {
namespace {

using Interfaces = Story;

/// Interfaces on which the ECU is a member of an IPv4 group, by the kernel's table.
std::vector<std::string> members_of(const std::string& group_as_printed) {
  std::vector<std::string> members;
  std::ifstream table("/proc/net/igmp");
  std::string interface;
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (!line.empty() && line.front() != '\t') interface = second;
    if (first == group_as_printed) members.push_back(interface);
  }
  return members;
}

TEST_F(Interfaces, TheDefaultRouteLeadsElsewhere) {
  // A server of the same instances in the wrong network, and a program of this host that listens there.
  const OtherStack listener = OtherStack::member_on(hosts(), kEcuUplink);
  const auto rogue = start_replay({"--via", "someip", "--interface", kForeignInterface, "--address", kForeignAddress,
                                   "--radars", "2", "--synthetic", "7", "--group", "239.77.0.1:30650"});
  start_gateway();
  EXPECT_TRUE(listener.hears_offer(2.0)) << "the other server does not offer";
  EXPECT_TRUE(is_silent(0.5)) << "received a server on another interface than configured";
  start_server(kServerAddress, {"--group", "239.77.0.1:30650"});
  expect_flow_after_offer("multicast events, default route by another interface");
  EXPECT_EQ(members_of("01004DEF"), std::vector<std::string>{kEcuInterface}) << "group 239.77.0.1";
  EXPECT_EQ(members_of("F5E0F4E0"), (std::vector<std::string>{kEcuUplink, kEcuInterface}))
      << "SD; uplink: the listener";
  for (std::size_t i = first_scan_; i < witness().size(); ++i) ASSERT_EQ(witness()[i].detections, 100u);
}

TEST_F(Interfaces, Ipv6) {
  write_vehicle(kEcuAddressV6, kGroupV6);
  offers_ = std::make_unique<Offers>(hosts(), kGroupV6);
  start_gateway();
  start_server(kServerAddressV6);
  expect_flow_after_offer("IPv6: gateway first, then the server");
  kill_server();
  start_server(kServerAddressV6, {"--group", "[ff14::42]:30650"});
  expect_flow_after_offer("IPv6: server killed, back with multicast events");
  hosts().cut_cable();
  harness::sleep_s(0.5);
  hosts().lay_cable();
  expect_flow("IPv6: interface deleted and made anew after 0.5 s", kOfferCycle_s);
}

/// Addresses that are valid on one link only.
TEST_F(Interfaces, Ipv6LinkLocal) {
  hosts().run(Host::kEcu, "ip -6 address add fe80::77:2/64 dev radar0 nodad");
  hosts().run(Host::kSensors, "ip -6 address add fe80::77:1/64 dev sensor0 nodad");
  write_vehicle("fe80::77:2", kGroupV6);
  offers_ = std::make_unique<Offers>(hosts(), kGroupV6);
  start_gateway();
  start_server("fe80::77:1");
  expect_flow_after_offer("IPv6 link-local addresses");
  stop_server();
  stop_gateway();
  hosts().run(Host::kEcu, "ip -6 address del fe80::77:2/64 dev radar0");
  hosts().run(Host::kSensors, "ip -6 address del fe80::77:1/64 dev sensor0");
}

}  // namespace
}  // namespace boresight::network
