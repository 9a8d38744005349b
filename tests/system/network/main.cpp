// The stories need namespaces and virtual cables: without the right to make them they are skipped as a whole.
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/system/network/two_hosts.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!boresight::network::TwoHosts::are_possible()) {
    std::puts("skipped: network namespaces or virtual Ethernet cables are not permitted");
    constexpr int kSkipped = 77;
    return kSkipped;
  }
  return RUN_ALL_TESTS();
}
