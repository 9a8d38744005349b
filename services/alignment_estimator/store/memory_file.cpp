#include "services/alignment_estimator/store/memory_file.hpp"

#include "services/common/runtime/state_file.hpp"

namespace boresight::alignment {

LoadedMemory load_memory(const std::filesystem::path& file, const Identity& identity) {
  LoadedMemory loaded;
  std::array<std::uint8_t, kMaxMemoryBytes + 1> bytes;
  const runtime::StateBytes read = runtime::read_state_file(file, bytes);
  if (read.kind == runtime::StateBytes::Kind::kMissing) return loaded;
  if (read.kind == runtime::StateBytes::Kind::kUnreadable) {
    loaded.kind = LoadedMemory::Kind::kUnreadable;
    loaded.reason = read.reason;
    return loaded;
  }
  loaded.verdict = decode_memory(std::span(bytes.data(), read.size), identity, loaded.memory, loaded.rejected_radars);
  if (loaded.verdict == MemoryVerdict::kTaken) {
    loaded.kind = LoadedMemory::Kind::kTaken;
    return loaded;
  }
  loaded.kind = LoadedMemory::Kind::kRejected;
  loaded.reason = describe(loaded.verdict);
  if (const std::string problem = runtime::set_state_file_aside(file); !problem.empty()) {
    loaded.reason += ", and " + problem;
  }
  return loaded;
}

}  // namespace boresight::alignment
