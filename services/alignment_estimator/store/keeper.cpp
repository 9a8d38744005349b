#include "services/alignment_estimator/store/keeper.hpp"

#include "services/common/runtime/log.hpp"

namespace boresight::alignment {

namespace log = runtime::log;

Keeper::Keeper(runtime::Node& node, Estimator& estimator, const VehicleConfig& vehicle,
               const std::optional<std::filesystem::path>& file, double period_s)
    : node_(node), estimator_(estimator) {
  if (!file) {
    log::info("nothing is remembered from drive to drive: no file for it");
    return;
  }
  const Identity identity = identity_of(vehicle);
  restore(*file, identity);
  writer_ = std::make_unique<MemoryWriter>(*file, identity);
  node.every(static_cast<std::int64_t>(period_s * 1e9), [this] { keep(); });
}

void Keeper::restore(const std::filesystem::path& file, const Identity& identity) {
  const LoadedMemory loaded = load_memory(file, identity);
  switch (loaded.kind) {
    case LoadedMemory::Kind::kMissing:
      log::info("no alignment remembered in {}: starting from the nominal mounting", file.string());
      break;
    case LoadedMemory::Kind::kTaken:
      estimator_.restore(loaded.memory);
      kept_drive_s_ = drive_s(loaded.memory);
      log::info("alignment of {} radars remembered from {}", loaded.memory.number_of_radars, file.string());
      if (loaded.left_out > 0) {
        log::warning("{} radars are mounted otherwise than remembered: they start anew", loaded.left_out);
      }
      break;
    case LoadedMemory::Kind::kRejected:
      node_.fault(loaded.verdict == MemoryVerdict::kOtherVersion ? Fault::kVersionMismatch : Fault::kWireValue,
                  "remembered alignment is " + loaded.reason);
      log::warning("{}: remembered alignment is {}; it is kept aside and not used", file.string(), loaded.reason);
      break;
    case LoadedMemory::Kind::kUnreadable:
      node_.fault(Fault::kLink, "remembered alignment cannot be read: " + loaded.reason);
      log::warning("{}: remembered alignment cannot be read: {}", file.string(), loaded.reason);
      break;
  }
}

double Keeper::drive_s(const Memory& memory) {
  double sum = 0.0;
  for (std::size_t i = 0; i < memory.number_of_radars; ++i) sum += memory.radars[i].seconds_of_drive;
  return sum;
}

void Keeper::keep() {
  const std::uint64_t failures = writer_->failed();
  if (failures > reported_failures_) {
    node_.fault(Fault::kLink, "alignment cannot be remembered: its file cannot be written",
                failures - reported_failures_);
    reported_failures_ = failures;
  }
  const Memory memory = estimator_.memory();
  // Standing still teaches nothing, and flash wears out.
  if (drive_s(memory) == kept_drive_s_) return;
  if (writer_->offer(memory)) kept_drive_s_ = drive_s(memory);
}

void Keeper::remember() {
  if (!writer_) return;
  const Memory memory = estimator_.memory();
  // What the writer cannot take now, the next turn or the end does.
  kept_drive_s_ = writer_->offer(memory) ? drive_s(memory) : -1.0;
}

void Keeper::finish() {
  if (!writer_) return;
  const Memory memory = estimator_.memory();
  if (memory.number_of_radars == 0) return;
  if (const std::string problem = writer_->finish(memory); !problem.empty()) {
    log::error("alignment cannot be remembered: {}", problem);
  }
}

}  // namespace boresight::alignment
