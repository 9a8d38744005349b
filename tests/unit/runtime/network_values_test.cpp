#include "services/common/runtime/config/network_values.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace boresight::config {
namespace {

using testing::HasSubstr;

std::string problem_of(const std::vector<std::string>& interfaces) {
  return problem_of_interfaces(interfaces).value_or("");
}

TEST(NetworkValues, InterfacesAreDistinctNamesOrUnicastIpv4Addresses) {
  EXPECT_EQ(problem_of({"127.0.0.1", "10.13.1.2", "eth0", "banana"}), "") << "whether it exists is known at run time";
  for (const char* wrong : {"", "10.0.0", "10.0.0.1/24", " 10.0.0.1", "fd00::1", "10.0.0.256", "0.0.0.0", "1234",
                            "a234567890123456", "../eth0", "eth0\n"}) {
    EXPECT_THAT(problem_of({"10.0.0.1", wrong}), HasSubstr("must be names or IPv4 addresses")) << wrong;
  }
  for (const char* wrong : {"224.0.0.1", "255.255.255.255"}) {
    EXPECT_THAT(problem_of({wrong}), HasSubstr("must be addresses of single interfaces")) << wrong;
  }
  EXPECT_THAT(problem_of({"10.0.0.1", "eth0", "10.0.0.1"}), HasSubstr("\"10.0.0.1\" must be named once only"));
}

TEST(NetworkValues, AllInterfacesMustBeMeant) {
  EXPECT_EQ(problem_of({"all"}), "");
  EXPECT_THAT(problem_of({"all", "eth0"}), HasSubstr("must be the only entry"));
  EXPECT_THAT(problem_of({}), HasSubstr("is empty"));
}

TEST(NetworkValues, InterfaceNamesAreThoseThatLinuxAllows) {
  for (const char* name : {"can0", "eth0.100", "enp0s31f6", "v", "a23456789012345"}) {
    EXPECT_TRUE(is_interface_name(name)) << name;
  }
  for (const char* name : {"", ".", "..", "can 0", "can\n", "../can0", "eth0:1", "a234567890123456"}) {
    EXPECT_FALSE(is_interface_name(name)) << name;
  }
}

TEST(NetworkValues, PathOfASocketFitsItsAddress) {
  EXPECT_EQ(problem_of_socket_path(std::string(107, 'x')), std::nullopt);
  EXPECT_THAT(problem_of_socket_path(std::string(108, 'x')).value_or(""), HasSubstr("must be a path of at most 107"));
}

}  // namespace
}  // namespace boresight::config
