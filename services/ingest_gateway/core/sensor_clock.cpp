#include "services/ingest_gateway/core/sensor_clock.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

/// Largest valid stamp (146 years); differences of valid stamps do not overflow.
constexpr std::int64_t kMaxStamp_ns = std::int64_t{1} << 62;

/// Free-running stamps are used after this number of scans that advanced with time …
constexpr unsigned kScansToBelieve = 8;
/// … with this tolerance for delays in queues between two frames.
constexpr double kSpacingShare = 0.25;
constexpr std::int64_t kSpacing_ns = 20'000'000;
/// A frame can be late but never early. If it seems earlier than drift explains, the stamps have jumped.
constexpr std::int64_t kMaxEarly_ns = 20'000'000;
constexpr double kDriftInSilence = 200e-6;
/// If all frames are late by this amount for this time, they are not delayed: the sensor's clock was set back.
constexpr std::int64_t kLate_ns = 20'000'000;
constexpr std::int64_t kLateFor_ns = 2'000'000'000;
/// After a longer silence the known drift is not valid any more.
constexpr std::int64_t kMaxSilence_ns = 30'000'000'000;
/// A clock that goes back below this value counts from the start of the sensor.
constexpr std::int64_t kStartOfSensor_ns = 60'000'000'000;

}  // namespace

SensorClock::Result SensorClock::map(const std::optional<SensorStamp>& sensor, const FrameStamp& reception) {
  Result result;
  result.time = {reception.received_ns - latency_ns_, reception.source};
  const bool usable = sensor && sensor->time_ns >= 0 && sensor->time_ns < kMaxStamp_ns;
  const bool synchronised = usable && sensor->synchronised && is_plausible(sensor->time_ns, reception);
  if (usable) {
    follow(sensor->time_ns, reception.received_ns, result);
  } else {
    steady_scans_ = 0;
    envelope_.reset();
  }
  const bool believed = usable && steady_scans_ >= kScansToBelieve;
  if (synchronised) {
    const std::int64_t time_ns = sensor->time_ns - reception.epoch_offset_ns;
    // A synchronised clock may be corrected by any amount; only a step back is a fault.
    result.clock_jumped = was_synchronised_ && has_last_time_ && time_ns < last_time_ns_;
    if (believed) latency_ns_ = std::max<std::int64_t>(0, envelope_.offset_ns() + reception.epoch_offset_ns);
    result.time = {time_ns, TimeSource::kSensorSynchronised};
    reported_sync_lost_ = false;
  } else if (believed) {
    result.time = {sensor->time_ns + envelope_.offset_ns() - latency_ns_, TimeSource::kSensorFreeRunning};
  }
  const bool claims_only = sensor && sensor->synchronised && !synchronised;
  if (!synchronised && (was_synchronised_ || (claims_only && !reported_sync_lost_))) {
    result.sync_lost = reported_sync_lost_ = true;
  }
  was_synchronised_ = synchronised;
  keep_order(result);
  return result;
}

/// Updates the estimate of the clocks' offset; starts again after a jump.
void SensorClock::follow(std::int64_t stamp_ns, std::int64_t received_ns, Result& result) {
  if (envelope_.empty()) {
    begin_anew(stamp_ns, received_ns);
    return;
  }
  const std::int64_t stamps_ns = stamp_ns - last_stamp_ns_;
  const std::int64_t receptions_ns = received_ns - last_received_ns_;
  const bool believed = steady_scans_ >= kScansToBelieve;
  if (stamps_ns < 0) {
    result.sensor_reset = stamp_ns < kStartOfSensor_ns && stamps_ns < -kMaxDelay_ns;
    result.clock_jumped = !result.sensor_reset;
    begin_anew(stamp_ns, received_ns);
    return;
  }
  if (receptions_ns > kMaxSilence_ns) {
    begin_anew(stamp_ns, received_ns);
    return;
  }
  const std::int64_t offset_ns = received_ns - stamp_ns;
  const std::int64_t late_ns = envelope_.lateness_ns(stamp_ns, offset_ns);
  if (believed) {
    // Before the estimate has settled, a frame may have a smaller delay than all previous ones.
    const std::int64_t early_ns = envelope_.settled()
                                      ? kMaxEarly_ns + std::llround(kDriftInSilence * static_cast<double>(stamps_ns))
                                      : kMaxDelay_ns;
    if (late_ns <= kLate_ns) {
      late_since_ns_ = -1;
    } else if (late_since_ns_ < 0) {
      late_since_ns_ = stamp_ns;
    }
    const bool set_back = late_since_ns_ >= 0 && stamp_ns - late_since_ns_ > kLateFor_ns;
    if (late_ns < -early_ns || set_back || late_ns > kMaxDelay_ns) {
      result.clock_jumped = true;
      begin_anew(stamp_ns, received_ns);
      return;
    }
  } else {
    const double difference_ns = std::abs(static_cast<double>(stamps_ns - receptions_ns));
    const double allowed_ns = kSpacingShare * static_cast<double>(receptions_ns) + static_cast<double>(kSpacing_ns);
    if (stamps_ns == 0 || difference_ns > allowed_ns) {
      begin_anew(stamp_ns, received_ns);
      return;
    }
    ++steady_scans_;
  }
  envelope_.add(stamp_ns, offset_ns);
  last_stamp_ns_ = stamp_ns;
  last_received_ns_ = received_ns;
}

void SensorClock::begin_anew(std::int64_t stamp_ns, std::int64_t received_ns) {
  envelope_.reset();
  envelope_.add(stamp_ns, received_ns - stamp_ns);
  steady_scans_ = 0;
  late_since_ns_ = -1;
  last_stamp_ns_ = stamp_ns;
  last_received_ns_ = received_ns;
}

void SensorClock::keep_order(Result& result) {
  if (has_last_time_ && result.time.time_ns < last_time_ns_) {
    if (last_time_ns_ - result.time.time_ns > kMaxDelay_ns) {
      result.clock_jumped = true;
    } else {
      // The source of time changed, or a frame overtook another one: keeps the previous time instead of going back.
      result.time.time_ns = last_time_ns_;
    }
  }
  has_last_time_ = true;
  last_time_ns_ = result.time.time_ns;
}

}  // namespace boresight::ingest
