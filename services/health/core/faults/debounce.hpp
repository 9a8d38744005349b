// Debounces the results of a test in time, with a fault detection counter as in ISO 14229-1 and AUTOSAR's Dem.
#pragma once

#include <cstdint>
#include <limits>

#include "services/health/core/faults/status.hpp"

namespace boresight::health {

/// Times for which a test must fail, or pass, without interruption until the result counts.
struct DebounceTimes {
  double set_s = 0.0;
  double clear_s = 0.0;
};

class Debounce {
 public:
  /// A raw result at `time_ns`; kNone leaves the debounced result and begins both times anew. Returns the debounced
  /// result: kNone until a first one counts. A time that goes back begins the times anew.
  TestResult update(TestResult raw, const DebounceTimes& times, std::int64_t time_ns) {
    if (raw != raw_ || raw == TestResult::kNone || time_ns < since_ns_) {
      raw_ = raw;
      since_ns_ = time_ns;
    }
    needed_s_ = raw_ == TestResult::kFailed ? times.set_s : times.clear_s;
    elapsed_s_ = static_cast<double>(time_ns - since_ns_) * 1e-9;
    if (raw_ != TestResult::kNone && elapsed_s_ >= needed_s_) result_ = raw_;
    return result_;
  }

  [[nodiscard]] TestResult result() const { return result_; }
  /// Fault detection counter: 127 failed, −128 passed, between them on the way.
  [[nodiscard]] std::int8_t counter() const {
    constexpr double kFailed = 127.0, kPassed = -128.0;
    if (raw_ == TestResult::kNone) {
      return static_cast<std::int8_t>(result_ == TestResult::kFailed   ? kFailed
                                      : result_ == TestResult::kPassed ? kPassed
                                                                       : 0.0);
    }
    const double end = raw_ == TestResult::kFailed ? kFailed : kPassed;
    if (raw_ == result_) return static_cast<std::int8_t>(end);
    return static_cast<std::int8_t>(needed_s_ > 0.0 ? end * elapsed_s_ / needed_s_ : 0.0);
  }
  /// Forgets the result, as after a clear of the fault memory.
  void clear() { *this = Debounce(); }
  /// Continues with the result of an earlier process.
  void restore(TestResult result) {
    clear();
    result_ = result;
  }

 private:
  TestResult raw_ = TestResult::kNone;
  TestResult result_ = TestResult::kNone;
  std::int64_t since_ns_ = std::numeric_limits<std::int64_t>::min();
  double elapsed_s_ = 0.0;
  double needed_s_ = 0.0;
};

}  // namespace boresight::health
