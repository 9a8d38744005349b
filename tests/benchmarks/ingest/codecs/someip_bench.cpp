// Detection lists of the Boresight service in segments, and service discovery.
#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/sd_message.hpp"
#include "tests/benchmarks/ingest/codecs/measure.hpp"
#include "tests/benchmarks/ingest/gateway_bench.hpp"
#include "tests/benchmarks/ingest/scans.hpp"

namespace boresight::bench {
namespace {

void someip_list(benchmark::State& state, bool protection, bool per_segment) {
  const auto detections = static_cast<std::uint32_t>(state.range(0));
  GatewayBench bench(someip_vehicle(protection));
  replay::EventEncoder encoder({.detection_list = 0x42530101, .ego_motion = 0x42530102});
  const auto scan = synthetic_scan(1, 0, detections);
  Traffic traffic, reference;
  add_someip_list(*scan, bench.epoch_ns(), encoder, kServer, kEcu, reference);
  const auto prepare = [&] {
    bench.next_cycle();
    ++scan->cycle_counter;
    traffic.clear();
    add_someip_list(*scan, bench.epoch_ns(), encoder, kServer, kEcu, traffic);
  };
  const auto segments = static_cast<double>(reference.frames().size());
  measure(state, per_segment ? segments : detections, reference.frames(), prepare, [&] { bench.take(traffic); });
  if (bench.sink.scans != scan->cycle_counter) state.SkipWithError("a list was not decoded");
}
void someip_tp_list_e2e_per_detection(benchmark::State& state) {
  someip_list(state, true, false);
}
void someip_tp_list_e2e_per_segment(benchmark::State& state) {
  someip_list(state, true, true);
}
void someip_tp_list_per_detection(benchmark::State& state) {
  someip_list(state, false, false);
}
BENCHMARK(someip_tp_list_e2e_per_detection)->Arg(300)->Arg(800)->Arg(1024)->UseManualTime();
BENCHMARK(someip_tp_list_e2e_per_segment)->Arg(1024)->UseManualTime();
BENCHMARK(someip_tp_list_per_detection)->Arg(1024)->UseManualTime();

/// One message with the offers of 8 radars, all of them subscribed; each is answered by a subscription.
void someip_sd_per_offer(benchmark::State& state) {
  namespace service = wire::boresight_service;
  constexpr std::uint16_t kRadars = 8;
  VehicleConfig vehicle = someip_vehicle(true);
  const recording::Endpoint discovery{kServer.address, 30490};
  const recording::Endpoint group{recording::parse_ip(vehicle.radars[0].source.discovery_address).value(), 30490};
  boresight::someip::SdWriter writer;
  const RadarConfig radar = vehicle.radars[0];
  vehicle.radars.clear();
  for (std::uint16_t instance = 1; instance <= kRadars; ++instance) {
    vehicle.radars.push_back(radar);
    vehicle.radars.back().id = instance;
    vehicle.radars.back().source.sender.clear();
    vehicle.radars.back().source.instance = instance;
    writer.offer({service::kServiceId, instance, service::kMajorVersion, service::kMinorVersion}, 3,
                 {kServer.address, static_cast<std::uint16_t>(30600 + instance)});
  }
  GatewayBench bench(vehicle);
  Traffic traffic;
  traffic.add_udp(discovery, group, writer.finish(1, false));
  std::uint16_t session = 0;
  const auto prepare = [&] {
    bench.next_cycle();
    session = session == 0xFFFF ? std::uint16_t{1} : static_cast<std::uint16_t>(session + 1);
    constexpr std::size_t kSession = 10;
    boresight::write_u16(traffic.bytes(0).data() + kSession, session);
  };
  measure(state, kRadars, traffic.frames(), prepare, [&] { bench.take(traffic); });
  if (bench.sink.count(Fault::kWireValue) + bench.sink.count(Fault::kWireLength) != 0) {
    state.SkipWithError("an offer was not decoded");
  }
}
BENCHMARK(someip_sd_per_offer)->UseManualTime();

}  // namespace
}  // namespace boresight::bench
