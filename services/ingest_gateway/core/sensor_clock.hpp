// The time of measurement of one radar's scans: by the sensor's own stamp if it is plausible.
#pragma once

#include <cstdint>
#include <optional>

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/core/offset_envelope.hpp"

namespace boresight::ingest {

/// Converts stamps to CLOCK_MONOTONIC, in this order of preference:
/// - a synchronised stamp between 1 s before and 5 ms after reception: unchanged;
/// - a stamp that advances with time: by the estimated offset between the clocks, so that jitter of arrival has no
///   effect. The least delay is the usual latency: the latency measured while stamps were synchronised, or else the
///   configured one;
/// - otherwise the time of reception minus the usual latency.
/// Times of one radar never go back, except for a reported jump of over a second. No allocation.
class SensorClock {
 public:
  explicit SensorClock(const RadarConfig& radar) : latency_ns_(static_cast<std::int64_t>(radar.latency_s * 1e9)) {}

  struct Result {
    MeasurementTime time{};
    bool clock_jumped = false;  ///< the sensor's clock, or that of the frames, jumped or stopped; reported once each
    bool sensor_reset = false;  ///< the sensor's clock restarted near zero
    bool sync_lost = false;     ///< stamps lost synchronisation, or claim it but are implausible; reported once each
  };
  [[nodiscard]] Result map(const std::optional<SensorStamp>& sensor, const FrameStamp& reception);

 private:
  void follow(std::int64_t stamp_ns, std::int64_t received_ns, Result& result);
  void begin_anew(std::int64_t stamp_ns, std::int64_t received_ns);
  void keep_order(Result& result);

  std::int64_t latency_ns_;
  bool was_synchronised_ = false;  // the previous scan's stamp was used unchanged
  bool reported_sync_lost_ = false;
  OffsetEnvelope envelope_;
  std::int64_t last_stamp_ns_ = 0, last_received_ns_ = 0;
  unsigned steady_scans_ = 0;        // in a row that advanced with time
  std::int64_t late_since_ns_ = -1;  // stamp since which every frame was late
  bool has_last_time_ = false;
  std::int64_t last_time_ns_ = 0;
};

}  // namespace boresight::ingest
