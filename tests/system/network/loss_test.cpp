// A cable that loses one packet in twenty: losses are counted, and published scans are complete.
#include <algorithm>
#include <cstdio>

#include "tests/system/network/story.hpp"

namespace boresight::network {
namespace {

using Loss = Story;

/// By the kernel's network emulator, or without it by a packet filter of four instructions: load a random word, pass
/// (0) if it is above a twentieth of all words, else drop (2).
bool make_lossy(const TwoHosts& hosts) {
  const std::string on_port = std::string("dev ") + kServerPort;
  if (hosts.try_run(Host::kSensors, "tc qdisc add " + on_port + " root netem loss 5% 2>/dev/null")) return true;
  return hosts.try_run(Host::kSensors, "tc qdisc add " + on_port + " clsact 2>/dev/null && tc filter add " + on_port +
                                           " egress bpf da bytecode '4,32 0 0 4294963256,37 0 1 214748364,6 0 0 0,"
                                           "6 0 0 2' 2>/dev/null");
}

TEST_F(Loss, IsCountedAndHarmsNothingElse) {
  start_gateway();
  start_server(kServerAddress, {}, 300);  // eleven segments a list: four lists in ten lose one
  expect_flow_after_offer("before the cable loses anything");
  if (!make_lossy(hosts())) GTEST_SKIP() << "skipped: this kernel can neither emulate loss nor filter packets";
  harness::sleep_s(4.0);
  kill_server();
  harness::sleep_s(0.3);
  const ServiceStatus status = status_after_now();
  for (std::uint32_t radar = 1; radar <= 2; ++radar) {
    std::uint64_t received = 0;
    std::uint32_t first = 0, last = 0;
    for (std::size_t i = first_scan_; i < witness().size(); ++i) {
      const SeenScan& scan = witness()[i];
      if (scan.radar != radar) continue;
      if (received++ == 0) first = scan.cycle;
      last = scan.cycle;
    }
    ASSERT_GT(received, 20u);
    const std::uint64_t missing = last - first + 1 - received;
    const auto source = std::find_if(status.sources.begin(), status.sources.end(),
                                     [radar](const SourceStatistics& s) { return s.source_id == radar; });
    ASSERT_NE(source, status.sources.end());
    std::printf("radar %u: %llu lists came whole, %llu lost one of their segments\n", radar,
                static_cast<unsigned long long>(received), static_cast<unsigned long long>(missing));
    EXPECT_GT(missing, 5u);
    EXPECT_EQ(source->messages, received);
    EXPECT_EQ(source->e2e_lost, missing) << "by the end-to-end counter";
    EXPECT_EQ(source->lost, missing) << "by the cycle counter";
    EXPECT_EQ(source->e2e_wrong, 0u) << "segments of different lists were combined";
  }
  hosts().cut_cable();
  hosts().lay_cable();
}

}  // namespace
}  // namespace boresight::network
