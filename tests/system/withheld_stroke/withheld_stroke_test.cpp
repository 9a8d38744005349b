// The watchdog of a service is stroked only while its data flow makes progress: an event loop alone is no sign of life.
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "services/common/runtime/node.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/roudi.hpp"
#include "tests/system/runtime/scan_writer.hpp"
#include "tests/system/withheld_stroke/manager.hpp"

namespace boresight {
namespace {

using catalogue::Service;
using harness::Child;
using harness::eventually;
using harness::Manager;
using harness::scan_origin;
using harness::Shared;
using harness::write_scans;
using runtime::Node;
using runtime::Publisher;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kScanPeriod_ns = 20 * kMillisecond_ns;
constexpr std::uint64_t kFewestPerSecond = 5;  // of ten

class Stroke : public testing::Test {
 protected:
  Manager manager_;
  harness::Roudi roudi_;
};

TEST_F(Stroke, ComesWhileAStagePublishesAnOutputForEachInput) {
  Child stage([] {
    Node node(Service::kDetectionCorrector);
    Publisher<CorrectedScan> corrected(node);
    node.on_newest<RadarScan>([&](const RadarScan& scan, std::uint64_t) {
      corrected.publish_from(scan.header, Stage::kCorrector, [](CorrectedScan& out) { out.flags = 0; });
    });
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return manager_.strokes_of(stage.pid()) > 5; })) << "without any input";
  Child writer([] { return write_scans(kScanPeriod_ns); });
  for (int second = 0; second < 2; ++second) {
    EXPECT_GE(manager_.strokes_within(stage.pid(), 1.0), kFewestPerSecond);
  }
  EXPECT_EQ(writer.stop(), 0);
  EXPECT_GE(manager_.strokes_within(stage.pid(), 1.0), kFewestPerSecond) << "the radars are silent";
  EXPECT_EQ(stage.stop(), 0);
}

TEST_F(Stroke, IsWithheldWhileAStageHandlesInputsAndPublishesNothing) {
  Shared<std::array<std::uint64_t, 2>> handled_and_ticks;
  Shared<bool> is_rejecting;
  Child stage([&] {
    Node node(Service::kDetectionCorrector);
    node.on_newest<RadarScan>([&](const RadarScan&, std::uint64_t) {
      ++(*handled_and_ticks)[0];
      if (*is_rejecting) node.nothing_to_publish();
    });
    node.every(kScanPeriod_ns, [&] { ++(*handled_and_ticks)[1]; });
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return manager_.strokes_of(stage.pid()) > 5; }));
  Child writer([] { return write_scans(kScanPeriod_ns); });
  harness::sleep_s(1.0);
  const auto before = *handled_and_ticks;
  EXPECT_EQ(manager_.strokes_within(stage.pid(), 1.0), 0u);
  EXPECT_GT((*handled_and_ticks)[0], before[0] + 10) << "its handler runs";
  EXPECT_GT((*handled_and_ticks)[1], before[1] + 10) << "its loop runs";
  *is_rejecting = true;
  harness::sleep_s(0.5);
  EXPECT_GE(manager_.strokes_within(stage.pid(), 1.0), kFewestPerSecond) << "inputs that are rightly rejected";
  EXPECT_EQ(stage.stop(), 0);
  EXPECT_EQ(writer.stop(), 0);
}

TEST_F(Stroke, IsWithheldWhileAFloodOfSideInputsStarvesTheScansAndADescriptor) {
  struct Seen {
    bool is_slow;
    std::uint64_t side_inputs, scans, ticks;
  };
  Shared<Seen> seen;
  int pipe_ends[2] = {};
  ASSERT_EQ(pipe(pipe_ends), 0);
  for (const bool with_scans : {true, false}) {
    *seen = {};
    Child stage([&] {
      Node node(Service::kAlignmentEstimator);
      node.on<EgoMotion>([&](const EgoMotion&) {
        ++seen->side_inputs;
        if (seen->is_slow) harness::sleep_s(0.015);  // longer than their period
      });
      if (with_scans) {
        node.on<RadarScan>([&](const RadarScan&) { ++seen->scans; });
      } else {
        node.on_readable(pipe_ends[0], [&] {
          char byte = 0;
          if (read(pipe_ends[0], &byte, 1) == 1) ++seen->scans;
        });
      }
      node.every(kScanPeriod_ns, [&] { ++seen->ticks; });
      return node.spin();
    });
    Child writer([&] {
      Node node(Service::kIngestGateway);
      Publisher<EgoMotion> ego(node);
      Publisher<RadarScan> scans(node);
      node.every(4 * kMillisecond_ns, [&] {
        ego.publish(scan_origin(0), [](EgoMotion& motion) { motion.speed_mps = 10.0F; });
        if (with_scans) {
          scans.publish(scan_origin(1), [](RadarScan& scan) { scan.cycle_counter = 1; });
        } else {
          EXPECT_EQ(write(pipe_ends[1], "x", 1), 1);
        }
      });
      return node.spin();
    });
    ASSERT_TRUE(eventually(5.0, [&] { return seen->side_inputs > 20 && seen->scans > 20; }));
    EXPECT_GE(manager_.strokes_within(stage.pid(), 1.0), kFewestPerSecond);
    seen->is_slow = true;
    harness::sleep_s(1.0);
    const Seen before = *seen;
    EXPECT_EQ(manager_.strokes_within(stage.pid(), 1.0), 0u) << "with scans: " << with_scans;
    EXPECT_GT(seen->ticks, before.ticks + 10) << "its loop runs";
    EXPECT_EQ(seen->scans, before.scans) << "the condition of this test";
    seen->is_slow = false;
    EXPECT_TRUE(eventually(2.0, [&] { return seen->scans > before.scans + 20; }));
    EXPECT_GE(manager_.strokes_within(stage.pid(), 1.0), kFewestPerSecond) << "with scans: " << with_scans;
    EXPECT_EQ(writer.stop(), 0);
    EXPECT_EQ(stage.stop(), 0);
  }
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST_F(Stroke, IsWithheldWhileAPeriodicOutputIsMissing) {
  Shared<bool> is_silent;
  Child health([&] {
    Node node(Service::kHealth);
    Publisher<HealthReport> reports(node);
    node.publishes_periodically(catalogue::TopicId::kHealthReport);
    node.every(100 * kMillisecond_ns, [&] {
      if (!*is_silent) reports.publish(scan_origin(0), [](HealthReport& report) { report.number_of_sensors = 0; });
    });
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return manager_.strokes_of(health.pid()) > 5; }));
  EXPECT_GE(manager_.strokes_within(health.pid(), 1.0), kFewestPerSecond);
  *is_silent = true;
  harness::sleep_s(1.0);
  EXPECT_EQ(manager_.strokes_within(health.pid(), 1.0), 0u);
  *is_silent = false;
  harness::sleep_s(0.5);
  EXPECT_GE(manager_.strokes_within(health.pid(), 1.0), kFewestPerSecond);
  EXPECT_EQ(health.stop(), 0);
}

TEST_F(Stroke, IsWithheldWhileAHandlerBlocksOrTheProcessIsStopped) {
  Shared<bool> blocks;
  Child stage([&] {
    Node node(Service::kDetectionCorrector);
    Publisher<CorrectedScan> corrected(node);
    node.on_newest<RadarScan>([&](const RadarScan& scan, std::uint64_t) {
      while (*blocks) harness::sleep_s(0.01);
      corrected.publish_from(scan.header, Stage::kCorrector, [](CorrectedScan& out) { out.flags = 0; });
    });
    return node.spin();
  });
  Child writer([] { return write_scans(kScanPeriod_ns); });
  ASSERT_TRUE(eventually(5.0, [&] { return manager_.strokes_of(stage.pid()) > 5; }));
  *blocks = true;
  harness::sleep_s(0.3);
  EXPECT_EQ(manager_.strokes_within(stage.pid(), 1.0), 0u);
  *blocks = false;
  EXPECT_GE(manager_.strokes_within(stage.pid(), 1.0), kFewestPerSecond);
  stage.send(SIGSTOP);
  harness::sleep_s(0.1);
  EXPECT_EQ(manager_.strokes_within(stage.pid(), 1.0), 0u);
  stage.send(SIGCONT);
  EXPECT_GE(manager_.strokes_within(stage.pid(), 0.3), 1u) << "at once: it could do nothing while it was stopped";
  EXPECT_GE(manager_.strokes_within(stage.pid(), 1.0), kFewestPerSecond);
  EXPECT_EQ(stage.stop(), 0);
  EXPECT_EQ(writer.stop(), 0);
}

TEST_F(Stroke, DoesNotWaitForAManagerThatStandsStill) {
  Shared<std::uint64_t> ticks;
  Child stage([&] {
    Node node(Service::kTracker);
    node.every(kScanPeriod_ns, [&] { ++*ticks; });
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return manager_.strokes_of(stage.pid()) > 5; }));
  manager_.process().send(SIGSTOP);
  harness::sleep_s(3.0);  // more strokes than the queue of a socket holds by default
  const std::uint64_t before = *ticks;
  harness::sleep_s(1.0);
  EXPECT_GT(*ticks, before + 10);
  manager_.process().send(SIGCONT);
  EXPECT_EQ(stage.stop(), 0);
}

TEST_F(Stroke, ComesFromEveryServiceBeforeDuringAndAfterADrive) {
  const std::array<std::string, 6> names = {
      "ingest_gateway", "alignment_estimator", "detection_corrector", "ghost_filter", "tracker", "health"};
  const auto recordings = harness::simulated_drive(6.0);
  std::vector<std::unique_ptr<Child>> services;
  for (const std::string& name : names) services.push_back(harness::start_alone(name));
  for (const auto& service : services) {
    ASSERT_TRUE(eventually(10.0, [&] { return manager_.strokes_of(service->pid()) > 20; })) << "no input yet";
  }
  Child replay([&] {
    setenv("BORESIGHT_RUNTIME_DIR", "/tmp/domain/run", 1);
    const char* const binary = BORESIGHT_BINARY_DIR "/boresight-replay";
    execl(binary, binary, recordings[0].c_str(), recordings[1].c_str(), nullptr);
    return 1;
  });
  EXPECT_EQ(replay.wait_for(20.0), 0);
  harness::sleep_s(1.0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_LT(manager_.longest_gap_s(services[i]->pid()), 0.5) << names[i];
  }
  for (auto& service : services) EXPECT_EQ(service->stop(), 0);
}

TEST(StrokeWithSmallPools, IsWithheldWhileNoChunkIsLeftForTheOutputs) {
  auto segments = roudi::single_segment();
  for (auto& pool : segments.front().pools) {
    if (pool.chunk_bytes >= roudi::chunk_bytes_for(sizeof(RadarScan))) pool.count = 3;
  }
  const Manager manager;
  const harness::Roudi roudi(segments);
  Shared<bool> holds_all;
  Child gateway([&] {
    Node node(Service::kIngestGateway);
    Publisher<RadarScan> scans(node);
    Publisher<EgoMotion> ego(node);
    std::vector<runtime::Loan<RadarScan>> held;
    node.every(kScanPeriod_ns, [&] {
      while (*holds_all && held.size() < 3) held.push_back(scans.loan());
      if (!*holds_all) held.clear();
      scans.publish(scan_origin(1), [](RadarScan& scan) { scan.cycle_counter = 1; });
      ego.publish(scan_origin(0), [](EgoMotion& motion) { motion.speed_mps = 10.0F; });
    });
    return node.spin();
  });
  ASSERT_TRUE(eventually(5.0, [&] { return manager.strokes_of(gateway.pid()) > 5; }));
  *holds_all = true;
  harness::sleep_s(1.0);
  EXPECT_EQ(manager.strokes_within(gateway.pid(), 1.0), 0u) << "although ego motions are still published";
  *holds_all = false;
  harness::sleep_s(0.5);
  EXPECT_GE(manager.strokes_within(gateway.pid(), 1.0), kFewestPerSecond);
  EXPECT_EQ(gateway.stop(), 0);
}

}  // namespace
}  // namespace boresight
