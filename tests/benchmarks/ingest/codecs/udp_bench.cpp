// Detection lists of an ARS548: whole datagrams and IP fragments.
#include "interfaces/wire/ars548.hpp"
#include "services/common/recording/ip.hpp"
#include "tests/benchmarks/ingest/codecs/measure.hpp"
#include "tests/benchmarks/ingest/gateway_bench.hpp"
#include "tests/benchmarks/ingest/scans.hpp"

namespace boresight::bench {
namespace {

void ars548_list_per_detection(benchmark::State& state) {
  const auto detections = static_cast<std::uint32_t>(state.range(0));
  GatewayBench bench(ars548_vehicle());
  Traffic traffic;
  traffic.add_udp(kArs548Sensor, kArs548Group, ars548_list(*synthetic_scan(1, 1, detections), bench.epoch_ns()));
  std::uint32_t counter = 0;
  const auto prepare = [&] {
    bench.next_cycle();
    advance_ars548(traffic.bytes(0), bench.epoch_ns(), ++counter);
  };
  measure(state, detections, traffic.frames(), prepare, [&] { bench.take(traffic); });
  if (bench.sink.scans != counter) state.SkipWithError("a list was not decoded");
}
BENCHMARK(ars548_list_per_detection)->Arg(300)->Arg(800)->UseManualTime();

/// Cost of rejecting a list with a wrong length field.
void ars548_rejected_list(benchmark::State& state) {
  GatewayBench bench(ars548_vehicle());
  Traffic traffic;
  traffic.add_udp(kArs548Sensor, kArs548Group, ars548_list(*synthetic_scan(1, 1, 800), bench.epoch_ns()));
  traffic.bytes(0)[7] = 1;
  measure(
      state, 1.0, traffic.frames(), [&] { bench.next_cycle(); }, [&] { bench.take(traffic); });
  if (bench.sink.scans != 0) state.SkipWithError("a damaged list was accepted");
}
BENCHMARK(ars548_rejected_list)->UseManualTime();

/// Ethernet packets of one list, fragmented by IPv4 for an MTU of 1500.
Traffic fragments_of(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kUdpHeader = 8, kIpHeader = 20, kEthernetHeader = 14, kPerFragment = 1480;
  Bytes datagram(kUdpHeader + payload.size());
  boresight::write_u16(datagram.data(), kArs548Sensor.port);
  boresight::write_u16(datagram.data() + 2, kArs548Group.port);
  boresight::write_u16(datagram.data() + 4, static_cast<std::uint16_t>(datagram.size()));
  std::copy(payload.begin(), payload.end(), datagram.begin() + kUdpHeader);
  Traffic packets;
  for (std::size_t at = 0; at < datagram.size(); at += kPerFragment) {
    const std::size_t size = std::min(kPerFragment, datagram.size() - at);
    const bool more = at + size < datagram.size();
    Bytes packet(kEthernetHeader + kIpHeader + size);
    boresight::write_u16(packet.data() + 12, 0x0800);
    std::uint8_t* const ip = packet.data() + kEthernetHeader;
    ip[0] = 0x45;
    boresight::write_u16(ip + 2, static_cast<std::uint16_t>(kIpHeader + size));
    boresight::write_u16(ip + 6, static_cast<std::uint16_t>((more ? 0x2000u : 0u) | at / 8));
    ip[8] = 1;
    ip[9] = 17;
    boresight::write_u32(ip + 12, kArs548Sensor.address.to_v4());
    boresight::write_u32(ip + 16, kArs548Group.address.to_v4());
    std::copy_n(datagram.begin() + static_cast<std::ptrdiff_t>(at), size, ip + kIpHeader);
    packets.add_udp({}, {}, std::move(packet));
  }
  return packets;
}

void ip_reassembly_per_fragment(benchmark::State& state) {
  const Bytes list = ars548_list(*synthetic_scan(1, 1, 800), 1'700'000'000'000'000'000);
  Traffic packets = fragments_of(list);
  recording::UdpDecoder decoder;
  recording::Frame frame;
  std::uint16_t identification = 0;
  std::size_t whole = 0;
  const auto prepare = [&] {
    ++identification;
    for (std::size_t i = 0; i < packets.frames().size(); ++i)
      boresight::write_u16(packets.bytes(i).data() + 18, identification);
  };
  const auto take = [&] {
    for (const recording::Frame& packet : packets.frames()) {
      if (decoder.decode(packet.payload, recording::LinkLayer::kEthernet, frame) == recording::PacketResult::kFrame) {
        whole += frame.payload.size() == list.size() ? 1u : 0u;
      }
    }
  };
  measure(state, static_cast<double>(packets.frames().size()), packets.frames(), prepare, take);
  if (whole != static_cast<std::size_t>(state.iterations())) state.SkipWithError("a datagram was not reassembled");
}
BENCHMARK(ip_reassembly_per_fragment)->UseManualTime();

}  // namespace
}  // namespace boresight::bench
