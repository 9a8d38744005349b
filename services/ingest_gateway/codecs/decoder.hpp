// Common interface of all codecs: frames in, scans and ego readings out.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/common/recording/frame.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"

namespace boresight::ingest {

/// The sensor's own stamp of a scan.
struct SensorStamp {
  std::int64_t time_ns = 0;   ///< on the sensor's clock: since the epoch if synchronised, else with any origin
  bool synchronised = false;  ///< the sensor reports that its clock follows the vehicle's (by gPTP, for example)
};

/// Signals of the vehicle's motion in one frame; others are absent.
struct EgoReading {
  std::optional<double> speed_mps;  ///< of the rear axle's centre, as signalled; + forward if the signal has a sign
  bool speed_is_signed = false;     ///< the sign of the speed is the direction of travel
  std::optional<double> yaw_rate_radps;      ///< + left
  std::optional<double> steering_angle_rad;  ///< at the steering wheel, + left
  std::optional<bool> reverse;               ///< gear
};

/// Results of end-to-end checks since the previous report.
struct E2eCounts {
  std::uint64_t lost = 0;      ///< messages missing by the counter
  std::uint64_t repeated = 0;  ///< messages with the previous counter
  std::uint64_t wrong = 0;     ///< messages with a wrong CRC, length, Data ID or sequence
};

/// Receiver of a decoder's output. A decoder writes scans directly into the memory shared with the other processes.
class DecoderOutput {
 public:
  virtual ~DecoderOutput() = default;
  /// Memory for a scan, or nullptr if none is available: the scan is then lost, which is counted. The memory holds old
  /// data: write every field except `header`, and `integrity` with kIncomplete or 0. Followed by publish_scan() or
  /// discard_scan().
  [[nodiscard]] virtual RadarScan* begin_scan() = 0;
  /// `reception` is the stamp of the frame that gives the time of measurement: the FIRST frame of a cycle.
  /// `cycle_counter_bits`: width of the sensor's own counter in scan.cycle_counter, for detection of gaps across its
  /// wrap; 0 if the sensor has none and the gateway counts.
  virtual void publish_scan(const FrameStamp& reception, const std::optional<SensorStamp>& sensor,
                            unsigned cycle_counter_bits) = 0;
  virtual void discard_scan() = 0;
  /// The sensor's self-diagnosis: source_condition bits, all of them in each call.
  virtual void report_conditions(std::uint32_t conditions) = 0;
  /// Adds to the statistics of the source's end-to-end protection.
  virtual void count_e2e(const E2eCounts& /*counts*/) {}
  virtual void take_ego(const EgoReading& reading, const FrameStamp& reception) = 0;
  /// Reports a rejected input; `what` names the field and the allowed value. It is not stored, so may be a temporary.
  virtual void fault(Fault fault, std::string_view what) = 0;
};

/// One source: a radar, or a set of ego signals. Nothing allocates after construction.
class Decoder {
 public:
  virtual ~Decoder() = default;
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  /// Takes a frame of the source's own link. Frames of other ids on a shared bus are ignored silently.
  virtual void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) = 0;
  /// Advances the time without a frame of this source: called about every 5 ms with the time of the frames' clock, so
  /// that an incomplete cycle ends without waiting for the next one.
  virtual void tick(std::int64_t /*now_ns*/, DecoderOutput& /*output*/) {}
};

}  // namespace boresight::ingest
