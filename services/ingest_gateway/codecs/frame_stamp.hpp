// Frames with their time on this ECU's clock, and the mapping of recorded or sensor clocks to it.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "interfaces/messages/header.hpp"

namespace boresight::ingest {

/// When a frame was received, in CLOCK_MONOTONIC, and by how much the epoch clock that sensors are synchronised to is
/// ahead of it (epoch = monotonic + offset).
struct FrameStamp {
  std::int64_t received_ns = 0;
  std::int64_t epoch_offset_ns = 0;
  TimeSource source = TimeSource::kUserArrival;
};

/// Maps the stamps of a recording to the monotonic clock so that their spacing stays as recorded, whatever the speed of
/// the replay. A recording that starts anew (a jump back by over a second or forward by over an hour) is anchored anew.
class RecordingClock {
 public:
  /// `now_ns` is the monotonic time at which the frame arrived. `jumped` tells that the anchor was set anew.
  [[nodiscard]] FrameStamp map(std::int64_t recorded_ns, std::int64_t now_ns, bool& jumped) {
    constexpr std::int64_t kBack_ns = 1'000'000'000;
    constexpr std::int64_t kForward_ns = 3'600'000'000'000;
    jumped = anchored_ && (recorded_ns < last_recorded_ns_ - kBack_ns || recorded_ns > last_recorded_ns_ + kForward_ns);
    if (!anchored_ || jumped) {
      offset_ns_ = recorded_ns - now_ns;
      anchored_ = true;
    }
    last_recorded_ns_ = recorded_ns;
    return {recorded_ns - offset_ns_, offset_ns_, TimeSource::kLinkArrival};
  }
  /// Forgets the anchor: the next frame begins a new recording.
  void reset() { anchored_ = false; }

 private:
  bool anchored_ = false;
  std::int64_t last_recorded_ns_ = 0;
  std::int64_t offset_ns_ = 0;
};

/// Nothing sound takes longer from measurement to reception; a real ARS548 stamps 247 ms before its list arrives.
inline constexpr std::int64_t kMaxDelay_ns = 1'000'000'000;

/// Whether a stamp on the epoch's clock lies 5 ms after … kMaxDelay_ns before reception. gPTP keeps clocks within
/// microseconds; 5 ms is what a clock may be ahead that has just been locked.
[[nodiscard]] inline bool is_plausible(std::int64_t sensor_epoch_ns, const FrameStamp& stamp) {
  const std::int64_t delay_ns = stamp.received_ns - (sensor_epoch_ns - stamp.epoch_offset_ns);
  return delay_ns >= -5'000'000 && delay_ns <= kMaxDelay_ns;
}

/// Time of measurement by a sensor's own stamp, if its clock is synchronised and the stamp plausible; else the time of
/// reception less the usual latency, marked as such.
struct MeasurementTime {
  std::int64_t time_ns;
  TimeSource source;
};
[[nodiscard]] inline MeasurementTime measurement_time(std::int64_t sensor_epoch_ns, bool synchronised,
                                                      const FrameStamp& stamp, std::int64_t latency_ns) {
  if (synchronised && is_plausible(sensor_epoch_ns, stamp)) {
    return {sensor_epoch_ns - stamp.epoch_offset_ns, TimeSource::kSensorSynchronised};
  }
  return {stamp.received_ns - latency_ns, stamp.source};
}

}  // namespace boresight::ingest
