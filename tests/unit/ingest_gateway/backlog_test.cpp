// Cycles and messages of waiting frames are not dropped by the advance of time.
#include "services/ingest_gateway/core/backlog.hpp"

#include <gtest/gtest.h>

#include "tests/benchmarks/ingest/gateway_bench.hpp"
#include "tests/benchmarks/ingest/scans.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

TEST(Backlog, TimeAdvancesWhileFramesAreReadAtOnce) {
  Backlog backlog;
  std::int64_t now_ns = 1'000 * kMillisecond;
  static_cast<void>(backlog.is_read(now_ns));
  EXPECT_TRUE(backlog.is_read(now_ns += 5 * kMillisecond));
  backlog.frame_taken(kMillisecond);
  EXPECT_TRUE(backlog.is_read(now_ns += 5 * kMillisecond));
}

TEST(Backlog, OneOldFrameAmongNewOnesMeansThatOthersWait) {
  Backlog backlog;
  std::int64_t now_ns = 1'000 * kMillisecond;
  static_cast<void>(backlog.is_read(now_ns));
  backlog.frame_taken(100 * kMillisecond);
  backlog.frame_taken(0);
  EXPECT_FALSE(backlog.is_read(now_ns += 5 * kMillisecond));
  EXPECT_TRUE(backlog.is_read(now_ns += 5 * kMillisecond));
}

TEST(Backlog, AfterAPauseOfTheProcessWaitingFramesAreReadFirst) {
  Backlog backlog;
  std::int64_t now_ns = 1'000 * kMillisecond;
  static_cast<void>(backlog.is_read(now_ns));
  EXPECT_FALSE(backlog.is_read(now_ns += 150 * kMillisecond));
  EXPECT_TRUE(backlog.is_read(now_ns += 5 * kMillisecond));
}

TEST(Backlog, ALinkWhoseStampsAreAlwaysLateDoesNotStopTime) {
  Backlog backlog;
  std::int64_t now_ns = 1'000 * kMillisecond;
  int went_on = 0;
  for (int i = 0; i < 1000; ++i) {
    backlog.frame_taken(3'000 * kMillisecond);
    went_on += backlog.is_read(now_ns += 5 * kMillisecond) ? 1 : 0;
  }
  EXPECT_GE(went_on, 9);
}

/// The first segments of a list, a newer frame of another link, then the rest.
std::size_t scans_of_a_list_with_a_newer_frame_between(bool live) {
  bench::GatewayBench bench(bench::someip_vehicle(true));
  if (live) bench.gateway.start(bench.now_ns);
  replay::EventEncoder encoder({.detection_list = 0x42530101, .ego_motion = 0x42530102});
  bench::Traffic list, other;
  bench::add_someip_list(*bench::synthetic_scan(1, 1, 800), bench.epoch_ns(), encoder, bench::kServer, bench::kEcu,
                         list);
  other.add_can("can0", 0x400, bench::Bytes(8));
  const auto take = [&](std::span<const recording::Frame> frames, std::int64_t received_ns) {
    for (const recording::Frame& frame : frames) {
      bench.gateway.take(frame, {received_ns, bench::GatewayBench::kEpochOffset_ns, TimeSource::kLinkArrival});
    }
  };
  take(list.frames().first(10), bench.now_ns);
  take(other.frames(), bench.now_ns + 900 * kMillisecond);
  take(list.frames().subspan(10), bench.now_ns + kMillisecond);
  return bench.sink.scans;
}

TEST(Backlog, ANewerFrameOfAnotherLinkEndsNoCycleThatWaitsOnThisOne) {
  EXPECT_EQ(scans_of_a_list_with_a_newer_frame_between(true), 1u);
}

TEST(Backlog, InARecordingTheStampsOfFramesAreTheTime) {
  EXPECT_EQ(scans_of_a_list_with_a_newer_frame_between(false), 0u);
}

}  // namespace
}  // namespace boresight::ingest
