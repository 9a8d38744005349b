// What the service remembers from drive to drive: takes it up at start, puts it down every now and then and at the end.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/alignment_estimator/store/memory_writer.hpp"
#include "services/common/runtime/node.hpp"

namespace boresight::alignment {

class Keeper {
 public:
  /// Without a file it keeps nothing and says so. Restores the estimator; a file that is refused is a fault of the node
  /// (kWireValue, or kVersionMismatch), one that the file system refuses too (kLink).
  Keeper(runtime::Node& node, Estimator& estimator, const VehicleConfig& vehicle,
         const std::optional<std::filesystem::path>& file, double period_s);
  /// Something was learnt that no drive taught, a calibration: it is put down at once.
  void remember();
  /// The last memory, if there is something new in it; call it when the node has stopped.
  void finish();

 private:
  void restore(const std::filesystem::path& file, const Identity& identity);
  void keep();
  /// Of all radars together: it grows with every scan that taught something.
  [[nodiscard]] static double drive_s(const Memory& memory);

  runtime::Node& node_;
  Estimator& estimator_;
  double kept_drive_s_ = 0.0;
  std::uint64_t reported_failures_ = 0;
  std::unique_ptr<MemoryWriter> writer_;
};

}  // namespace boresight::alignment
