// Cost of the integrity checks of one scan.
#include <bit>

#include "services/ingest_gateway/core/scan_integrity.hpp"
#include "tests/benchmarks/ingest/codecs/measure.hpp"
#include "tests/benchmarks/ingest/scans.hpp"

namespace boresight::bench {
namespace {

/// The columns that the checks read, as frames for the reference copies.
std::vector<recording::Frame> columns_of(const RadarScan& scan) {
  std::vector<recording::Frame> columns;
  for (const auto* column : {&scan.range_m, &scan.azimuth_rad, &scan.elevation_rad, &scan.range_rate_mps}) {
    recording::Frame frame;
    frame.payload = {reinterpret_cast<const std::uint8_t*>(column->data()),
                     scan.number_of_valid_detections * sizeof(float)};
    columns.push_back(frame);
  }
  return columns;
}

void judge(benchmark::State& state, std::uint16_t expected, void (*damage)(RadarScan&)) {
  const auto detections = static_cast<std::uint32_t>(state.range(0));
  const auto scan = synthetic_scan(1, 1, detections);
  damage(*scan);
  EgoMotion ego{};
  replay::write_synthetic_ego(ego);
  ingest::ScanJudge judge(RadarConfig{});
  std::int64_t now_ns = 1'000'000'000;
  bool moves = false;
  std::uint16_t verdict = 0;
  const auto prepare = [&] {
    now_ns += 50'000'000;
    ego.header.measurement_time_ns = now_ns - 20'000'000;
    ++scan->cycle_counter;
    // A scan that is identical to the previous one would count as frozen.
    moves = !moves;
    const auto bits = std::bit_cast<std::uint32_t>(scan->range_m[0]);
    scan->range_m[0] = std::bit_cast<float>((bits & ~1u) | (moves ? 1u : 0u));
  };
  const auto take = [&] { verdict = judge.judge(*scan, now_ns, now_ns, 32, &ego); };
  const auto columns = columns_of(*scan);
  measure(state, detections, columns, prepare, take);
  if (verdict != expected) state.SkipWithError("unexpected result of the integrity checks");
}

void integrity_of_sound_scan_per_detection(benchmark::State& state) {
  judge(state, 0, [](RadarScan&) {});
}
void integrity_of_implausible_scan_per_detection(benchmark::State& state) {
  judge(state, scan_integrity::kImplausible, [](RadarScan& scan) {
    for (std::size_t i = 0; i < scan.number_of_valid_detections; i += 2) scan.range_m[i] += 1e6F;
  });
}
void integrity_of_copied_scan_per_detection(benchmark::State& state) {
  judge(state, scan_integrity::kImpossibleCopies, [](RadarScan& scan) {
    const std::size_t half = scan.number_of_valid_detections / 2;
    for (auto* column : {&scan.range_m, &scan.azimuth_rad, &scan.range_rate_mps}) {
      std::copy_n(column->data(), half, column->data() + half);
    }
  });
}
BENCHMARK(integrity_of_sound_scan_per_detection)->Arg(300)->Arg(1024)->UseManualTime();
BENCHMARK(integrity_of_implausible_scan_per_detection)->Arg(300)->Arg(1024)->UseManualTime();
BENCHMARK(integrity_of_copied_scan_per_detection)->Arg(300)->Arg(1024)->UseManualTime();

}  // namespace
}  // namespace boresight::bench
