#include "services/health/level_store.hpp"

#include <algorithm>
#include <optional>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/state_file.hpp"
#include "services/health/fault_store.hpp"

namespace boresight::health {

namespace {

namespace fs = std::filesystem;
namespace log = runtime::log;

constexpr Event kLevelsLost{EventKind::kLevelsLost};

Fault fault_of(StoredLevels verdict) {
  return verdict == StoredLevels::kOtherVersion ? Fault::kVersionMismatch : Fault::kWireValue;
}

}  // namespace

LevelStore::LevelStore(runtime::Node& node, Supervision& supervision, const VehicleConfig& vehicle,
                       const FileConfig& config)
    : node_(node),
      supervision_(supervision),
      identity_(levels_identity_of(vehicle, config.supervision)),
      wait_ns_(static_cast<std::int64_t>(config.level_store.first_write_s * 1e9)),
      period_ns_(static_cast<std::int64_t>(config.level_store.write_period_s * 1e9)) {
  const std::optional<fs::path> file = state_file_of(config.level_store.enabled, config.level_store.path, "levels");
  if (!file) {
    log::info("no learnt levels over restarts: no file is configured");
    return;
  }
  restore(*file);
  set_kept(encoded(supervision_.levels()));
  writer_ = std::make_unique<runtime::StateWriter>(*file, kMaxLevelsBytes);
}

void LevelStore::lose(const fs::path& file, const std::string& reason, Fault fault) {
  node_.fault(fault, "stored levels are " + reason);
  log::warning("{}: stored levels are {}", file.string(), reason);
  supervision_.faults().report_once(kLevelsLost, runtime::monotonic_now_ns(), frame_now(supervision_.faults()));
}

void LevelStore::restore(const fs::path& file) {
  using Kind = runtime::StateBytes::Kind;
  const runtime::StateBytes read = runtime::read_state_file(file, bytes_);
  if (read.kind == Kind::kMissing) {
    log::info("no stored levels in {}: a first start", file.string());
    return;
  }
  if (read.kind == Kind::kUnreadable) {
    lose(file, "unreadable: " + read.reason, Fault::kLink);
    return;
  }
  VehicleLevels levels;
  std::size_t rejected = 0;
  const StoredLevels verdict = decode_levels(std::span(bytes_).first(read.size), identity_, levels, rejected);
  if (verdict != StoredLevels::kTaken) {
    const std::string aside = runtime::set_state_file_aside(file);
    lose(file,
         std::string(describe(verdict)) +
             (aside.empty() ? "; kept with the suffix .rejected and not used" : "; " + aside),
         fault_of(verdict));
    return;
  }
  supervision_.restore(levels);
  log::info("learnt levels of {} radars restored from {}", levels.number_of_radars, file.string());
  if (rejected > 0) log::warning("{} radars have another mounting or profile than the stored ones", rejected);
}

std::span<const std::uint8_t> LevelStore::encoded(const VehicleLevels& levels) {
  return std::span(bytes_).first(encode_levels(levels, identity_, std::span(bytes_).first(kMaxLevelsBytes)));
}

void LevelStore::keep(std::int64_t now_ns) {
  if (!writer_ || now_ns < next_ns_) return;
  // Sooner at first, so that a service that is often restarted keeps what it has learnt.
  next_ns_ = now_ns + std::min(wait_ns_, period_ns_);
  wait_ns_ = std::min(2 * wait_ns_, period_ns_);
  const std::uint64_t failures = writer_->failed();
  if (failures > reported_failures_) {
    node_.fault(Fault::kLink, "learnt levels cannot be stored: their file cannot be written",
                failures - reported_failures_);
    reported_failures_ = failures;
    kept_size_ = 0;  // what was offered is not on the medium
  }
  // A stationary vehicle learns nothing, and flash memory wears out.
  const std::span<const std::uint8_t> bytes = encoded(supervision_.levels());
  const bool is_kept = std::ranges::equal(bytes, std::span(kept_).first(kept_size_));
  if (bytes.empty() || is_kept || !writer_->offer(bytes)) return;
  set_kept(bytes);
}

void LevelStore::set_kept(std::span<const std::uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), kept_.begin());
  kept_size_ = bytes.size();
}

void LevelStore::finish() {
  if (!writer_) return;
  const std::span<const std::uint8_t> bytes = encoded(supervision_.levels());
  if (bytes.empty()) return;
  if (const std::string problem = writer_->finish(bytes); !problem.empty()) {
    log::error("learnt levels cannot be stored: {}", problem);
  }
}

}  // namespace boresight::health
