#include "services/health/core/faults/codec.hpp"

#include "services/common/state/frame.hpp"

namespace boresight::health {

namespace {

constexpr std::string_view kMagic = "BORFAULT";

bool has_history(const FaultRecord& record) {
  return record.status.last != TestResult::kNone || record.status.occurrences > 0 || record.status.is_stored() ||
         record.status.bits != dtc_status::kCleared;
}

void write_frame(state::ByteWriter& out, const FreezeFrame& frame) {
  out.u64(static_cast<std::uint64_t>(frame.time_ns));
  out.u64(frame.uptime_ns);
  out.u32(frame.cycle);
  for (const float value :
       {frame.speed_mps, frame.rate_hz, frame.detections_per_scan, frame.lateral_displacement_m,
        frame.reference_range_m, frame.lost_coverage_ratio, frame.range_loss_ratio, frame.velocity_error_mps}) {
    out.f32(value);
  }
  for (const float value : frame.estimate) out.f32(value);
  for (const float value : frame.covariance) out.f32(value);
  out.u64(frame.configuration);
  out.text(std::string_view(frame.software.data(), frame.software.size()));
}

FreezeFrame read_frame(state::ByteReader& in) {
  FreezeFrame frame;
  frame.time_ns = static_cast<std::int64_t>(in.u64());
  frame.uptime_ns = in.u64();
  frame.cycle = in.u32();
  for (float* value :
       {&frame.speed_mps, &frame.rate_hz, &frame.detections_per_scan, &frame.lateral_displacement_m,
        &frame.reference_range_m, &frame.lost_coverage_ratio, &frame.range_loss_ratio, &frame.velocity_error_mps}) {
    *value = in.f32();
  }
  for (float& value : frame.estimate) value = in.f32();
  for (float& value : frame.covariance) value = in.f32();
  frame.configuration = in.u64();
  for (char& c : frame.software) c = static_cast<char>(in.u8());
  frame.software.back() = '\0';
  return frame;
}

}  // namespace

const char* describe(StoredFaults verdict) {
  switch (verdict) {
    case StoredFaults::kTaken:
      return "taken";
    case StoredFaults::kCorrupt:
      return "corrupt";
    case StoredFaults::kOtherVersion:
      return "of another version";
  }
  return "unknown";
}

std::size_t encode_fault_memory(const FaultMemory& memory, std::span<std::uint8_t> out) {
  state::ByteWriter writer(out);
  state::begin_frame(writer, kMagic, kFaultMemoryVersion);
  writer.u32(memory.cycle());
  writer.u64(memory.cycle_id());
  const std::size_t count_at = writer.size();
  writer.u32(0);
  std::uint32_t count = 0;
  for (const FaultRecord& record : memory.records()) {
    if (!has_history(record)) continue;
    ++count;
    const EventStatus& status = record.status;
    writer.u32(dtc_of(record.event));
    writer.u8(status.bits);
    writer.u8(status.failed_cycles);
    writer.u8(status.healed_cycles);
    writer.u8(status.aged_cycles);
    writer.u8(static_cast<std::uint8_t>(status.last));
    writer.u16(status.occurrences);
    write_frame(writer, record.first);
    write_frame(writer, record.latest);
  }
  writer.replace_u32(count_at, count);
  return state::end_frame(writer);
}

StoredFaults decode_fault_memory(std::span<const std::uint8_t> bytes, FaultMemory& memory) {
  const state::Frame frame = state::open_frame(bytes, kMagic, kFaultMemoryVersion);
  if (frame.verdict == state::FrameVerdict::kOtherVersion) return StoredFaults::kOtherVersion;
  if (frame.verdict != state::FrameVerdict::kIntact) return StoredFaults::kCorrupt;
  state::ByteReader reader(frame.content);
  const std::uint32_t cycle = reader.u32();
  const std::uint64_t cycle_id = reader.u64();
  const std::uint32_t count = reader.u32();
  if (!reader.fits() || reader.left() != count * kFaultRecordBytes) return StoredFaults::kCorrupt;
  FaultMemory restored = memory;
  for (std::uint32_t i = 0; i < count; ++i) {
    FaultRecord record{};
    const std::optional<Event> event = event_of(reader.u32());
    record.status.bits = reader.u8();
    record.status.failed_cycles = reader.u8();
    record.status.healed_cycles = reader.u8();
    record.status.aged_cycles = reader.u8();
    const std::uint8_t last = reader.u8();
    record.status.occurrences = reader.u16();
    record.first = read_frame(reader);
    record.latest = read_frame(reader);
    if (!event || last > static_cast<std::uint8_t>(TestResult::kFailed)) return StoredFaults::kCorrupt;
    record.event = *event;
    record.status.last = static_cast<TestResult>(last);
    restored.restore(record);
  }
  restored.restore_cycle(cycle, cycle_id);
  memory = restored;
  return StoredFaults::kTaken;
}

}  // namespace boresight::health
