// Synthetic scans and their datagrams for benchmarks: stationary objects as seen from a car at 10 m/s, from the
// replay's generator.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/wire/ars548.hpp"
#include "services/common/someip/big_endian.hpp"
#include "services/replay/core/datagrams.hpp"
#include "services/replay/core/event_encoder.hpp"
#include "services/replay/core/synthetic.hpp"
#include "services/simulator/wire/ars548_encoder.hpp"
#include "tests/benchmarks/ingest/traffic.hpp"

namespace boresight::bench {

[[nodiscard]] inline std::unique_ptr<RadarScan> synthetic_scan(std::uint32_t radar, std::uint32_t cycle,
                                                               std::uint32_t detections) {
  auto scan = std::make_unique<RadarScan>();
  replay::write_synthetic_scan(radar, {}, cycle, detections, *scan);
  return scan;
}

[[nodiscard]] inline Bytes ars548_list(const RadarScan& scan, std::int64_t epoch_ns) {
  const auto list = std::make_unique<simulator::wire::Ars548List>();
  simulator::wire::encode_ars548(scan, epoch_ns, *list);
  return {list->begin(), list->end()};
}

/// Turns a list into that of the next cycle: new counter and time stamp, same detections.
inline void advance_ars548(std::span<std::uint8_t> list, std::int64_t epoch_ns, std::uint32_t counter) {
  namespace layout = wire::ars548;
  boresight::write_u32(list.data() + layout::kSeconds, static_cast<std::uint32_t>(epoch_ns / 1'000'000'000));
  boresight::write_u32(list.data() + layout::kNanoseconds, static_cast<std::uint32_t>(epoch_ns % 1'000'000'000));
  boresight::write_u32(list.data() + layout::kSequenceCounter, counter);
}

/// A detection list of the Boresight service as its server sends it, in segments.
inline void add_someip_list(const RadarScan& scan, std::int64_t epoch_ns, replay::EventEncoder& encoder,
                            const recording::Endpoint& from, const recording::Endpoint& to, Traffic& traffic) {
  replay::for_each_datagram(encoder.detection_list(scan, {epoch_ns, 1}), [&](std::span<const std::uint8_t> datagram) {
    traffic.add_udp(from, to, {datagram.begin(), datagram.end()});
  });
}

}  // namespace boresight::bench
