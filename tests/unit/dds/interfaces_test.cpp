#include "services/health/dds/interfaces.hpp"

#include <gmock/gmock.h>

namespace boresight::dds {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::vector<LocalInterface> kPresent = {
    {"lo", "", true},           {"lo", "127.0.0.1", true},   {"eth0", "", true}, {"eth0", "10.0.0.2", true},
    {"eth0", "10.0.0.3", true}, {"eth1", "10.1.0.2", false}, {"can0", "", true},
};

UsableInterfaces usable(const std::vector<std::string>& configured) {
  return usable_interfaces(configured, kPresent);
}

TEST(UsableInterfaces, AreThoseOfANameOrAnAddress) {
  EXPECT_THAT(usable({"eth0"}).addresses, ElementsAre("10.0.0.2", "10.0.0.3"));
  EXPECT_THAT(usable({"10.0.0.3"}).addresses, ElementsAre("10.0.0.3"));
  EXPECT_THAT(usable({"lo", "127.0.0.1"}).addresses, ElementsAre("127.0.0.1")) << "each once";
  EXPECT_THAT(usable({"eth0"}).problems, IsEmpty());
}

TEST(UsableInterfaces, AllAreThoseThatWork) {
  EXPECT_THAT(usable({"all"}).addresses, ElementsAre("10.0.0.2", "10.0.0.3", "127.0.0.1"));
  EXPECT_THAT(usable({"all"}).problems, IsEmpty());
}

TEST(UsableInterfaces, EachUnusableOneHasItsReason) {
  EXPECT_THAT(usable({"lo", "nosuch0", "10.9.9.9", "eth1", "10.1.0.2", "can0"}).problems,
              ElementsAre("nosuch0: this machine has no such interface", "10.9.9.9: this machine has no such interface",
                          "eth1: it is down", "10.1.0.2: it is down", "can0: it has no IPv4 address"));
  EXPECT_THAT(usable({"lo", "nosuch0"}).addresses, ElementsAre("127.0.0.1")) << "the others are used";
}

TEST(LocalInterfaces, ContainTheLoopback) {
  const auto present = local_interfaces();
  EXPECT_THAT(present, testing::Contains(testing::Field(&LocalInterface::name, "lo")));
}

}  // namespace
}  // namespace boresight::dds
