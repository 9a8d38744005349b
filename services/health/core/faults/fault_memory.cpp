#include "services/health/core/faults/fault_memory.hpp"

#include <algorithm>

namespace boresight::health {

namespace {

/// Subjects of all kinds are below this number: radar ids from 1, service indices from 0.
constexpr std::size_t kSubjects = kMaxRadars;

std::size_t slot_of(Event event) {
  const std::size_t first = type_of(event.kind).subject == Subject::kRadar ? 1 : 0;
  return static_cast<std::size_t>(event.kind) * kSubjects + (event.subject - first) % kSubjects;
}

}  // namespace

std::array<DebounceTimes, kNumberOfEventKinds> FaultMemoryConfig::default_debounce() {
  std::array<DebounceTimes, kNumberOfEventKinds> times{};
  const auto set = [&times](EventKind kind, DebounceTimes value) { times[static_cast<std::size_t>(kind)] = value; };
  set(kind_of(RadarEvent::kNoData), {.set_s = 0.0, .clear_s = 0.5});
  for (const RadarEvent event : {RadarEvent::kFrozen, RadarEvent::kEgoContradiction}) {
    set(kind_of(event), {.set_s = 0.2, .clear_s = 2.0});
  }
  for (const RadarEvent event :
       {RadarEvent::kBlind, RadarEvent::kReducedSight, RadarEvent::kDisturbed, RadarEvent::kRejectedData,
        RadarEvent::kSuspectData, RadarEvent::kRateReduced, RadarEvent::kRateTooHigh, RadarEvent::kDelayed}) {
    set(kind_of(event), {.set_s = 0.5, .clear_s = 2.0});
  }
  set(EventKind::kPipelineLosing, {.set_s = 0.0, .clear_s = 1.0});
  set(EventKind::kPipelineQueueing, {.set_s = 0.15, .clear_s = 1.0});
  set(EventKind::kPipelineWorkBudget, {.set_s = 0.0, .clear_s = 1.0});
  set(EventKind::kPipelineLate, {.set_s = 0.0, .clear_s = 1.0});
  set(EventKind::kPipelineSilent, {.set_s = 0.04, .clear_s = 0.2});
  return times;
}

FaultMemory::FaultMemory(const VehicleConfig& vehicle, const FaultMemoryConfig& config) : config_(config) {
  const auto add = [this](EventKind kind, std::size_t subject) {
    const Event event{kind, static_cast<std::uint8_t>(subject)};
    if (index_[slot_of(event)] != 0) return;
    records_.push_back({.event = event, .status = {}, .debounce = {}, .first = {}, .latest = {}});
    index_[slot_of(event)] = static_cast<std::uint16_t>(records_.size());
  };
  for (const EventType& type : event_types()) {
    if (type.subject == Subject::kRadar) {
      for (const RadarConfig& radar : vehicle.radars) add(type.kind, radar.id);
    } else {
      for (std::size_t subject = 0; subject < subjects_of(type.subject); ++subject) add(type.kind, subject);
    }
  }
}

FaultRecord* FaultMemory::record_of(Event event) {
  const std::uint16_t index = index_[slot_of(event)];
  if (index == 0 || !(records_[index - 1U].event == event)) return nullptr;
  return &records_[index - 1U];
}

const FaultRecord* FaultMemory::find(Event event) const {
  return const_cast<FaultMemory*>(this)->record_of(event);
}

bool FaultMemory::is_failed(Event event) const {
  const FaultRecord* const record = find(event);
  return record != nullptr && record->status.last == TestResult::kFailed;
}

void FaultMemory::take(FaultRecord& record, TestResult result, const FreezeFrame& frame) {
  if (result == TestResult::kNone) return;
  record.tested_since_start = true;
  const EventStatus before = record.status;
  if (record.status.take(result, config_.cycles)) {
    if (record.first.time_ns == 0) record.first = frame;
    record.latest = frame;
  }
  if (record.status.bits != before.bits || record.status.last != before.last ||
      record.status.occurrences != before.occurrences) {
    ++revision_;
  }
}

void FaultMemory::report(Event event, TestResult raw, std::int64_t time_ns, const FreezeFrame& frame) {
  FaultRecord* const record = record_of(event);
  if (record == nullptr) return;
  const DebounceTimes& times = config_.debounce[static_cast<std::size_t>(event.kind)];
  const TestResult result = record->debounce.update(raw, times, time_ns);
  // A result of an earlier process stands, but only a result of this process is a test.
  if (raw != TestResult::kNone && result == raw) take(*record, result, frame);
}

void FaultMemory::report_once(Event event, std::int64_t time_ns, const FreezeFrame& frame) {
  report(event, TestResult::kFailed, time_ns, frame);
  report(event, TestResult::kPassed, time_ns, frame);
}

void FaultMemory::withdraw(Event event) {
  FaultRecord* const record = record_of(event);
  if (record == nullptr || record->status.last == TestResult::kNone) return;
  record->status.withdraw();
  record->debounce.clear();
  ++revision_;
}

void FaultMemory::begin_cycle(std::uint64_t id) {
  if (cycle_ != 0 && id == cycle_id_) return;
  if (cycle_ != 0) {
    for (FaultRecord& record : records_) {
      if (record.status.begin_cycle(config_.cycles)) record.first = record.latest = {};
    }
  }
  ++cycle_;
  cycle_id_ = id;
  ++revision_;
}

bool FaultMemory::clear(std::uint32_t dtc) {
  const std::optional<Event> event = event_of(dtc);
  FaultRecord* const record = event ? record_of(*event) : nullptr;
  if (record == nullptr) return false;
  *record = {.event = record->event, .status = {}, .debounce = {}, .first = {}, .latest = {}};
  ++revision_;
  return true;
}

void FaultMemory::clear_all() {
  for (FaultRecord& record : records_) {
    record = {.event = record.event, .status = {}, .debounce = {}, .first = {}, .latest = {}};
  }
  ++revision_;
}

std::uint32_t FaultMemory::stored() const {
  return static_cast<std::uint32_t>(
      std::count_if(records_.begin(), records_.end(), [](const FaultRecord& r) { return r.status.is_stored(); }));
}

void FaultMemory::restore(const FaultRecord& record) {
  FaultRecord* const own = record_of(record.event);
  if (own == nullptr) return;
  *own = record;
  own->tested_since_start = false;
  own->debounce.restore(record.status.last);
}

void FaultMemory::restore_cycle(std::uint32_t cycle, std::uint64_t id) {
  cycle_ = cycle;
  cycle_id_ = id;
}

}  // namespace boresight::health
