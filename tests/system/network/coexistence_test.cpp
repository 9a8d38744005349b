// Another program on this host uses the port of service discovery as well: neither disturbs the other, in both orders
// of their starts.
#include "tests/system/network/other_stack.hpp"
#include "tests/system/network/story.hpp"

namespace boresight::network {
namespace {

class Coexistence : public Story, public testing::WithParamInterface<const char*> {};

TEST_P(Coexistence, TheOtherStackIsFirst) {
  const OtherStack other = OtherStack::at(hosts(), GetParam());
  start_gateway();
  start_server();
  expect_flow_after_offer(std::string("another stack at ") + GetParam() + " first");
  EXPECT_TRUE(other.hears_offer(1.5));
  EXPECT_TRUE(other.gets_unicast(0.5));
  EXPECT_FALSE(is_silent(0.2));
}

TEST_P(Coexistence, TheGatewayIsFirst) {
  start_gateway();
  start_server();
  expect_flow_after_offer("no other stack");
  {
    const OtherStack other = OtherStack::at(hosts(), GetParam());
    EXPECT_TRUE(other.gets_unicast(2.5)) << "the gateway does not leave the port to the other stack";
    EXPECT_TRUE(other.hears_offer(1.5));
    kill_server();
    start_server();
    expect_flow_after_offer(std::string("another stack at ") + GetParam() + " later, server restarted");
    // Beyond the time to live of the subscription: it is renewed.
    harness::sleep_s(3.5);
    EXPECT_FALSE(is_silent(0.2));
    EXPECT_TRUE(other.gets_unicast(0.5));
  }
  harness::sleep_s(1.2);
  kill_server();
  start_server();
  expect_flow_after_offer("the other stack gone, server restarted");
}

INSTANTIATE_TEST_SUITE_P(At, Coexistence, testing::Values("0.0.0.0", kEcuAddress), [](const auto& info) {
  return std::string(info.index == 0 ? "AllAddresses" : "TheSameAddress");
});

}  // namespace
}  // namespace boresight::network
