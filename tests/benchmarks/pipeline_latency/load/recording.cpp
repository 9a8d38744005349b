#include "tests/benchmarks/pipeline_latency/load/recording.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include "services/simulator/wire/ars548_encoder.hpp"
#include "services/simulator/wire/pcap_writer.hpp"

namespace boresight::bench {

namespace {

constexpr std::int64_t kEpoch_ns = 1'700'000'000'000'000'000;  // of simulated drives

std::uint32_t ipv4(const std::string& text) {
  unsigned a = 0, b = 0, c = 0, d = 0;
  std::sscanf(text.c_str(), "%u.%u.%u.%u", &a, &b, &c, &d);
  return a << 24 | b << 16 | c << 8 | d;
}

}  // namespace

void write_recording(const CrowdedRoad& road, const VehicleConfig& vehicle, double seconds,
                     const std::filesystem::path& file) {
  simulator::wire::PcapWriter pcap(file);
  const auto scan = std::make_unique<RadarScan>();
  const auto bytes = std::make_unique<simulator::wire::Ars548List>();
  const auto radars = static_cast<std::uint32_t>(vehicle.radars.size());
  const auto cycles = static_cast<std::uint32_t>(seconds * 1e9 / static_cast<double>(kCycle_ns));
  for (std::uint32_t i = 0; i < cycles * radars; ++i) {
    const RadarConfig& radar = vehicle.radars[i % radars];
    const std::int64_t since_start_ns = i * (kCycle_ns / radars), time_ns = kEpoch_ns + since_start_ns;
    road.measure(radar, 1e-9 * static_cast<double>(since_start_ns), i / radars, *scan);
    simulator::wire::encode_ars548(*scan, time_ns, *bytes);
    pcap.write(time_ns, {ipv4(radar.source.sender), radar.source.port}, {ipv4(radar.source.address), radar.source.port},
               *bytes);
  }
}

}  // namespace boresight::bench
