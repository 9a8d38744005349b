// boresight-bench-ingest_load [SECONDS = 10]: load of eight radars on the real gateway, over two network namespaces.
// Run it with tests/system/isolated and on_wire.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "tests/benchmarks/ingest/load/ars548_radars.hpp"
#include "tests/benchmarks/ingest/load/network.hpp"
#include "tests/benchmarks/ingest/load/scan_log.hpp"
#include "tests/system/harness/roudi.hpp"

using namespace boresight;
using namespace boresight::bench;

namespace {

void send_output_to(const std::string& file) {
  const int descriptor = open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0644);
  dup2(descriptor, STDOUT_FILENO);
  dup2(descriptor, STDERR_FILENO);
}

/// The gateway process, receiving from the network.
class Gateway {
 public:
  Gateway(const std::string& configuration, const std::string& vehicle, const ScanLog& log)
      : process_([&] {
          const std::string binary = std::string(BORESIGHT_BINARY_DIR) + "/boresight-ingest_gateway";
          setenv("BORESIGHT_INPUT", "live", 1);
          setenv("BORESIGHT_RUNTIME_DIR", "/tmp/ingest_load", 1);
          send_output_to("/tmp/ingest_load/" + vehicle + "-gateway.log");
          execl(binary.c_str(), binary.c_str(), "--config", configuration.c_str(), "--vehicle", vehicle.c_str(),
                nullptr);
          return 127;
        }),
        log_(log) {
    const bool runs = harness::eventually(
        10.0, [&] { return log.gateway().pid == process_.pid() && log.gateway().state == ServiceState::kRunning; });
    if (!runs) throw std::runtime_error("the gateway did not start");
  }

  [[nodiscard]] double cpu_s() const { return cpu_time_s(process_.pid()); }
  void stop_for_a_moment() { process_.send(SIGSTOP); }
  void go_on() { process_.send(SIGCONT); }
  /// Number of published scans reported by the gateway, once that number no longer changes.
  [[nodiscard]] std::uint64_t published() const {
    std::uint64_t last = ~std::uint64_t{0};
    // Longer than the period of the heartbeat that carries the number.
    while (last != sum()) {
      last = sum();
      harness::sleep_s(0.35);
    }
    return last;
  }
  /// Faults except link faults: a server that ends withdraws its offers, which is not caused by the load.
  [[nodiscard]] std::uint64_t faults() const {
    std::uint64_t all = 0;
    for (const std::uint64_t n : log_.gateway().faults) all += n;
    return all - log_.gateway().faults[static_cast<std::size_t>(Fault::kLink)];
  }
  [[nodiscard]] std::uint64_t suspect() const {
    std::uint64_t all = 0;
    for (const SourceStatistics& source : log_.gateway().sources) all += source.suspect;
    return all;
  }
  [[nodiscard]] std::uint64_t allocations() const { return log_.gateway().heap_allocations; }
  [[nodiscard]] std::string last_fault() const { return log_.gateway().last_fault.data(); }

 private:
  [[nodiscard]] std::uint64_t sum() const {
    std::uint64_t all = 0;
    for (const SourceStatistics& source : log_.gateway().sources) all += source.messages;
    return all;
  }
  harness::Child process_;
  const ScanLog& log_;
};

/// The replay as a server of the Boresight service with eight synthetic radars that measure together.
class SomeIpServer {
 public:
  SomeIpServer(double seconds, bool together)
      : process_([&] {
          enter_radars_network();
          send_output_to(kOutput);
          const std::string binary = std::string(BORESIGHT_BINARY_DIR) + "/boresight-replay";
          std::vector<std::string> arguments = {binary,
                                                "--via",
                                                "someip",
                                                "--interface",
                                                "radar0",
                                                "--address",
                                                "10.13.2.1",
                                                "--radars",
                                                std::to_string(kRadars),
                                                "--synthetic",
                                                std::to_string(kDetections),
                                                "--rate",
                                                std::to_string(kRate_hz),
                                                "--duration",
                                                std::to_string(seconds)};
          if (together) arguments.emplace_back("--together");
          std::vector<char*> pointers;
          for (std::string& argument : arguments) pointers.push_back(argument.data());
          pointers.push_back(nullptr);
          execv(binary.c_str(), pointers.data());
          return 127;
        }) {}

  /// Waits for the server's end; returns the number of sent lists that it reports.
  std::uint64_t sent(double seconds) {
    const auto code = process_.wait_for(seconds);
    std::ifstream output(kOutput);
    for (std::string line; std::getline(output, line);) {
      unsigned long long lists = 0;
      if (std::sscanf(line.c_str(), "served %llu detection lists", &lists) == 1) return lists;
    }
    throw std::runtime_error("boresight-replay ended with an error: " + std::to_string(code.value_or(-1)));
  }

 private:
  static constexpr const char* kOutput = "/tmp/ingest_load/replay.log";
  harness::Child process_;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print_row(const char* what, const std::string& value, const char* bar = "") {
  std::printf("  %-52s %18s   %s\n", what, value.c_str(), bar);
}
std::string text(std::uint64_t n) {
  return std::to_string(n);
}
std::string fixed(double value, const char* unit) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%.2f %s", value, unit);
  return buffer;
}

struct Counts {
  std::uint64_t sent, published, kernel_drops;
};

void print_counts(const Counts& counts, const Gateway& gateway) {
  print_row("lists sent", text(counts.sent));
  print_row("scans published", text(counts.published));
  print_row("lists lost", text(counts.sent - counts.published), "0");
  print_row("datagrams dropped by the kernel", text(counts.kernel_drops), "0");
  print_row("scans that failed an integrity check", text(gateway.suspect()));
  print_row("faults except link faults, heap allocations", text(gateway.faults()) + ", " + text(gateway.allocations()),
            "0, 0");
  if (gateway.faults() != 0) print_row("latest fault:", gateway.last_fault());
}

void print_latency(const ScanLog& log, std::size_t from) {
  std::vector<double> since_sent_us, since_taken_us;
  for (std::size_t i = from; i < log.size(); ++i) {
    const LoggedScan& scan = log[i];
    since_taken_us.push_back(static_cast<double>(scan.published_ns - scan.taken_ns) * 1e-3);
    if (scan.time_source != TimeSource::kSensorSynchronised) continue;
    since_sent_us.push_back(static_cast<double>(scan.published_ns - scan.measured_ns) * 1e-3);
  }
  for (const auto& [what, us] : {std::pair{"radar starts to send -> scan published, p50 / p99", &since_sent_us},
                                 std::pair{"last datagram received -> scan published, p50 / p99", &since_taken_us}}) {
    print_row(what, fixed(quantile(*us, 0.5), "/") + " " + fixed(quantile(*us, 0.99), "us"));
  }
}

class Bench {
 public:
  explicit Bench(double seconds) : seconds_(seconds), configuration_(write_configuration()) {
    if (!harness::eventually(10.0, [&] { return log_.is_attached(); }))
      throw std::runtime_error("the monitor did not attach");
  }

  void ars548() {
    std::printf("ARS548: one datagram of 35336 bytes per list, in 24 fragments, by multicast to one socket\n");
    Gateway gateway(configuration_, "ars548", log_);
    Ars548Radars radars;
    const auto bare = start_bare_receiver();
    const std::size_t first = log_.size();
    const std::uint64_t drops = kernel_drops();
    radars.send_for(seconds_ + 0.6);
    harness::sleep_s(0.3);
    const double bare_before_s = cpu_time_s(bare->pid());
    const double gateway_percent = cpu_percent(gateway);
    const double bare_percent = 100.0 * (cpu_time_s(bare->pid()) - bare_before_s) / seconds_;
    static_cast<void>(bare->stop());
    finish(radars);
    print_counts({radars.sent(), gateway.published(), kernel_drops() - drops}, gateway);
    print_row("CPU time of the gateway", fixed(gateway_percent, "% of a core"), "below 10 %");
    print_row("CPU time of a process that only receives", fixed(bare_percent, "% of a core"));
    print_latency(log_, first);
    for (const std::uint32_t lists : {20u, kRadars * 20u}) burst(gateway, radars, lists);
  }

  void someip() {
    std::printf("SOME/IP: 28 datagrams per list, discovered, subscribed, unicast to one socket, E2E profile 7\n");
    Gateway gateway(configuration_, "someip", log_);
    const std::size_t first = log_.size();
    const std::uint64_t drops = kernel_drops();
    // Ends between two cycles, so that no list is in transit when the server withdraws its offers.
    SomeIpServer server(seconds_ + 1.62, false);
    if (!harness::eventually(5.0, [&] { return log_.size() > first; }))
      throw std::runtime_error("no scan was published");
    const double gateway_percent = cpu_percent(gateway);
    const std::uint64_t sent = server.sent(5.0);
    print_counts({sent, gateway.published(), kernel_drops() - drops}, gateway);
    print_row("CPU time of the gateway", fixed(gateway_percent, "% of a core"), "below 10 %");
    print_latency(log_, first);
  }

  /// Eight radars that send together while the gateway is stopped: for three cycles, so that 24 lists wait, and then
  /// for twenty cycles (160 lists).
  void someip_burst() {
    Gateway gateway(configuration_, "someip", log_);
    const std::size_t first = log_.size();
    const std::uint64_t drops = kernel_drops();
    SomeIpServer server(4.52, true);
    if (!harness::eventually(5.0, [&] { return log_.size() > first; }))
      throw std::runtime_error("no scan was published");
    for (const double pause_s : {0.15, 0.15, 0.15, 0.15, 1.0}) {
      harness::sleep_s(0.25);
      gateway.stop_for_a_moment();
      harness::sleep_s(pause_s);
      gateway.go_on();
    }
    const std::uint64_t sent = server.sent(10.0);
    std::printf("SOME/IP, all radars at once, gateway stopped for 0.15 s four times, then for 1 s\n");
    print_counts({sent, gateway.published(), kernel_drops() - drops}, gateway);
  }

 private:
  [[nodiscard]] double cpu_percent(const Gateway& gateway) const {
    const double before_s = gateway.cpu_s();
    harness::sleep_s(seconds_);
    return 100.0 * (gateway.cpu_s() - before_s) / seconds_;
  }
  static void finish(const Ars548Radars& radars) {
    if (!harness::eventually(30.0, [&] { return radars.is_done(); }))
      throw std::runtime_error("the radars did not finish sending");
    if (radars.refused() != 0)
      std::printf("  %s lists were refused by the sending kernel\n", text(radars.refused()).c_str());
  }

  void burst(Gateway& gateway, Ars548Radars& radars, std::uint32_t lists) {
    const std::uint64_t published = gateway.published(), sent = radars.sent(), drops = kernel_drops();
    gateway.stop_for_a_moment();
    radars.send_burst(lists);
    finish(radars);
    gateway.go_on();
    std::printf("ARS548, all radars at once, %u lists queued while the gateway is stopped\n", lists);
    print_counts({radars.sent() - sent, gateway.published() - published, kernel_drops() - drops}, gateway);
  }

  double seconds_;
  std::string configuration_;
  harness::Roudi roudi_;
  ScanLog log_;
};

std::string load_average() {
  std::ifstream file("/proc/loadavg");
  std::string text;
  std::getline(file, text);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  if (!has_network()) {
    std::puts("skipped: run it with tests/benchmarks/ingest/load/on_wire");
    return 77;
  }
  try {
    const double seconds = std::max(0.5, argc > 1 ? std::atof(argv[1]) : 10.0);
    std::printf("%u radars x %u detections x %.0f Hz for %.1f s; load average before: %s; right column: required\n",
                kRadars, kDetections, kRate_hz, seconds, load_average().c_str());
    Bench bench(seconds);
    bench.ars548();
    bench.someip();
    bench.someip_burst();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
