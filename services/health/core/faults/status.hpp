// The status byte of a trouble code (ISO 14229-1:2020, annex D.2) and the counters beside it.
#pragma once

#include <cstdint>

namespace boresight::health {

namespace dtc_status {
inline constexpr std::uint8_t kTestFailed = 1U << 0U;  ///< the latest result
inline constexpr std::uint8_t kTestFailedThisOperationCycle = 1U << 1U;
inline constexpr std::uint8_t kPending = 1U << 2U;    ///< failed in this or the last completed operation cycle
inline constexpr std::uint8_t kConfirmed = 1U << 3U;  ///< failed in enough operation cycles; until aged or cleared
inline constexpr std::uint8_t kTestNotCompletedSinceLastClear = 1U << 4U;
inline constexpr std::uint8_t kTestFailedSinceLastClear = 1U << 5U;
inline constexpr std::uint8_t kTestNotCompletedThisOperationCycle = 1U << 6U;
inline constexpr std::uint8_t kWarningIndicatorRequested = 1U << 7U;
/// After a clear, and of a new fault memory.
inline constexpr std::uint8_t kCleared = kTestNotCompletedSinceLastClear | kTestNotCompletedThisOperationCycle;
}  // namespace dtc_status

/// Result of a test.
enum class TestResult : std::uint8_t {
  kNone,    ///< no statement
  kPassed,  //
  kFailed,
};

/// Operation cycles that a status takes to change.
struct CycleConfig {
  std::uint8_t confirmation_cycles = 1;  ///< with a failure, one after the other, until it is confirmed (choice)
  std::uint8_t healing_cycles = 3;       ///< passed, until the warning indicator goes off (literature: OBD)
  std::uint8_t ageing_cycles = 40;       ///< passed, until a confirmed code is deleted (literature: OBD warm-up cycles)
};

/// Status of one event over operation cycles. Pure: the caller debounces the results.
struct EventStatus {
  std::uint8_t bits = dtc_status::kCleared;
  std::uint8_t failed_cycles = 0;       ///< one after the other, up to the threshold of confirmation
  std::uint8_t healed_cycles = 0;       ///< passed since the last failure, up to the threshold of healing
  std::uint8_t aged_cycles = 0;         ///< the same, up to the threshold of ageing
  std::uint16_t occurrences = 0;        ///< passed → failed since the last clear; stays at its largest value
  TestResult last = TestResult::kNone;  ///< result that still counts: after a clear or a withdrawal none

  [[nodiscard]] bool has(std::uint8_t status_bits) const { return (bits & status_bits) != 0; }
  /// True if the event is in the fault memory.
  [[nodiscard]] bool is_stored() const { return has(dtc_status::kPending | dtc_status::kConfirmed); }

  /// A debounced result. Returns true if it is a new occurrence: the test was not failed before.
  bool take(TestResult result, const CycleConfig& config);
  /// The latest result does not count any more, as it was made from wrong input. Confirmed and pending stay.
  void withdraw();
  /// A new operation cycle begins. Returns true if the code has aged, and with it what was stored.
  bool begin_cycle(const CycleConfig& config);
};

}  // namespace boresight::health
