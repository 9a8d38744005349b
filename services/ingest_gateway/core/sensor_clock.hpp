// The time of measurement of one radar's scans: by the sensor's own stamp wherever that can be believed.
#pragma once

#include <cstdint>
#include <optional>

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/core/offset_envelope.hpp"

namespace boresight::ingest {

/// Maps stamps to CLOCK_MONOTONIC, in this order of preference:
/// - a synchronised stamp that lies 5 ms after … 1 s before reception: as it is;
/// - a stamp that advances as time does: by the estimated offset between the clocks, so that the jitter of arrival does
///   not show in it. The least delay counts as the usual latency: the one that the stamps had while they were
///   synchronised if they ever were, else the configured one;
/// - else the time of reception less the usual latency.
/// Times of one radar never go back, but for a jump of over a second, which is told. No allocation.
class SensorClock {
 public:
  explicit SensorClock(const RadarConfig& radar) : latency_ns_(static_cast<std::int64_t>(radar.latency_s * 1e9)) {}

  struct Result {
    MeasurementTime time{};
    bool clock_jumped = false;  ///< the sensor's clock, or that of the frames, jumped or stopped; told once each
    bool sensor_reset = false;  ///< the sensor's clock began anew near zero
    bool sync_lost = false;     ///< stamps are no longer synchronised, or claim to be but cannot be; told once each
  };
  [[nodiscard]] Result map(const std::optional<SensorStamp>& sensor, const FrameStamp& reception);

 private:
  void follow(std::int64_t stamp_ns, std::int64_t received_ns, Result& result);
  void begin_anew(std::int64_t stamp_ns, std::int64_t received_ns);
  void keep_order(Result& result);

  std::int64_t latency_ns_;
  bool was_synchronised_ = false;  // the previous scan's stamp was taken as it is
  bool told_sync_lost_ = false;
  OffsetEnvelope envelope_;
  std::int64_t last_stamp_ns_ = 0, last_received_ns_ = 0;
  unsigned steady_scans_ = 0;        // in a row that advanced as time does
  std::int64_t late_since_ns_ = -1;  // stamp since which every frame has come late
  bool has_last_time_ = false;
  std::int64_t last_time_ns_ = 0;
};

}  // namespace boresight::ingest
