// The memory from drive to drive: restores it at start, writes it periodically and at the end.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/alignment_estimator/store/memory_file.hpp"
#include "services/common/runtime/node.hpp"
#include "services/common/runtime/state_writer.hpp"

namespace boresight::alignment {

class Keeper {
 public:
  /// Restores the estimator. Without a file nothing is stored, and a log line reports this. A rejected file is a fault
  /// of the node (kWireValue or kVersionMismatch), an error of the file system as well (kLink).
  Keeper(runtime::Node& node, Estimator& estimator, const VehicleConfig& vehicle,
         const std::optional<std::filesystem::path>& file, double period_s);
  /// Writes at once, after a static calibration.
  void remember();
  /// Writes the last memory if it changed; call it after the node has stopped.
  void finish();

 private:
  void restore(const std::filesystem::path& file);
  void keep();
  /// The estimator's memory with the present time.
  [[nodiscard]] Memory memory_now() const;
  /// Sum over all radars; it grows with every scan used.
  [[nodiscard]] static double drive_s(const Memory& memory);
  /// The memory as bytes; empty if it does not belong to this vehicle. Valid until the next call.
  [[nodiscard]] std::span<const std::uint8_t> encoded(const Memory& memory);
  bool offer(const Memory& memory);

  runtime::Node& node_;
  Estimator& estimator_;
  Identity identity_;
  std::uint64_t boot_;
  MemoryBytes bytes_;
  double kept_drive_s_ = 0.0;
  std::uint64_t reported_failures_ = 0;
  std::unique_ptr<runtime::StateWriter> writer_;
};

}  // namespace boresight::alignment
