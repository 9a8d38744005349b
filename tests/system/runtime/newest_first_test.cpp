// Inputs that handle the newest waiting scan of each radar, on real shared memory.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "tests/system/harness/child.hpp"
#include "tests/system/harness/roudi.hpp"
#include "tests/system/runtime/scan_writer.hpp"

namespace boresight {
namespace {

using catalogue::Service;
using harness::Child;
using harness::eventually;
using harness::scan_origin;
using harness::Shared;
using harness::write_scans;
using runtime::monotonic_now_ns;
using runtime::Node;
using runtime::Origin;
using runtime::Publisher;

class NewestFirst : public testing::Test {
 protected:
  static constexpr std::int64_t kMillisecond_ns = 1'000'000;
  harness::Roudi roudi_;
};

TEST_F(NewestFirst, RefusesNewestFirstWhereTheCatalogueHasNoRoomForIt) {
  Child service([] {
    Node node(Service::kAlignmentEstimator);
    EXPECT_THROW(node.on_newest<RadarScan>([](const RadarScan&, std::uint64_t) {}), std::logic_error);
    return 0;
  });
  EXPECT_EQ(service.wait_for(5.0), 0);
}

TEST_F(NewestFirst, SlowStageHandlesTheNewestScanOfEachRadarAndCountsTheDroppedOnes) {
  struct Seen {
    std::uint64_t handled, dropped, wrong_order, late, last_sequence, reported_dropped, reported_lost;
    std::uint64_t outputs_with_latency, ready;
  };
  Shared<Seen> seen;
  Child slow([&] {
    Node node(Service::kDetectionCorrector);
    Publisher<CorrectedScan> corrected(node);
    std::array<std::int64_t, 3> last_ns{};
    node.on_newest<RadarScan>([&](const RadarScan& scan, std::uint64_t dropped) {
      ++seen->handled;
      seen->dropped += dropped;
      const MessageHeader& header = scan.header;
      if (header.measurement_time_ns <= last_ns[header.source_id]) ++seen->wrong_order;
      last_ns[header.source_id] = header.measurement_time_ns;
      // Without the newest first, all scans wait for the whole queue: 64 periods.
      if (monotonic_now_ns() - header.measurement_time_ns > 100 * kMillisecond_ns) ++seen->late;
      seen->last_sequence = std::max(seen->last_sequence, header.sequence);
      harness::sleep_s(0.02);
      corrected.publish_from(header, Stage::kCorrector, [](CorrectedScan& out) { out.flags = 0; });
    });
    seen->ready = 1;
    return node.spin();
  });
  Child observer([&] {
    Node node(Service::kMonitor);
    node.on<ServiceStatus>([&](const ServiceStatus& status) {
      if (status.header.source_id != static_cast<std::uint32_t>(Service::kDetectionCorrector)) return;
      seen->reported_dropped = status.faults[static_cast<std::size_t>(Fault::kInputDropped)];
      seen->reported_lost = status.faults[static_cast<std::size_t>(Fault::kInputLost)];
      const bool is_plausible = status.latency_mean_us >= 20'000.0F && status.latency_mean_us <= status.latency_max_us;
      if (is_plausible) seen->outputs_with_latency += status.latency_count;
    });
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return seen->ready == 1; }));
  Child writer([] { return write_scans(3 * kMillisecond_ns); });
  EXPECT_TRUE(eventually(10.0, [&] { return seen->reported_dropped > 200; })) << seen->reported_dropped;
  EXPECT_EQ(writer.stop(), 0);
  harness::sleep_s(0.4);  // the last scans and heartbeats
  EXPECT_EQ(slow.stop(), 0);
  EXPECT_EQ(observer.stop(), 0);
  EXPECT_EQ(seen->reported_lost, 0u) << "a dropped scan is no gap";
  EXPECT_EQ(seen->reported_dropped, seen->dropped) << "the handler learns of every dropped scan";
  EXPECT_EQ(seen->handled + seen->dropped, seen->last_sequence) << "each published scan is handled or dropped";
  EXPECT_EQ(seen->wrong_order, 0u);
  EXPECT_LT(seen->late, seen->handled / 10);
  EXPECT_GT(seen->outputs_with_latency, seen->handled / 2);
}

TEST_F(NewestFirst, SideInputComesBeforeAPendingScanAndANewerScanSupersedesIt) {
  struct Seen {
    int ready, scan_is_handled, scans_published, list_published;
    std::uint64_t steps;
    std::array<std::int64_t, 8> step;  ///< measurement time of a scan; −1: the track list
    std::uint64_t dropped_of_last;
  };
  Shared<Seen> seen;
  Child corrector([&] {
    Node node(Service::kDetectionCorrector);
    Publisher<CorrectedScan> scans(node);
    const auto publish = [&](std::uint32_t radar, std::int64_t time_ns) {
      const Origin origin{.source_id = radar,
                          .measurement_time_ns = time_ns,
                          .time_source = TimeSource::kLinkArrival,
                          .stage = std::nullopt,
                          .begin_ns = 0};
      scans.publish(origin, [](CorrectedScan& scan) { scan.flags = 0; });
    };
    bool is_done = false;
    node.every(20 * kMillisecond_ns, [&] {
      if (seen->ready != 1 || std::exchange(is_done, true)) return;
      publish(1, 10);
      while (seen->scan_is_handled != 1) harness::sleep_s(0.001);
      publish(2, 20);
      publish(3, 30);
      publish(2, 70);
      seen->scans_published = 1;
    });
    return node.spin();
  });
  Child tracker([&] {
    Node node(Service::kTracker);
    Publisher<TrackList> lists(node);
    bool is_done = false;
    node.every(kMillisecond_ns, [&] {
      if (seen->scan_is_handled != 1 || std::exchange(is_done, true)) return;
      lists.publish(scan_origin(1), [](TrackList& list) { list.number_of_tracks = 0; });
      seen->list_published = 1;
    });
    return node.spin();
  });
  Child ghost_filter([&] {
    Node node(Service::kGhostFilter);
    node.on<TrackList>([&](const TrackList&) { seen->step[seen->steps++ % 8] = -1; });
    node.on_newest<CorrectedScan>([&](const CorrectedScan& scan, std::uint64_t dropped) {
      seen->step[seen->steps++ % 8] = scan.header.measurement_time_ns;
      seen->dropped_of_last = dropped;
      if (seen->steps > 1) return;
      seen->scan_is_handled = 1;
      while (seen->scans_published != 1 || seen->list_published != 1) harness::sleep_s(0.001);
    });
    seen->ready = 1;
    return node.spin();
  });
  EXPECT_TRUE(eventually(5.0, [&] { return seen->steps >= 4; })) << seen->steps;
  harness::sleep_s(0.1);
  EXPECT_EQ(seen->steps, 4u);
  EXPECT_EQ(seen->step[0], 10);
  EXPECT_EQ(seen->step[1], -1) << "the track list comes before the scans that wait";
  EXPECT_EQ(seen->step[2], 30);
  EXPECT_EQ(seen->step[3], 70) << "in place of the scan of 20";
  EXPECT_EQ(seen->dropped_of_last, 1u);
  EXPECT_EQ(ghost_filter.stop(), 0);
  EXPECT_EQ(tracker.stop(), 0);
  EXPECT_EQ(corrector.stop(), 0);
}

}  // namespace
}  // namespace boresight
