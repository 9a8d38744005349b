// The runtime on real shared memory: its guarantees for services.
#include <cstdlib>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/node.hpp"
#include "services/common/runtime/stop_signal.hpp"
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

constexpr std::int64_t kMillisecond_ns = 1'000'000;

class RuntimeOnBus : public testing::Test {
 protected:
  harness::Roudi roudi_;
};

TEST_F(RuntimeOnBus, CarriesMessagesInOrderWithBothSequencesAndTheirStamps) {
  struct Seen {
    std::uint64_t scans, corrected, wrong;
  };
  Shared<Seen> seen;
  Child corrector([] {
    Node node(Service::kDetectionCorrector);
    Publisher<CorrectedScan> corrected(node);
    node.on<RadarScan>([&](const RadarScan& scan) {
      corrected.publish_from(scan.header, Stage::kCorrector,
                             [&](CorrectedScan& out) { out.cycle_counter = scan.cycle_counter; });
    });
    return node.spin();
  });
  Child observer([&seen] {
    Node node(Service::kMonitor);
    std::uint64_t last = 0;
    std::array<std::uint64_t, 3> last_of_radar{};
    node.on<RadarScan>([&](const RadarScan& scan) {
      ++seen->scans;
      const auto& header = scan.header;
      auto& of_radar = last_of_radar[header.source_id];
      const bool first = last == 0;
      const bool right = header.version == RadarScan::kVersion &&
                         header.source_id == 1 + (scan.cycle_counter - 1) % 2 &&
                         header.sequence == scan.cycle_counter && (first || header.sequence == last + 1) &&
                         (of_radar == 0 || header.source_sequence == of_radar + 1) &&
                         scan.range_m[0] == static_cast<float>(scan.cycle_counter) &&
                         header.stage(Stage::kIngest).begin_ns >= header.measurement_time_ns &&
                         header.stage(Stage::kIngest).end_ns >= header.stage(Stage::kIngest).begin_ns &&
                         header.stage(Stage::kCorrector).end_ns == 0;
      if (!right) ++seen->wrong;
      last = header.sequence;
      of_radar = header.source_sequence;
    });
    node.on<CorrectedScan>([&](const CorrectedScan& scan) {
      ++seen->corrected;
      const auto& header = scan.header;
      const auto& ingest = header.stage(Stage::kIngest);
      const auto& corrector_stamp = header.stage(Stage::kCorrector);
      const bool right = header.source_id == 1 + (scan.cycle_counter - 1) % 2 && ingest.begin_ns > 0 &&
                         header.measurement_time_ns <= ingest.begin_ns && ingest.begin_ns <= ingest.end_ns &&
                         ingest.end_ns <= corrector_stamp.begin_ns &&
                         corrector_stamp.begin_ns <= corrector_stamp.end_ns &&
                         header.time_source == TimeSource::kLinkArrival;
      if (!right) ++seen->wrong;
    });
    return node.spin();
  });
  Child writer([] { return write_scans(5 * kMillisecond_ns); });
  EXPECT_TRUE(eventually(10.0, [&] { return seen->scans >= 200 && seen->corrected >= 200; }))
      << seen->scans << " scans, " << seen->corrected << " corrected";
  EXPECT_EQ(writer.stop(), 0);
  EXPECT_EQ(corrector.stop(), 0);
  EXPECT_EQ(observer.stop(), 0);
  EXPECT_EQ(seen->wrong, 0u);
}

TEST_F(RuntimeOnBus, StopsWithin200MillisecondsOfSigterm) {
  Shared<int> spinning;
  for (const bool with_descriptor : {false, true}) {
    *spinning = 0;
    Child service([&] {
      Node node(with_descriptor ? Service::kIngestGateway : Service::kTracker);
      int pipe_ends[2] = {};
      EXPECT_EQ(pipe(pipe_ends), 0);
      if (with_descriptor) {
        node.on_readable(pipe_ends[0], [] {});
      } else {
        node.on<ClassifiedScan>([](const ClassifiedScan&) {});
      }
      node.every(kMillisecond_ns, [&] { *spinning = 1; });
      return node.spin();
    });
    ASSERT_TRUE(eventually(5.0, [&] { return *spinning == 1; }));
    const std::int64_t asked_ns = monotonic_now_ns();
    EXPECT_EQ(service.stop(), 0);
    EXPECT_LT(monotonic_now_ns() - asked_ns, 200 * kMillisecond_ns);
  }
}

TEST_F(RuntimeOnBus, TimersOfAServiceThatInputsWakeKeepTheirPeriod) {
  Shared<std::uint64_t> ticks;
  Child service([&] {
    Node node(Service::kTracker);
    node.on<ClassifiedScan>([](const ClassifiedScan&) {});
    node.every(5 * kMillisecond_ns, [&] { ++*ticks; });
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return *ticks > 0; }));
  const std::uint64_t before = *ticks;
  harness::sleep_s(1.0);
  EXPECT_GE(*ticks - before, 100u) << "of 200, without any input";
  EXPECT_EQ(service.stop(), 0);
}

TEST_F(RuntimeOnBus, RefusesWritersAndReadersThatTheCatalogueDoesNotList) {
  Child service([] {
    Node node(Service::kTracker);
    EXPECT_THROW(Publisher<RadarScan>{node}, std::logic_error);
    EXPECT_THROW(node.on<RadarScan>([](const RadarScan&) {}), std::logic_error);
    EXPECT_NO_THROW(node.on_newest<ClassifiedScan>([](const ClassifiedScan&, std::uint64_t) {}));
    EXPECT_NO_THROW(Publisher<TrackList>{node});
    return 0;
  });
  EXPECT_EQ(service.wait_for(5.0), 0);
}

TEST_F(RuntimeOnBus, SlowReaderLosesTheOldestCountsThemAndDelaysNoOther) {
  struct Seen {
    std::uint64_t slow, fast, fast_gaps, reported_lost, published;
  };
  Shared<Seen> seen;
  Child slow([&] {
    Node node(Service::kDetectionCorrector);
    node.on<RadarScan>([&](const RadarScan&) {
      ++seen->slow;
      harness::sleep_s(0.03);
    });
    return node.spin();
  });
  Child observer([&] {
    Node node(Service::kMonitor);
    std::uint64_t last = 0;
    node.on<RadarScan>([&](const RadarScan& scan) {
      ++seen->fast;
      if (last != 0 && scan.header.sequence != last + 1) ++seen->fast_gaps;
      last = seen->published = scan.header.sequence;
    });
    node.on<ServiceStatus>([&](const ServiceStatus& status) {
      if (status.header.source_id != static_cast<std::uint32_t>(Service::kDetectionCorrector)) return;
      seen->reported_lost = status.faults[static_cast<std::size_t>(Fault::kInputLost)];
    });
    return node.spin();
  });
  Child writer([] { return write_scans(3 * kMillisecond_ns); });
  EXPECT_TRUE(eventually(10.0, [&] { return seen->reported_lost > 50; })) << seen->reported_lost;
  EXPECT_EQ(seen->fast_gaps, 0u);
  EXPECT_EQ(writer.stop(), 0);
  // Handled, lost and waiting messages of the slow reader add up to all published ones.
  const std::uint64_t waiting = catalogue::queue_capacity(catalogue::topic(catalogue::TopicId::kRadarScan));
  EXPECT_LE(seen->published, seen->slow + seen->reported_lost + 2 * waiting);
  EXPECT_EQ(slow.stop(), 0);
  EXPECT_EQ(observer.stop(), 0);
}

TEST_F(RuntimeOnBus, SideInputIsHandledBeforeTheScansThatWait) {
  struct Seen {
    int ready, scans_before_estimate, scans, estimates;
  };
  Shared<Seen> seen;
  Child writer([&] {
    Node node(Service::kIngestGateway);
    Publisher<RadarScan> scans(node);
    Publisher<EgoMotion> ego(node);
    node.every(10 * kMillisecond_ns, [&] {
      if (seen->ready != 1) return;
      for (int i = 0; i < 5; ++i) scans.publish(scan_origin(1), [](RadarScan& scan) { scan.cycle_counter = 1; });
      ego.publish(scan_origin(0), [](EgoMotion& motion) { motion.speed_mps = 10.0F; });
      seen->ready = 2;
    });
    return node.spin();
  });
  Child reader([&] {
    Node node(Service::kAlignmentEstimator);
    node.on<EgoMotion>([&](const EgoMotion&) { ++seen->estimates; });
    node.on<RadarScan>([&](const RadarScan&) {
      ++seen->scans;
      if (seen->estimates == 0) ++seen->scans_before_estimate;
    });
    bool asked = false;
    node.every(20 * kMillisecond_ns, [&] {
      // Waits inside its own loop until all messages are in its queues.
      if (std::exchange(asked, true)) return;
      seen->ready = 1;
      while (seen->ready != 2) harness::sleep_s(0.001);
    });
    return node.spin();
  });
  EXPECT_TRUE(eventually(5.0, [&] { return seen->scans == 5 && seen->estimates == 1; }));
  EXPECT_EQ(seen->scans_before_estimate, 0);
  EXPECT_EQ(reader.stop(), 0);
  EXPECT_EQ(writer.stop(), 0);
}

TEST_F(RuntimeOnBus, TimersAndHeartbeatContinueUnderAFlood) {
  struct Seen {
    std::uint64_t ticks, heartbeats, scans;
  };
  Shared<Seen> seen;
  Child flooded([&] {
    Node node(Service::kDetectionCorrector);
    node.on<RadarScan>([&](const RadarScan&) {
      ++seen->scans;
      harness::sleep_s(0.004);  // longer than the period of scans: the queue never runs empty
    });
    node.every(20 * kMillisecond_ns, [&] { ++seen->ticks; });
    return node.spin();
  });
  Child observer([&] {
    Node node(Service::kMonitor);
    node.on<ServiceStatus>([&](const ServiceStatus& status) {
      if (status.header.source_id == static_cast<std::uint32_t>(Service::kDetectionCorrector)) ++seen->heartbeats;
    });
    return node.spin();
  });
  Child writer([] { return write_scans(kMillisecond_ns); });
  ASSERT_TRUE(eventually(10.0, [&] { return seen->scans > 10; }));
  const Seen before = *seen;
  harness::sleep_s(1.0);
  EXPECT_GE(seen->ticks - before.ticks, 25u) << "of 50";
  EXPECT_GE(seen->heartbeats - before.heartbeats, 5u) << "of 10";
  EXPECT_EQ(flooded.stop(), 0);
  EXPECT_EQ(observer.stop(), 0);
  EXPECT_EQ(writer.stop(), 0);
}

TEST_F(RuntimeOnBus, CountsHeapAllocationsOfTheDataPathAndOnlyThose) {
  struct Seen {
    std::uint64_t scans, sound, leaky, sound_heartbeats;
  };
  Shared<Seen> seen;
  Child sound([] {
    Node node(Service::kDetectionCorrector);
    Publisher<CorrectedScan> corrected(node);
    node.on<RadarScan>([&](const RadarScan& scan) {
      corrected.publish_from(scan.header, Stage::kCorrector, [](CorrectedScan& out) { out.flags = 0; });
    });
    return node.spin();
  });
  Child leaky([] {
    Node node(Service::kAlignmentEstimator);
    node.on<RadarScan>([](const RadarScan& scan) {
      void* volatile memory = std::malloc(scan.cycle_counter % 7 + 100);
      std::free(memory);
    });
    return node.spin();
  });
  Child observer([&] {
    Node node(Service::kMonitor);
    node.on<CorrectedScan>([&](const CorrectedScan&) { ++seen->scans; });
    node.on<ServiceStatus>([&](const ServiceStatus& status) {
      if (status.header.source_id == static_cast<std::uint32_t>(Service::kDetectionCorrector)) {
        seen->sound = status.heap_allocations;
        ++seen->sound_heartbeats;
      }
      if (status.header.source_id == static_cast<std::uint32_t>(Service::kAlignmentEstimator)) {
        seen->leaky = status.heap_allocations;
      }
    });
    return node.spin();
  });
  Child writer([] { return write_scans(2 * kMillisecond_ns); });
  EXPECT_TRUE(eventually(10.0, [&] { return seen->scans > 200 && seen->sound_heartbeats > 0; })) << seen->scans;
#ifndef BORESIGHT_SANITIZED
  EXPECT_TRUE(eventually(10.0, [&] { return seen->leaky > 100; })) << seen->leaky;
#endif
  EXPECT_EQ(seen->sound, 0u);
  EXPECT_EQ(sound.stop(), 0);
  EXPECT_EQ(leaky.stop(), 0);
  EXPECT_EQ(observer.stop(), 0);
  EXPECT_EQ(writer.stop(), 0);
}

TEST_F(RuntimeOnBus, LateReaderGetsTheHistory) {
  Shared<int> published;
  Shared<int> received;
  Child writer([&] {
    Node node(Service::kAlignmentEstimator);
    Publisher<AlignmentEstimate> estimates(node);
    for (std::uint32_t radar = 1; radar <= 4; ++radar) {
      estimates.publish(scan_origin(radar), [](AlignmentEstimate& e) { e.speed_scale = 1.01F; });
    }
    *published = 1;
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return *published == 1; }));
  Child reader([&] {
    Node node(Service::kDetectionCorrector);
    node.on<AlignmentEstimate>([&](const AlignmentEstimate& estimate) {
      if (estimate.speed_scale == 1.01F) ++*received;
    });
    return node.spin();
  });
  EXPECT_TRUE(eventually(5.0, [&] { return *received == 4; })) << *received << " of 4";
  EXPECT_EQ(reader.stop(), 0);
  EXPECT_EQ(writer.stop(), 0);
}

TEST_F(RuntimeOnBus, NodeWithDescriptorsServesThemAndItsInputs) {
  struct Seen {
    int bytes, heartbeats;
  };
  Shared<Seen> seen;
  int pipe_ends[2] = {};
  ASSERT_EQ(pipe(pipe_ends), 0);
  Child peer([] { return Node(Service::kTracker).spin(); });
  Child node_with_descriptor([&] {
    Node node(Service::kHealth);
    node.on<ServiceStatus>([&](const ServiceStatus& status) {
      if (status.header.source_id == static_cast<std::uint32_t>(Service::kTracker)) ++seen->heartbeats;
    });
    node.on_readable(pipe_ends[0], [&] {
      char byte = 0;
      if (read(pipe_ends[0], &byte, 1) == 1 && ++seen->bytes == 3) node.remove_descriptor(pipe_ends[0]);
    });
    return node.spin();
  });
  for (int i = 0; i < 5; ++i) ASSERT_EQ(write(pipe_ends[1], "x", 1), 1);
  EXPECT_TRUE(eventually(5.0, [&] { return seen->bytes == 3 && seen->heartbeats > 3; }))
      << seen->bytes << " bytes, " << seen->heartbeats << " heartbeats";
  harness::sleep_s(0.1);
  EXPECT_EQ(seen->bytes, 3) << "a removed descriptor is not served";
  EXPECT_EQ(node_with_descriptor.stop(), 0);
  EXPECT_EQ(peer.stop(), 0);
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST(RuntimeWithoutRoudi, WaitsForItAndStartsWhenItAppears) {
  Shared<int> connected;
  Child service([&] {
    Node node(Service::kTracker);
    *connected = 1;
    return node.spin();
  });
  harness::sleep_s(0.3);
  EXPECT_EQ(*connected, 0);
  harness::Roudi roudi;
  EXPECT_TRUE(eventually(2.0, [&] { return *connected == 1; }));
  EXPECT_EQ(service.stop(), 0);
}

TEST(RuntimeWithoutRoudi, CanBeStoppedWhileItWaits) {
  Child service([] {
    EXPECT_THROW(Node{Service::kTracker}, std::runtime_error);
    return 0;
  });
  harness::sleep_s(0.2);
  EXPECT_EQ(service.stop(1.0), 0);
}

TEST(RuntimeWithSmallPools, FailedLoanIsCountedAndTheServiceContinues) {
  auto segments = roudi::single_segment();
  const std::size_t chunk_bytes = roudi::chunk_bytes_for(sizeof(RadarScan));
  for (auto& pool : segments.front().pools) {
    // Larger pools would replace exhausted ones, so they are small as well.
    if (pool.chunk_bytes >= chunk_bytes) pool.count = 3;
  }
  const harness::Roudi roudi(segments);
  Child service([] {
    Node node(Service::kIngestGateway);
    Publisher<RadarScan> scans(node);
    std::vector<runtime::Loan<RadarScan>> held;
    for (int i = 0; i < 3; ++i) held.push_back(scans.loan());
    for (const auto& loan : held) EXPECT_TRUE(loan);
    EXPECT_FALSE(scans.loan());
    EXPECT_FALSE(scans.publish(scan_origin(1), [](RadarScan&) { ADD_FAILURE() << "nothing to fill"; }));
    held.clear();
    EXPECT_TRUE(scans.publish(scan_origin(1), [](RadarScan& scan) { scan.cycle_counter = 1; }));
    node.every(kMillisecond_ns, [] {});
    return node.spin();
  });
  Shared<std::uint64_t> failed;
  Child observer([&] {
    Node node(Service::kHealth);
    node.on<ServiceStatus>([&](const ServiceStatus& status) {
      if (status.header.source_id == static_cast<std::uint32_t>(Service::kIngestGateway)) {
        *failed = status.faults[static_cast<std::size_t>(Fault::kLoanFailed)];
      }
    });
    return node.spin();
  });
  EXPECT_TRUE(eventually(5.0, [&] { return *failed == 2; })) << *failed;
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(observer.stop(), 0);
}

}  // namespace
}  // namespace boresight
