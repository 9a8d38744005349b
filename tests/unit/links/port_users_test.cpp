// The kernel's tables of UDP sockets, as printed by Linux on a little-endian machine.
#include "services/ingest_gateway/links/port_users.hpp"

#include <bit>
#include <sstream>

namespace boresight::ingest {
namespace {

constexpr const char* kHeading =
    "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode ref pointer "
    "drops            \n";

std::string line_of(const std::string& local, int inode) {
  return " 1234: " + local + " 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 " +
         std::to_string(inode) + " 2 0000000000000000 0        \n";
}

bool found(const std::string& text, const std::string& address, ino_t own = 1) {
  std::istringstream table(kHeading + text);
  return has_other_user(table, {recording::parse_ip(address).value(), 30490}, own);
}

class PortUsers : public testing::Test {
 protected:
  void SetUp() override {
    if (std::endian::native != std::endian::little) GTEST_SKIP() << "skipped: the tables here are little-endian";
  }
};

TEST_F(PortUsers, TheSameOrAllAddressesAndTheSamePort) {
  EXPECT_FALSE(found("", "10.77.0.2"));
  EXPECT_TRUE(found(line_of("02004D0A:771A", 7), "10.77.0.2"));
  EXPECT_TRUE(found(line_of("00000000:771A", 7), "10.77.0.2"));
  EXPECT_FALSE(found(line_of("03004D0A:771A", 7), "10.77.0.2")) << "another address of this host";
  EXPECT_FALSE(found(line_of("F5E0F4E0:771A", 7), "10.77.0.2")) << "a member of the discovery group";
  EXPECT_FALSE(found(line_of("02004D0A:771B", 7), "10.77.0.2")) << "another port";
}

TEST_F(PortUsers, TheOwnSocketIsNotCounted) {
  const std::string own = line_of("02004D0A:771A", 42);
  EXPECT_FALSE(found(own, "10.77.0.2", 42));
  EXPECT_TRUE(found(own + line_of("02004D0A:771A", 43), "10.77.0.2", 42));
}

TEST_F(PortUsers, Ipv6) {
  EXPECT_TRUE(found(line_of("000077FD000000000000000002000000:771A", 7), "fd77::2"));
  EXPECT_TRUE(found(line_of("00000000000000000000000000000000:771A", 7), "fd77::2"));
  EXPECT_FALSE(found(line_of("000077FD000000000000000001000000:771A", 7), "fd77::2"));
}

TEST_F(PortUsers, InvalidLinesAreSkipped) {
  const std::string good = line_of("02004D0A:771A", 7);
  EXPECT_TRUE(found("\nnonsense\n 1: 02004D0A 1 2 3 4 5 6 7 8 9\n" + good, "10.77.0.2"));
  EXPECT_FALSE(found(" 1: 02004D0A:771A", "10.77.0.2")) << "ends before its inode";
  EXPECT_FALSE(
      found(line_of("02004D:771A", 7) + line_of("02004D0A:99999", 7) + line_of("0200XD0A:771A", 7), "10.77.0.2"));
}

}  // namespace
}  // namespace boresight::ingest
