#include "tests/benchmarks/ingest/copies/count_copies.hpp"

#include "tests/benchmarks/ingest/copies/find_sentinels.hpp"
#include "tests/benchmarks/ingest/gateway_bench.hpp"
#include "tests/benchmarks/ingest/scans.hpp"

namespace boresight::bench {

namespace {

std::unique_ptr<RadarScan> marked_scan(std::uint32_t detections) {
  auto scan = synthetic_scan(1, 1, detections);
  for (std::size_t i = 0; i < detections; ++i) scan->range_m[i] = sentinel_range_m(i);
  return scan;
}

Copies count(GatewayBench& bench, const Traffic& traffic, std::size_t detections) {
  *bench.sink.scan = RadarScan{};
  const SentinelPlaces before = find_sentinels();
  bench.take(traffic);
  const NewPlaces more = new_places(before, find_sentinels(), detections);
  bool all_there = bench.sink.scans == 1;
  for (std::size_t i = 0; i < detections; ++i) all_there &= bench.sink.scan->range_m[i] == sentinel_range_m(i);
  return {.intermediate = more.on_wire_order, .decoded = more.as_float, .into_the_sinks_memory = all_there};
}

}  // namespace

Copies count_ars548_copies() {
  constexpr std::uint32_t kDetections = 800;
  GatewayBench bench(ars548_vehicle());
  Traffic traffic;
  traffic.add_udp(kArs548Sensor, kArs548Group, ars548_list(*marked_scan(kDetections), bench.epoch_ns()));
  return count(bench, traffic, kDetections);
}

Copies count_someip_copies() {
  constexpr std::uint32_t kDetections = 1024;
  GatewayBench bench(someip_vehicle(true));
  replay::EventEncoder encoder({.detection_list = 0x42530101, .ego_motion = 0x42530102});
  Traffic traffic;
  add_someip_list(*marked_scan(kDetections), bench.epoch_ns(), encoder, kServer, kEcu, traffic);
  return count(bench, traffic, kDetections);
}

}  // namespace boresight::bench
