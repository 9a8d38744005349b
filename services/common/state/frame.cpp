#include "services/common/state/frame.hpp"

#include <algorithm>

#include "services/common/e2e/crc.hpp"

namespace boresight::state {

namespace {
constexpr std::size_t kLengthAt = 12;
}

void begin_frame(ByteWriter& writer, std::string_view magic, std::uint32_t version) {
  writer.text(magic);
  writer.u32(version);
  writer.u32(0);  // the length, known at the end
}

std::size_t end_frame(ByteWriter& writer) {
  writer.replace_u32(kLengthAt, static_cast<std::uint32_t>(writer.size() + 4));
  writer.u32(e2e::crc32_p4(writer.written()));
  return writer.fits() ? writer.size() : 0;
}

Frame open_frame(std::span<const std::uint8_t> bytes, std::string_view magic, std::uint32_t version) {
  Frame frame;
  if (bytes.size() < kFrameBytes || !std::equal(magic.begin(), magic.end(), bytes.begin())) return frame;
  ByteReader head(bytes.subspan(magic.size()));
  const std::uint32_t found = head.u32(), length = head.u32();
  if (length != bytes.size()) return frame;
  if (ByteReader(bytes.last(4)).u32() != e2e::crc32_p4(bytes.first(bytes.size() - 4))) return frame;
  frame.verdict = found == version ? FrameVerdict::kIntact : FrameVerdict::kOtherVersion;
  if (found == version) frame.content = bytes.subspan(kFrameHeadBytes, bytes.size() - kFrameBytes);
  return frame;
}

}  // namespace boresight::state
