// The fault memory: a status, counters and freeze frames for each event of the vehicle (ISO 14229-1, AUTOSAR Dem).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/health/core/faults/debounce.hpp"
#include "services/health/core/faults/event.hpp"
#include "services/health/core/faults/freeze_frame.hpp"
#include "services/health/core/faults/status.hpp"

namespace boresight::health {

struct FaultMemoryConfig {
  CycleConfig cycles;
  std::array<DebounceTimes, kNumberOfEventKinds> debounce = default_debounce();

  [[nodiscard]] static std::array<DebounceTimes, kNumberOfEventKinds> default_debounce();
};

/// One event with its history.
struct FaultRecord {
  Event event{};
  EventStatus status;
  Debounce debounce;
  FreezeFrame first;                ///< at the first occurrence since the last clear
  FreezeFrame latest;               ///< at the latest one
  bool tested_since_start = false;  ///< this process has a result
};

/// All memory is taken by the constructor. Times are CLOCK_MONOTONIC, ns.
class FaultMemory {
 public:
  /// The events of this vehicle: of each of its radars, of each supervised service, and of the vehicle.
  FaultMemory(const VehicleConfig& vehicle, const FaultMemoryConfig& config);

  /// A raw result. `frame` is stored if it makes a new occurrence. Events that this vehicle does not have are ignored.
  void report(Event event, TestResult raw, std::int64_t time_ns, const FreezeFrame& frame);
  /// An event that lasts no time, such as a change of the load: it fails and passes at once.
  void report_once(Event event, std::int64_t time_ns, const FreezeFrame& frame);
  /// The latest result of the event does not count any more.
  void withdraw(Event event);

  /// Continues the operation cycle `id` (any number that identifies the cycle, such as of the boot), or begins it.
  void begin_cycle(std::uint64_t id);
  /// Number of operation cycles so far, beginning with 1; 0 before the first.
  [[nodiscard]] std::uint32_t cycle() const { return cycle_; }

  /// Deletes one event, or all. Returns false if this vehicle does not have the event.
  bool clear(std::uint32_t dtc);
  void clear_all();

  /// nullptr if this vehicle does not have the event.
  [[nodiscard]] const FaultRecord* find(Event event) const;
  [[nodiscard]] std::span<const FaultRecord> records() const { return records_; }
  [[nodiscard]] bool is_failed(Event event) const;
  /// Number of confirmed or pending events.
  [[nodiscard]] std::uint32_t stored() const;
  /// Grows whenever something changed that must be kept: statuses, counters, cycles.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

  /// Restores a record and the cycle as they were stored. Events that this vehicle does not have are ignored.
  void restore(const FaultRecord& record);
  void restore_cycle(std::uint32_t cycle, std::uint64_t id);
  [[nodiscard]] std::uint64_t cycle_id() const { return cycle_id_; }

 private:
  [[nodiscard]] FaultRecord* record_of(Event event);
  void take(FaultRecord& record, TestResult result, const FreezeFrame& frame);

  FaultMemoryConfig config_;
  std::vector<FaultRecord> records_;
  std::array<std::uint16_t, kNumberOfEventKinds * kMaxRadars> index_{};  ///< of a record + 1; 0: none
  std::uint32_t cycle_ = 0;
  std::uint64_t cycle_id_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace boresight::health
