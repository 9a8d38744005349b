// CAN radars, frame by frame, and frames with ids of no source.
#include <filesystem>

#include "interfaces/wire/srr520.hpp"
#include "interfaces/wire/toyota.hpp"
#include "services/common/e2e/crc.hpp"
#include "services/common/recording/candump.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "services/simulator/wire/toyota_encoder.hpp"
#include "tests/benchmarks/ingest/codecs/measure.hpp"
#include "tests/benchmarks/ingest/gateway_bench.hpp"
#include "tests/unit/ingest_gateway/ars408_frames.hpp"

namespace boresight::bench {
namespace {

/// `scans`: expected number of scans per cycle of the traffic.
void measure_can(benchmark::State& state, GatewayBench& bench, const Traffic& cycle, std::size_t scans) {
  std::size_t cycles = 0;
  const auto prepare = [&] {
    bench.next_cycle();
    ++cycles;
  };
  measure(state, static_cast<double>(cycle.frames().size()), cycle.frames(), prepare, [&] { bench.take(cycle); });
  if (bench.sink.scans != scans * cycles) state.SkipWithError("a cycle was not decoded");
}

void can_toyota_per_frame(benchmark::State& state) {
  namespace layout = wire::toyota;
  GatewayBench bench(can_vehicle(RadarProfile::kToyota));
  Traffic cycle;
  for (const std::uint32_t base : {layout::kTrackA, layout::kTrackB}) {
    for (std::uint32_t track = 0; track < layout::kNumberOfTracks; ++track) {
      Bytes bytes{0, static_cast<std::uint8_t>(track + 1), 0, 0x40, 0, static_cast<std::uint8_t>(track), 0x80, 0};
      bytes.back() = layout::checksum(base + track, bytes);
      cycle.add_can("can1", base + track, std::move(bytes));
    }
  }
  measure_can(state, bench, cycle, 1);
}
BENCHMARK(can_toyota_per_frame)->UseManualTime();

/// A near list of 500 detections: header, 50 record frames of 64 bytes, closing frame with the CRC over all of them.
void can_fd_srr520_per_frame(benchmark::State& state) {
  namespace layout = wire::srr520;
  const layout::ListLayout& list = layout::kLists[layout::kNearList];
  const auto detections = static_cast<std::uint16_t>(list.number_of_frames * list.entries_per_frame);
  GatewayBench bench(can_vehicle(RadarProfile::kSrr520));
  Traffic cycle;
  Bytes header(layout::kHeaderBytes), listed;
  header[layout::header::kSyncStatus] = layout::kSyncOk;
  boresight::write_u16(header.data() + layout::header::kAmbiguousVelocity, 39794);
  boresight::write_u16(header.data() + list.count_offset, detections);
  listed = header;
  cycle.add_can("can1", list.header_id, header);
  for (std::size_t i = 0; i < list.number_of_frames; ++i) {
    Bytes record(layout::kRecordFrameBytes);
    for (std::size_t k = 0; k < layout::kFrameNumber; ++k) record[k] = static_cast<std::uint8_t>(17 * i + 29 * k);
    record[layout::kFrameNumber] = static_cast<std::uint8_t>(i);
    record[layout::kFrameSequence] = 0;
    listed.insert(listed.end(), record.begin(), record.end());
    cycle.add_can("can1", list.record_id, record);
  }
  Bytes closing(layout::kClosingBytes);
  closing[layout::closing::kListId] = layout::kNearList;
  boresight::write_u16(closing.data() + layout::closing::kCrc, e2e::crc16_ccitt_false(listed));
  cycle.add_can("can1", layout::kClosingId, closing);
  measure_can(state, bench, cycle, 1);
}
BENCHMARK(can_fd_srr520_per_frame)->UseManualTime();

/// 200 clusters with their quality frames.
void can_ars408_per_frame(benchmark::State& state) {
  std::vector<ingest::ars408_frames::Target> clusters(200);
  for (std::size_t i = 0; i < clusters.size(); ++i) clusters[i].x_m = 10.0 + static_cast<double>(i);
  GatewayBench bench(can_vehicle(RadarProfile::kArs408));
  Traffic cycle;
  for (const auto& frame : ingest::ars408_frames::cluster_cycle(clusters, true)) {
    cycle.add_can("can1", frame.id, frame.bytes);
  }
  measure_can(state, bench, cycle, 1);
}
BENCHMARK(can_ars408_per_frame)->UseManualTime();

/// The example radar described by a DBC file only: 64 detections, each in two pages.
void can_mapped_per_frame(benchmark::State& state) {
  ingest::Mappings mappings;
  const std::filesystem::path folder = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config" / "mappings";
  mappings.radars.emplace(1, ingest::read_radar_mapping(folder / "example_radar.toml"));
  GatewayBench bench(can_vehicle(RadarProfile::kMapping), mappings);
  constexpr std::uint32_t kHeaderId = 768, kDetectionId = 769;
  Traffic cycle;
  cycle.add_can("can1", kHeaderId, {1, 0, 32, 32, 0, 0, 0, 0});
  for (unsigned number = 0; number < 64; ++number) {
    for (unsigned page = 0; page < 2; ++page) {
      Bytes bytes(16);
      constexpr unsigned kState = 1;
      bytes[0] = static_cast<std::uint8_t>(number);
      bytes[1] = static_cast<std::uint8_t>(page | kState << 2);
      bytes[2] = static_cast<std::uint8_t>(number);
      bytes[3] = 10;
      cycle.add_can("can1", kDetectionId, std::move(bytes));
    }
  }
  measure_can(state, bench, cycle, 1);
}
BENCHMARK(can_mapped_per_frame)->UseManualTime();

void can_toyota_ego_per_frame(benchmark::State& state) {
  GatewayBench bench(can_vehicle(RadarProfile::kToyota));
  Traffic cycle;
  const simulator::EgoSignals signals{.speed_mps = 12.0, .yaw_rate_radps = 0.1, .steering_angle_rad = 0.0};
  for (const auto& frame : simulator::wire::encode_ego(signals)) {
    cycle.add_can("can0", frame.id, {frame.bytes.begin(), frame.bytes.end()});
  }
  measure_can(state, bench, cycle, 0);
  if (bench.sink.egos == 0) state.SkipWithError("no ego motion");
}
BENCHMARK(can_toyota_ego_per_frame)->UseManualTime();

/// Frames with ids of no source, on a bus with a radar: most frames of a bus are of this kind.
void can_foreign_id_per_frame(benchmark::State& state) {
  GatewayBench bench(can_vehicle(RadarProfile::kToyota));
  Traffic cycle;
  for (std::uint32_t id = 0x400; id < 0x500; ++id) cycle.add_can("can1", id, Bytes(8));
  measure_can(state, bench, cycle, 0);
}
BENCHMARK(can_foreign_id_per_frame)->UseManualTime();

void candump_line(benchmark::State& state, std::string_view line) {
  Traffic text;
  text.add_udp({}, {}, {line.begin(), line.end()});
  recording::CandumpLine parsed;
  std::size_t bad = 0;
  const auto take = [&] {
    for (int i = 0; i < 100; ++i) {
      if (recording::parse_candump_line(line, parsed) != recording::CandumpResult::kFrame) ++bad;
    }
  };
  measure(
      state, 100.0, text.frames(), [] {}, take);
  // The references copied one line, not a hundred.
  for (const char* ratio : {"x_copy", "x_bswap"}) state.counters[ratio].value /= 100.0;
  if (bad != 0) state.SkipWithError("a line was not decoded");
}
void candump_line_can(benchmark::State& state) {
  candump_line(state, "(1536574931.237846) can0 210#8003C0FE0000A7C2");
}
void candump_line_can_fd(benchmark::State& state) {
  candump_line(state, "(1536574931.237846) can0 00000384##1" + std::string(64, 'A') + std::string(64, '5'));
}
BENCHMARK(candump_line_can)->UseManualTime();
BENCHMARK(candump_line_can_fd)->UseManualTime();

}  // namespace
}  // namespace boresight::bench
