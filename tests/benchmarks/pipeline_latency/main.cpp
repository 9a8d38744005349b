// boresight-bench-pipeline_latency [SECONDS = 20] [--radars N] [--detections N] [--busy N]: run it by
// tests/system/isolated, or where no other RouDi runs.
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/statistics.hpp"
#include "tests/benchmarks/pipeline_latency/bare_chain.hpp"
#include "tests/benchmarks/pipeline_latency/load/bench_vehicle.hpp"
#include "tests/benchmarks/pipeline_latency/load/crowded_road.hpp"
#include "tests/benchmarks/pipeline_latency/load/recording.hpp"
#include "tests/benchmarks/pipeline_latency/stage_losses.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

using namespace boresight;

namespace {

struct Load {
  double seconds = 20.0;
  std::uint32_t radars = 4;
  std::uint32_t detections = bench::kDetections;  ///< of a scan
  unsigned busy = 0;                              ///< neighbours: processes that compute all the time

  /// The load that the bars are for.
  [[nodiscard]] bool is_default() const { return radars == 4 && detections == bench::kDetections && busy == 0; }
};

constexpr double kMostTrackerMean_ms = 1.0, kMostTrackerP99_ms = 3.0;

void print(const char* what, const std::vector<double>& ns) {
  std::printf("%-34s %9.0f %9.0f %9.0f %9.0f\n", what, bench::mean(ns) * 1e-3, bench::quantile(ns, 0.5) * 1e-3,
              bench::quantile(ns, 0.99) * 1e-3, bench::quantile(ns, 1.0) * 1e-3);
}

void print_bar(const char* what, double figure_ms, double most_ms) {
  std::printf("bar: %s %.2f ms, required ≤ %g ms: %s\n", what, figure_ms, most_ms,
              figure_ms <= most_ms ? "met" : "missed");
}

/// Processes that compute until they are stopped, at the priority of the services on the data path.
std::vector<std::unique_ptr<harness::Child>> start_neighbours(unsigned count) {
  std::vector<std::unique_ptr<harness::Child>> neighbours;
  for (unsigned i = 0; i < count; ++i) {
    neighbours.push_back(std::make_unique<harness::Child>([] {
      runtime::install_stop_signals();
      volatile std::uint64_t work = 0;
      while (!runtime::stop_signalled()) work = work + 1;
      return 0;
    }));
  }
  return neighbours;
}

void print_losses(const std::array<bench::StageLosses, catalogue::kNumberOfServices>& losses) {
  std::printf("%-34s %9s %9s %9s\n", "messages (gateway: with ego motion)", "published", "lost", "dropped");
  using enum catalogue::Service;
  for (const catalogue::Service service : {kIngestGateway, kDetectionCorrector, kGhostFilter, kTracker}) {
    const bench::StageLosses& stage = losses[static_cast<std::size_t>(service)];
    const std::string name(catalogue::name_of(service));
    std::printf("%-34s %9llu %9llu %9llu\n", name.c_str(), static_cast<unsigned long long>(stage.outputs),
                static_cast<unsigned long long>(stage.lost), static_cast<unsigned long long>(stage.dropped));
  }
}

int run(const Load& load) {
  const auto config = bench::write_bench_vehicle(harness::shipped_configuration(), "/tmp/bench_config", load.radars);
  const VehicleConfig vehicle = config::read_vehicle_file(config / "vehicle" / "bench.toml");
  const simulator::Scenario scenario = simulator::scenario("straight_rail");
  const auto ego = harness::simulated_drive(load.seconds, scenario.name).back();
  const std::filesystem::path scans = "/tmp/load.pcap";
  bench::write_recording(bench::CrowdedRoad(scenario.ego.speed_mps.front().value, load.detections), vehicle,
                         load.seconds, scans);
  const std::vector<std::size_t> chunks = {sizeof(RadarScan), sizeof(CorrectedScan), sizeof(ClassifiedScan)};

  std::vector<double> total, ipc;
  std::array<std::vector<double>, kNumberOfStages> processing;
  std::array<bench::StageLosses, catalogue::kNumberOfServices> losses{};
  {
    harness::Observer observer("-bench");
    harness::Domain domain("bench", {}, config);
    domain.start();
    if (!domain.until(5.0, [&] { return observer.is_attached(); })) return 1;
    const auto neighbours = start_neighbours(load.busy);
    domain.replay({scans, ego});
    if (!domain.until(load.seconds + 20.0, [&] { return domain.replay_has_ended(); })) return 1;
    domain.run_for(0.3);
    losses = bench::losses_of(observer);
    const auto lists = observer.of(catalogue::TopicId::kTrackList);
    for (const harness::Sample* sample : lists) {
      const auto& stamps = sample->header.stages;
      double between_ns = 0.0;
      for (std::size_t i = 0; i < kNumberOfStages; ++i) {
        processing[i].push_back(static_cast<double>(stamps[i].end_ns - stamps[i].begin_ns));
        if (i > 0) between_ns += static_cast<double>(stamps[i].begin_ns - stamps[i - 1].end_ns);
      }
      ipc.push_back(between_ns);
      total.push_back(static_cast<double>(stamps[kNumberOfStages - 1].end_ns - stamps[0].begin_ns));
    }
    static_cast<void>(observer.process().stop());
  }
  if (total.empty()) return 1;
  std::printf("%u radars x %u detections x 20 Hz, %u moving and %u false, %u busy neighbours, %zu track lists\n",
              load.radars, load.detections, bench::kMovingDetections, bench::kFalseDetections, load.busy, total.size());
  print_losses(losses);
  std::printf("%-34s %9s %9s %9s %9s\n", "us", "mean", "p50", "p99", "max");
  const char* const names[] = {"ingest gateway", "detection corrector", "ghost filter", "tracker"};
  for (std::size_t i = 0; i < kNumberOfStages; ++i) print(names[i], processing[i]);
  print("between the processes (IPC)", ipc);
  print("total: first datagram to track list", total);
  if (!load.is_default()) return 0;
  const auto bare = bench::bare_chain(chunks, bench::kCycle_ns / load.radars,
                                      static_cast<std::size_t>(load.seconds * 20.0 * load.radars));
  if (bare.empty()) return 1;
  print("bare iceoryx chain, same hops", bare);
  std::printf("IPC share / bare chain at p50: %.2f (at most 1.3)\n",
              bench::quantile(ipc, 0.5) / bench::quantile(bare, 0.5));
  const std::vector<double>& tracker_ns = processing[kNumberOfStages - 1];
  print_bar("tracker, mean", bench::mean(tracker_ns) * 1e-6, kMostTrackerMean_ms);
  print_bar("tracker, p99", bench::quantile(tracker_ns, 0.99) * 1e-6, kMostTrackerP99_ms);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Load load;
  CLI::App app("Latency from a radar's datagram to the track list, and lost and dropped scans");
  app.add_option("seconds", load.seconds, "length of the drive")->check(CLI::Range(1.0, 600.0));
  app.add_option("--radars", load.radars, "number of radars")->check(CLI::Range(1U, bench::kMostRadars));
  app.add_option("--detections", load.detections, "detections of a scan; more than 300 are stationary ones")
      ->check(CLI::Range(100U, 800U));
  app.add_option("--busy", load.busy, "neighbours that compute all the time")->check(CLI::Range(0U, 64U));
  CLI11_PARSE(app, argc, argv);
  try {
    return run(load);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
