// Whether the data flow of a service makes progress. The watchdog of the service is stroked only while it does. Pure.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace boresight::runtime {

/// What the watch knows about an input: a queue of the bus, or a descriptor.
struct WatchedInput {
  bool waits = false;          ///< a message waited at the last look
  std::uint64_t handled = 0;   ///< messages handled until the last look
  std::int64_t waited_ns = 0;  ///< how long messages have been seen to wait while none was handled
};

/// What the watch knows about outputs.
class WatchedOutput {
 public:
  void published() {
    is_missing_ = false;
    silent_ns_ = 0;
  }
  /// An output was due at `now_ns` and was not published. After a pause of `limit_ns` a new series begins.
  void missed(std::int64_t now_ns, std::int64_t limit_ns) {
    if (!is_missing_ || now_ns - last_missed_ns_ >= limit_ns) first_missed_ns_ = now_ns;
    last_missed_ns_ = now_ns;
    is_missing_ = true;
  }

 private:
  friend class ProgressWatch;
  bool is_missing_ = false;  // since the last output
  std::int64_t first_missed_ns_ = 0;
  std::int64_t last_missed_ns_ = 0;
  std::int64_t silent_ns_ = 0;  // for periodic outputs: observed time since the last one
};

/// Looks at all inputs and outputs of a service, about ten times a second.
///
/// A stroke is due unless one of these holds for longer than its limit:
/// - messages wait in an input, and none of them is handled;
/// - outputs are due time and again, and none is published;
/// - a periodic output is not published.
/// No input, rejected inputs and rare outputs are no reason. One handled message or one output ends the stall.
class ProgressWatch {
 public:
  void begin_look(std::int64_t now_ns) {
    step_ns_ = looked_ns_ == kNever_ns ? 0 : std::clamp<std::int64_t>(now_ns - looked_ns_, 0, kLongestStep_ns);
    looked_ns_ = now_ns;
    stalled_ = {};
  }

  /// `waits`: at least one message is not handled. `handled`: all messages handled so far. `name` must outlive the
  /// look.
  void look_at(WatchedInput& input, bool waits, std::uint64_t handled, std::int64_t limit_ns, std::string_view name) {
    const bool stands_still = std::exchange(input.waits, waits) && waits && input.handled == handled;
    input.waited_ns = stands_still ? input.waited_ns + step_ns_ : 0;
    input.handled = handled;
    if (input.waited_ns > limit_ns) note(name, "messages wait and none is handled");
  }

  /// The stall lasts only while outputs become due: without inputs nothing is missing.
  void look_at(const WatchedOutput& output, std::int64_t limit_ns, std::string_view name) {
    const bool is_still_due = output.is_missing_ && looked_ns_ - output.last_missed_ns_ < limit_ns;
    if (is_still_due && output.last_missed_ns_ - output.first_missed_ns_ > limit_ns)
      note(name, "outputs are due and none is published");
  }

  void look_at_periodic(WatchedOutput& output, std::int64_t limit_ns, std::string_view name) {
    output.silent_ns_ += step_ns_;
    if (output.silent_ns_ > limit_ns) note(name, "is due periodically and is not published");
  }

  /// The results of the look: a stroke is due if nothing stalls.
  [[nodiscard]] bool stroke_is_due() const { return stalled_.name.empty(); }
  /// The first stall that was found, as "radar_scan: messages wait and none is handled"; empty if a stroke is due.
  [[nodiscard]] std::string reason() const {
    return stroke_is_due() ? std::string() : std::string(stalled_.name) + ": " + std::string(stalled_.why);
  }

 private:
  // A process that is stopped, or gets no processor time, cannot handle its inputs. A longer time between two looks
  // counts as this one, which is twice the period of the heartbeat.
  static constexpr std::int64_t kLongestStep_ns = 200'000'000;
  static constexpr std::int64_t kNever_ns = -1;

  struct Stalled {
    std::string_view name;
    std::string_view why;
  };

  void note(std::string_view name, std::string_view why) {
    if (stroke_is_due()) stalled_ = {name, why};
  }

  std::int64_t looked_ns_ = kNever_ns;
  std::int64_t step_ns_ = 0;
  Stalled stalled_;
};

}  // namespace boresight::runtime
