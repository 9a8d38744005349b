// Keeps the fault memory over restarts: restores it before the first report, and writes it when it has changed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/common/runtime/node.hpp"
#include "services/common/runtime/options.hpp"
#include "services/common/runtime/state_writer.hpp"
#include "services/health/config.hpp"
#include "services/health/core/faults/fault_memory.hpp"

namespace boresight::health {

class FaultStore {
 public:
  /// Restores `memory` and continues its operation cycle, or begins one. A file that cannot be used is a fault of the
  /// node and an event of the memory.
  FaultStore(runtime::Node& node, FaultMemory& memory, const FaultStoreConfig& config);
  /// Writes if the memory has changed and the medium is ready. Reports a medium that cannot be written as an event.
  void keep(std::int64_t now_ns);
  /// Writes the last state; call it after the node has stopped.
  void finish();

 private:
  void restore(const std::filesystem::path& file);
  void lose(const std::filesystem::path& file, const std::string& reason, Fault fault);

  runtime::Node& node_;
  FaultMemory& memory_;
  std::unique_ptr<runtime::StateWriter> writer_;  // none: nothing is stored
  std::vector<std::uint8_t> bytes_;
  std::uint64_t offered_revision_ = 0;
  std::uint64_t reported_failures_ = 0;
  std::int64_t retry_ns_ = 0;
};

/// The configured file, or the one of that name in systemd's $STATE_DIRECTORY; nothing if nothing is to be stored.
[[nodiscard]] std::optional<std::filesystem::path> state_file_of(bool enabled, const std::string& path,
                                                                 const char* name);
/// A freeze frame of the present time, without values of the vehicle or a radar.
[[nodiscard]] FreezeFrame frame_now(const FaultMemory& memory);

/// Identifies the operation cycle: the same number until the ECU boots again, or of each start.
[[nodiscard]] std::uint64_t operation_cycle_id(OperationCycle kind);

/// Fingerprint of the vehicle file and of all services' files.
[[nodiscard]] std::uint64_t configuration_fingerprint(const runtime::Configuration& files);

}  // namespace boresight::health
