#include "services/common/runtime/writer_segments.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace boresight::runtime {

namespace {

constexpr std::string_view kFolder = "/dev/shm/boresight-";

/// Takes a hexadecimal number and the character behind it from the front of `line`; false if they are not there.
bool take_address(std::string_view& line, char behind, std::uintptr_t& address) {
  constexpr int kHexadecimal = 16;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), address, kHexadecimal);
  const auto length = static_cast<std::size_t>(end - line.data());
  if (error != std::errc() || length >= line.size() || *end != behind) return false;
  line.remove_prefix(length + 1);
  return true;
}

}  // namespace

WriterSegments::WriterSegments(std::string_view maps) {
  // 7f12c0000000-7f12c1600000 r--s 00000000 00:19 7   /dev/shm/boresight-tracker
  while (!maps.empty()) {
    const std::size_t length = std::min(maps.find('\n'), maps.size());
    std::string_view line = maps.substr(0, length);
    maps.remove_prefix(std::min(length + 1, maps.size()));
    Range range;
    if (!take_address(line, '-', range.begin) || !take_address(line, ' ', range.end)) continue;
    const std::size_t path = line.find(kFolder);
    if (path == std::string_view::npos) continue;
    const auto name =
        std::find(catalogue::kServiceNames.begin(), catalogue::kServiceNames.end(), line.substr(path + kFolder.size()));
    if (name == catalogue::kServiceNames.end()) continue;
    segments_[static_cast<std::size_t>(name - catalogue::kServiceNames.begin())] = range;
    is_split_ = true;
  }
}

bool WriterSegments::contains(catalogue::Service writer, const void* begin, std::size_t size_bytes) const {
  const Range& segment = segments_[static_cast<std::size_t>(writer)];
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  return address >= segment.begin && address < segment.end && size_bytes <= segment.end - address;
}

bool WriterSegments::accept(const catalogue::Topic& topic, const MessageHeader& message) const {
  if (!is_split_) return true;
  for (std::size_t i = 0; i < catalogue::kNumberOfServices; ++i) {
    const auto writer = static_cast<catalogue::Service>(i);
    if (!topic.writers.contains(writer) || !contains(writer, &message, topic.payload_bytes)) continue;
    return topic.writers.size() == 1 || message.source_id == i;
  }
  return false;
}

}  // namespace boresight::runtime
