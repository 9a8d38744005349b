#include "services/health/fault_store.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "services/common/runtime/boot_time.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/state_file.hpp"
#include "services/common/state/fingerprint.hpp"
#include "services/health/core/faults/codec.hpp"

namespace boresight::health {

namespace {

namespace fs = std::filesystem;
namespace log = runtime::log;

constexpr Event kLost{EventKind::kFaultMemoryLost};
constexpr Event kUnwritable{EventKind::kFaultMemoryUnwritable};
// A full medium is tried again at this period, not at each judgement.
constexpr std::int64_t kWriteRetryPeriod_ns = 1'000'000'000;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

std::optional<fs::path> state_file_of(bool enabled, const std::string& path, const char* name) {
  if (!enabled) return std::nullopt;
  if (!path.empty()) return path;
  const char* const folder = std::getenv("STATE_DIRECTORY");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return fs::path(folder) / name;
}

FreezeFrame frame_now(const FaultMemory& memory) {
  FreezeFrame frame;
  frame.time_ns = runtime::realtime_now_ns();
  frame.uptime_ns = static_cast<std::uint64_t>(runtime::monotonic_now_ns());
  frame.cycle = memory.cycle();
  return frame;
}

FaultStore::FaultStore(runtime::Node& node, FaultMemory& memory, const FaultStoreConfig& config)
    : node_(node), memory_(memory), bytes_(kMaxFaultMemoryBytes + 1) {
  const std::optional<fs::path> file = state_file_of(config.enabled, config.path, "fault_memory");
  if (file) {
    restore(*file);
    writer_ = std::make_unique<runtime::StateWriter>(*file, bytes_.size());
  } else {
    log::info("no fault memory over restarts: no file is configured");
  }
  memory_.begin_cycle(operation_cycle_id(config.operation_cycle));
}

void FaultStore::lose(const fs::path& file, const std::string& reason, Fault fault) {
  node_.fault(fault, "stored fault memory is " + reason);
  log::warning("{}: stored fault memory is {}", file.string(), reason);
  memory_.report_once(kLost, runtime::monotonic_now_ns(), frame_now(memory_));
}

void FaultStore::restore(const fs::path& file) {
  const runtime::StateBytes read = runtime::read_state_file(file, bytes_);
  using Kind = runtime::StateBytes::Kind;
  if (read.kind == Kind::kMissing) {
    log::info("no stored fault memory in {}: a first start", file.string());
    return;
  }
  if (read.kind == Kind::kUnreadable) {
    lose(file, "unreadable: " + read.reason, Fault::kLink);
    return;
  }
  const StoredFaults verdict = decode_fault_memory(std::span(bytes_).first(read.size), memory_);
  if (verdict == StoredFaults::kTaken) {
    log::info("{} stored events restored from {}", memory_.stored(), file.string());
    return;
  }
  const std::string aside = runtime::set_state_file_aside(file);
  lose(
      file,
      std::string(describe(verdict)) + (aside.empty() ? "; kept with the suffix .rejected and not used" : "; " + aside),
      verdict == StoredFaults::kOtherVersion ? Fault::kVersionMismatch : Fault::kWireValue);
}

void FaultStore::keep(std::int64_t now_ns) {
  if (!writer_) return;
  const std::uint64_t failures = writer_->failed();
  if (failures > reported_failures_) {
    node_.fault(Fault::kLink, "fault memory cannot be stored: its file cannot be written",
                failures - reported_failures_);
    reported_failures_ = failures;
    offered_revision_ = 0;  // what was offered is not on the medium
    retry_ns_ = now_ns + kWriteRetryPeriod_ns;
    memory_.report(kUnwritable, TestResult::kFailed, now_ns, frame_now(memory_));
  } else if (writer_->written() > 0 && now_ns >= retry_ns_) {
    memory_.report(kUnwritable, TestResult::kPassed, now_ns, frame_now(memory_));
  }
  if (memory_.revision() == offered_revision_ || now_ns < retry_ns_) return;
  const std::uint64_t revision = memory_.revision();
  const std::size_t size = encode_fault_memory(memory_, bytes_);
  if (size > 0 && writer_->offer(std::span(bytes_).first(size))) offered_revision_ = revision;
}

void FaultStore::finish() {
  if (!writer_) return;
  const std::size_t size = encode_fault_memory(memory_, bytes_);
  if (const std::string problem = writer_->finish(std::span(bytes_).first(size)); !problem.empty()) {
    log::error("fault memory cannot be stored: {}", problem);
  }
}

std::uint64_t operation_cycle_id(OperationCycle kind) {
  if (kind == OperationCycle::kBoot) return runtime::boot_fingerprint();
  state::Fingerprint print;
  print.add(static_cast<std::uint64_t>(runtime::realtime_now_ns()));
  print.add(static_cast<std::uint64_t>(runtime::monotonic_now_ns()));
  return print.value();
}

std::uint64_t configuration_fingerprint(const runtime::Configuration& files) {
  state::Fingerprint print;
  print.add(std::string_view(content_of(files.vehicle_file())));
  std::vector<fs::path> services;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(files.directory / "services", ignored)) {
    if (entry.is_regular_file(ignored)) services.push_back(entry.path());
  }
  std::sort(services.begin(), services.end());
  for (const fs::path& file : services) print.add(std::string_view(content_of(file)));
  return print.value();
}

}  // namespace boresight::health
