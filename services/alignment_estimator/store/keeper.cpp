#include "services/alignment_estimator/store/keeper.hpp"

#include "services/common/runtime/boot_time.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"

namespace boresight::alignment {

namespace log = runtime::log;

Keeper::Keeper(runtime::Node& node, Estimator& estimator, const VehicleConfig& vehicle,
               const std::optional<std::filesystem::path>& file, double period_s)
    : node_(node), estimator_(estimator), identity_(identity_of(vehicle)), boot_(runtime::boot_fingerprint()) {
  if (!file) {
    log::info("no memory over ignition cycles: no file is configured");
    return;
  }
  restore(*file);
  writer_ = std::make_unique<runtime::StateWriter>(*file, kMaxMemoryBytes);
  node.every(static_cast<std::int64_t>(period_s * 1e9), [this] { keep(); });
}

void Keeper::restore(const std::filesystem::path& file) {
  const LoadedMemory loaded = load_memory(file, identity_);
  switch (loaded.kind) {
    case LoadedMemory::Kind::kMissing:
      log::info("no stored alignment in {}: starting from the nominal mounting", file.string());
      break;
    case LoadedMemory::Kind::kTaken:
      estimator_.restore(loaded.memory, runtime::seconds_between({loaded.memory.boot, loaded.memory.since_boot_ns},
                                                                 {boot_, runtime::since_boot_ns()}));
      kept_drive_s_ = drive_s(loaded.memory);
      log::info("alignment of {} radars restored from {}", loaded.memory.number_of_radars, file.string());
      if (loaded.rejected_radars > 0) {
        log::warning("{} radars have another mounting than the stored one: they start from the nominal mounting",
                     loaded.rejected_radars);
      }
      break;
    case LoadedMemory::Kind::kRejected:
      node_.fault(loaded.verdict == MemoryVerdict::kOtherVersion ? Fault::kVersionMismatch : Fault::kWireValue,
                  "stored alignment is " + loaded.reason);
      log::warning("{}: stored alignment is {}; kept with the suffix .rejected and not used", file.string(),
                   loaded.reason);
      break;
    case LoadedMemory::Kind::kUnreadable:
      node_.fault(Fault::kLink, "stored alignment cannot be read: " + loaded.reason);
      log::warning("{}: stored alignment cannot be read: {}", file.string(), loaded.reason);
      break;
  }
}

double Keeper::drive_s(const Memory& memory) {
  double sum = 0.0;
  for (std::size_t i = 0; i < memory.number_of_radars; ++i) sum += memory.radars[i].seconds_of_drive;
  return sum;
}

Memory Keeper::memory_now() const {
  Memory memory = estimator_.memory();
  memory.boot = boot_;
  memory.since_boot_ns = runtime::since_boot_ns();
  return memory;
}

std::span<const std::uint8_t> Keeper::encoded(const Memory& memory) {
  return std::span(bytes_).first(encode_memory(memory, identity_, bytes_));
}

bool Keeper::offer(const Memory& memory) {
  const auto bytes = encoded(memory);
  return !bytes.empty() && writer_->offer(bytes);
}

void Keeper::keep() {
  const std::uint64_t failures = writer_->failed();
  if (failures > reported_failures_) {
    node_.fault(Fault::kLink, "alignment cannot be stored: its file cannot be written", failures - reported_failures_);
    reported_failures_ = failures;
  }
  const Memory memory = memory_now();
  // A stationary vehicle gives no new information, and flash memory wears out.
  if (drive_s(memory) == kept_drive_s_) return;
  if (offer(memory)) kept_drive_s_ = drive_s(memory);
}

void Keeper::remember() {
  if (!writer_) return;
  const Memory memory = memory_now();
  // If the writer is busy, the next turn or the end writes.
  kept_drive_s_ = offer(memory) ? drive_s(memory) : -1.0;
}

void Keeper::finish() {
  if (!writer_) return;
  const Memory memory = memory_now();
  if (memory.number_of_radars == 0) return;
  const auto bytes = encoded(memory);
  const std::string problem = bytes.empty() ? "it is not of this vehicle" : writer_->finish(bytes);
  if (!problem.empty()) log::error("alignment cannot be stored: {}", problem);
}

}  // namespace boresight::alignment
