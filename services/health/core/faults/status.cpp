#include "services/health/core/faults/status.hpp"

#include <algorithm>
#include <limits>

namespace boresight::health {

using namespace dtc_status;

namespace {
void set(std::uint8_t& bits, std::uint8_t which, bool value) {
  bits = static_cast<std::uint8_t>(value ? bits | which : bits & ~which);
}
void count_up_to(std::uint8_t& counter, std::uint8_t limit) {
  if (counter < limit) ++counter;
}
}  // namespace

bool EventStatus::take(TestResult result, const CycleConfig& config) {
  if (result == TestResult::kNone) return false;
  set(bits, kCleared, false);
  last = result;
  if (result == TestResult::kPassed) {
    set(bits, kTestFailed, false);
    return false;
  }
  const bool is_new = !has(kTestFailed);
  if (is_new && occurrences < std::numeric_limits<std::uint16_t>::max()) ++occurrences;
  if (!has(kTestFailedThisOperationCycle)) count_up_to(failed_cycles, config.confirmation_cycles);
  set(bits, kTestFailed | kTestFailedThisOperationCycle | kPending | kTestFailedSinceLastClear, true);
  if (failed_cycles >= config.confirmation_cycles) set(bits, kConfirmed | kWarningIndicatorRequested, true);
  healed_cycles = aged_cycles = 0;
  return is_new;
}

void EventStatus::withdraw() {
  set(bits, kTestFailed, false);
  set(bits, kTestNotCompletedThisOperationCycle, true);
  last = TestResult::kNone;
}

bool EventStatus::begin_cycle(const CycleConfig& config) {
  const bool was_tested = !has(kTestNotCompletedThisOperationCycle);
  const bool had_failed = has(kTestFailedThisOperationCycle);
  set(bits, kTestFailedThisOperationCycle, false);
  set(bits, kTestNotCompletedThisOperationCycle, true);
  // A cycle counts as passed if the test was made in it and never failed; a test that still fails has not passed.
  if (!was_tested || had_failed || has(kTestFailed)) return false;
  set(bits, kPending, false);
  failed_cycles = 0;
  if (!has(kConfirmed)) return false;
  count_up_to(healed_cycles, config.healing_cycles);
  if (healed_cycles >= config.healing_cycles) set(bits, kWarningIndicatorRequested, false);
  count_up_to(aged_cycles, config.ageing_cycles);
  if (aged_cycles < config.ageing_cycles) return false;
  set(bits, kConfirmed | kWarningIndicatorRequested, false);
  occurrences = 0;
  healed_cycles = aged_cycles = 0;
  return true;
}

}  // namespace boresight::health
