// Any bytes as lines of a candump log. An accepted line must be a CAN frame, and writing and reading it again must give
// the same frame.
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "services/common/recording/candump.hpp"
#include "services/common/recording/candump_reader.hpp"
#include "services/common/recording/writer.hpp"
#include "tests/fuzz/support.hpp"

using namespace boresight::recording;
using boresight::fuzz::require;

namespace {

void check_line(std::string_view text) {
  const boresight::fuzz::NoAllocation guard;
  CandumpLine line;
  const CandumpResult result = parse_candump_line(text, line);
  require(!describe(result).empty());
  if (result != CandumpResult::kFrame) return;
  const Frame& frame = line.frame;
  require(frame.can_id <= (frame.can_extended ? 0x1FFFFFFFu : 0x7FFu));
  require(frame.payload.size() <= (frame.kind == FrameKind::kCanFd ? 64u : 8u));
  require(frame.stamp_ns >= 0);
  require(!frame.interface_name().empty());
  std::array<char, kMaxCandumpText> written{};
  const std::size_t size = format_candump(frame, false, written);
  require(size > 0);
  CandumpLine again;
  require(parse_candump_line({written.data(), size}, again) == CandumpResult::kFrame);
  require(again.frame.can_id == frame.can_id && again.frame.can_extended == frame.can_extended);
  require(again.frame.kind == frame.kind && again.frame.can_remote == frame.can_remote);
  require(again.frame.payload.size() == frame.payload.size());
  require(again.frame.interface_name() == frame.interface_name());
  require(frame.payload.empty() ||
          std::memcmp(again.frame.payload.data(), frame.payload.data(), frame.payload.size()) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(are_intervals(text));
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    check_line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return 0;
}
