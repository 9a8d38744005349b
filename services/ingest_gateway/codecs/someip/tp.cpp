#include "services/ingest_gateway/codecs/someip/tp.hpp"

#include <algorithm>
#include <cstring>

#include "services/common/someip/big_endian.hpp"

namespace boresight::ingest::someip {

namespace {

constexpr std::size_t kTpHeaderBytes = 4;
constexpr std::size_t kUnitBytes = 16;
constexpr std::uint32_t kMoreSegments = 1;
constexpr std::uint32_t kOffsetMask = 0xFFFFFFF0;  // in bytes: the 28-bit field counts units of 16
// Segments are sent back to back, so a copy of one arrives soon. A much later message with the same session comes from
// a restarted sender.
constexpr std::int64_t kDuplicatesCome_ns = 20'000'000;
// A segment with a session at most this far before the current one was overtaken. Beyond, the sender has restarted.
constexpr std::uint16_t kOvertakenSessions = 16;
// A message without a segment for this time does not make others late, and loses its bytes when its session starts
// again: it was a stray segment, or one with a damaged session id.
constexpr std::int64_t kStalls_ns = 20'000'000;

std::size_t units_in(std::size_t bytes) {
  return (bytes + kUnitBytes - 1) / kUnitBytes;
}
bool test(std::span<const std::uint64_t> bits, std::size_t i) {
  return (bits[i / 64] >> (i % 64) & 1) != 0;
}
void set(std::span<std::uint64_t> bits, std::size_t i) {
  bits[i / 64] |= std::uint64_t{1} << (i % 64);
}

bool is_same_kind(const Message& a, const Message& b) {
  return a.service == b.service && a.method == b.method && a.client == b.client && a.type == b.type &&
         a.protocol_version == b.protocol_version && a.interface_version == b.interface_version;
}

}  // namespace

bool is_fault(TpResult result) {
  switch (result) {
    case TpResult::kAccepted:
    case TpResult::kComplete:
    case TpResult::kDuplicate:
    case TpResult::kLate:
    case TpResult::kRefused:
      return false;
    default:
      return true;
  }
}

std::string_view describe(TpResult result) {
  switch (result) {
    case TpResult::kAccepted:
    case TpResult::kComplete:
      return "";
    case TpResult::kDuplicate:
      return "SOME/IP-TP: repeated segment";
    case TpResult::kLate:
      return "SOME/IP-TP: segment of a message that a newer one has replaced";
    case TpResult::kRefused:
      return "SOME/IP-TP: segment of a message that is too long";
    case TpResult::kNotASegment:
      return "SOME/IP-TP: message without the TP bit";
    case TpResult::kNoSession:
      return "SOME/IP-TP: session id 0; segments need one above 0";
    case TpResult::kTooShort:
      return "SOME/IP-TP: segment without a TP header or without data";
    case TpResult::kNotMultiple:
      return "SOME/IP-TP: length of a segment that is not the last is not a multiple of 16";
    case TpResult::kContradiction:
      return "SOME/IP-TP: segment contradicts the length that another segment stated";
    case TpResult::kOverSize:
      return "SOME/IP-TP: message longer than configured";
  }
  return "SOME/IP-TP: unknown fault";
}

TpReassembler::TpReassembler(std::size_t slots, std::size_t max_message_bytes, std::int64_t timeout_ns)
    : max_message_bytes_(std::max(max_message_bytes, kUnitBytes)),
      timeout_ns_(timeout_ns),
      // Payloads are aligned to 16 bytes for faster access.
      buffer_bytes_(kHeaderBytes + units_in(max_message_bytes_) * kUnitBytes),
      words_per_assembly_((units_in(max_message_bytes_) + 63) / 64),
      assemblies_(std::max<std::size_t>(slots, 1)),
      buffers_(assemblies_.size() * buffer_bytes_),
      units_(assemblies_.size() * words_per_assembly_) {}

std::size_t TpReassembler::index_of(const Assembly& assembly) const {
  return static_cast<std::size_t>(&assembly - assemblies_.data());
}

std::span<std::uint8_t> TpReassembler::buffer_of(const Assembly& assembly) {
  return std::span(buffers_).subspan(index_of(assembly) * buffer_bytes_, buffer_bytes_);
}

std::span<std::uint64_t> TpReassembler::units_of(const Assembly& assembly) {
  return std::span(units_).subspan(index_of(assembly) * words_per_assembly_, words_per_assembly_);
}

bool TpReassembler::is_over(const Assembly& assembly, std::int64_t now_ns) const {
  if (assembly.state == State::kFree) return false;
  return now_ns - assembly.since_ns > (assembly.state == State::kAssembling ? timeout_ns_ : kDuplicatesCome_ns);
}

void TpReassembler::drop(Assembly& assembly) {
  if (assembly.state == State::kAssembling) ++statistics_.dropped_incomplete;
  assembly.state = State::kFree;
}

std::size_t TpReassembler::expire(std::int64_t now_ns) {
  const std::uint64_t before = statistics_.dropped_incomplete;
  for (Assembly& assembly : assemblies_) {
    if (is_over(assembly, now_ns)) drop(assembly);
  }
  return static_cast<std::size_t>(statistics_.dropped_incomplete - before);
}

TpReassembler::Assembly* TpReassembler::find(const Message& segment, const recording::Endpoint& sender) {
  const auto found = std::find_if(assemblies_.begin(), assemblies_.end(), [&](const Assembly& a) {
    return a.state != State::kFree && is_same_kind(a.header, segment) && a.sender == sender;
  });
  return found == assemblies_.end() ? nullptr : &*found;
}

TpReassembler::Assembly& TpReassembler::begin(const Message& segment, const recording::Endpoint& sender,
                                              std::int64_t now_ns) {
  // Free slots first, then slots kept only to detect duplicates. Then the sender's own slots, so that a sender of many
  // incomplete messages harms only itself; then the oldest.
  const auto rank = [&](const Assembly& a) {
    if (a.state != State::kAssembling) return a.state == State::kFree ? 0 : 1;
    return a.sender == sender ? 2 : 3;
  };
  const auto gives_way_before = [&](const Assembly& a, const Assembly& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.since_ns < b.since_ns;
  };
  Assembly& assembly = *std::min_element(assemblies_.begin(), assemblies_.end(), gives_way_before);
  drop(assembly);
  assembly = {};
  assembly.state = State::kAssembling;
  assembly.header = segment;
  assembly.header.tp = false;
  assembly.header.payload = assembly.header.protected_data = {};
  assembly.sender = sender;
  assembly.since_ns = now_ns;
  const std::span<std::uint64_t> units = units_of(assembly);
  std::fill(units.begin(), units.end(), 0);
  return assembly;
}

TpResult TpReassembler::place(Assembly& assembly, std::size_t offset, std::span<const std::uint8_t> data, bool last) {
  const std::size_t end = offset + data.size();
  const bool ends_elsewhere =
      assembly.total_bytes != 0 && (last ? end != assembly.total_bytes : end > assembly.total_bytes);
  if (ends_elsewhere || (last && end < assembly.received_end)) return TpResult::kContradiction;

  const std::span<std::uint64_t> units = units_of(assembly);
  std::uint8_t* const payload = buffer_of(assembly).data() + kHeaderBytes;
  const std::size_t first_unit = offset / kUnitBytes;
  const std::size_t end_unit = units_in(end);
  std::size_t new_units = 0;
  // Copies runs of new units; existing bytes stay, as the first segment has priority.
  for (std::size_t unit = first_unit; unit < end_unit;) {
    if (test(units, unit)) {
      ++unit;
      continue;
    }
    const std::size_t run_begin = unit;
    for (; unit < end_unit && !test(units, unit); ++unit) set(units, unit);
    const std::size_t from = run_begin * kUnitBytes;
    std::memcpy(payload + from, data.data() + (from - offset), std::min(unit * kUnitBytes, end) - from);
    new_units += unit - run_begin;
  }
  const bool tells_the_end = last && assembly.total_bytes == 0;
  if (last) assembly.total_bytes = end;
  assembly.received_end = std::max(assembly.received_end, end);
  assembly.received_units += new_units;
  const bool brings_nothing = new_units == 0 && !tells_the_end;
  if (brings_nothing) {
    ++statistics_.duplicates;
  } else if (new_units < end_unit - first_unit) {
    ++statistics_.overlaps;
  }
  if (assembly.total_bytes != 0 && assembly.received_units == units_in(assembly.total_bytes))
    return TpResult::kComplete;
  return brings_nothing ? TpResult::kDuplicate : TpResult::kAccepted;
}

Message TpReassembler::finish(Assembly& assembly, const Message& last_segment, std::int64_t now_ns) {
  ++statistics_.completed;
  assembly.state = State::kDelivered;
  assembly.since_ns = assembly.last_ns = now_ns;
  Message complete = assembly.header;
  complete.return_code = last_segment.return_code;
  const std::span<std::uint8_t> whole = buffer_of(assembly).first(kHeaderBytes + assembly.total_bytes);
  write_header(complete, assembly.total_bytes, whole.first<kHeaderBytes>());
  complete.payload = whole.subspan(kHeaderBytes);
  complete.protected_data = whole.subspan(kHeaderBytes - kLengthCountsBytes);
  return complete;
}

TpResult TpReassembler::take(const Message& segment, const recording::Endpoint& sender, std::int64_t now_ns,
                             Message& complete) {
  if (!segment.tp) return TpResult::kNotASegment;
  const auto bad = [this](TpResult reason) {
    ++statistics_.bad_segments;
    return reason;
  };
  if (segment.session == 0) return bad(TpResult::kNoSession);
  if (segment.payload.size() < kTpHeaderBytes) return bad(TpResult::kTooShort);
  const std::uint32_t tp_header = read_u32(segment.payload.data());
  const std::size_t offset = tp_header & kOffsetMask;
  const bool last = (tp_header & kMoreSegments) == 0;
  const std::span<const std::uint8_t> data = segment.payload.subspan(kTpHeaderBytes);
  // A last segment without data ends a message whose length is a multiple of the segments' length, as sent by scapy.
  if (data.empty() && (!last || offset == 0)) return bad(TpResult::kTooShort);
  if (!last && data.size() % kUnitBytes != 0) return bad(TpResult::kNotMultiple);

  Assembly* assembly = find(segment, sender);
  if (assembly != nullptr && is_over(*assembly, now_ns)) {
    drop(*assembly);
    assembly = nullptr;
  }
  const bool stalls = assembly != nullptr && now_ns - assembly->last_ns > kStalls_ns;
  if (assembly != nullptr && (assembly->header.session != segment.session || (stalls && offset == 0))) {
    const auto behind = static_cast<std::uint16_t>(assembly->header.session - segment.session);
    if (behind <= kOvertakenSessions && !stalls) {
      ++statistics_.late_segments;
      return TpResult::kLate;
    }
    drop(*assembly);
    assembly = nullptr;
  }
  if (assembly != nullptr && assembly->state == State::kDelivered) {
    ++statistics_.duplicates;
    return TpResult::kDuplicate;
  }
  if (assembly != nullptr && assembly->state == State::kRefused) return TpResult::kRefused;
  if (offset > max_message_bytes_ || data.size() > max_message_bytes_ - offset) {
    ++statistics_.over_size;
    if (assembly != nullptr) {
      drop(*assembly);
      assembly->state = State::kRefused;
      assembly->since_ns = assembly->last_ns = now_ns;
    }
    return TpResult::kOverSize;
  }
  if (assembly == nullptr) assembly = &begin(segment, sender, now_ns);
  assembly->last_ns = now_ns;
  const TpResult result = place(*assembly, offset, data, last);
  if (result == TpResult::kContradiction) return bad(result);
  if (result == TpResult::kComplete) complete = finish(*assembly, segment, now_ns);
  return result;
}

}  // namespace boresight::ingest::someip
