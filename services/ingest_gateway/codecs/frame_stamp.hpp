// Reception times on this ECU's clock, and conversion of recorded or sensor clocks to it.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "interfaces/messages/header.hpp"

namespace boresight::ingest {

/// Reception time of a frame in CLOCK_MONOTONIC, and the offset to the epoch clock of synchronised sensors (epoch =
/// monotonic + offset).
struct FrameStamp {
  std::int64_t received_ns = 0;
  std::int64_t epoch_offset_ns = 0;
  TimeSource source = TimeSource::kUserArrival;
};

/// Converts the stamps of a recording to the monotonic clock with their recorded spacing, at any speed of the replay.
/// The offset is set again if a recording restarts: a jump back by over a second, or forward by over an hour.
class RecordingClock {
 public:
  /// `now_ns` is the monotonic time of the frame's arrival. `jumped` is true if the offset was set again.
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
  /// Deletes the offset: the next frame begins a new recording.
  void reset() { anchored_ = false; }

 private:
  bool anchored_ = false;
  std::int64_t last_recorded_ns_ = 0;
  std::int64_t offset_ns_ = 0;
};

/// Largest plausible time from measurement to reception; a recorded ARS548 stamps 247 ms before its list arrives.
inline constexpr std::int64_t kMaxDelay_ns = 1'000'000'000;

/// True if a stamp on the epoch's clock lies between kMaxDelay_ns before and 5 ms after reception. gPTP keeps clocks
/// within microseconds; directly after synchronisation a clock may be 5 ms ahead.
[[nodiscard]] inline bool is_plausible(std::int64_t sensor_epoch_ns, const FrameStamp& stamp) {
  const std::int64_t delay_ns = stamp.received_ns - (sensor_epoch_ns - stamp.epoch_offset_ns);
  return delay_ns >= -5'000'000 && delay_ns <= kMaxDelay_ns;
}

/// Time of measurement by a sensor's own stamp, if its clock is synchronised and the stamp plausible; otherwise the
/// time of reception minus the usual latency, marked as such.
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
