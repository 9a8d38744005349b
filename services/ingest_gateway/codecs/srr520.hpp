// Continental SRR520 on CAN FD → one scan per detection list, and the ego motion of its object list.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>

#include "interfaces/wire/srr520.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// One detection as reported; the radar measures no elevation and states no standard deviations.
struct Srr520Detection {
  double range_m;
  double azimuth_rad;     ///< + left
  double range_rate_mps;  ///< + receding; folded into the unambiguous interval
  double rcs_dbsm;        ///< 0 if the sensor states none
  double snr_db;
  std::uint8_t hypotheses;  ///< bit n: "pdh" n
  bool valid;               ///< azimuth and range rate are available
};
[[nodiscard]] Srr520Detection decode_srr520_detection(
    std::span<const std::uint8_t, wire::srr520::kDetectionBytes> record);

/// Collects the frames of one list at a time and checks the list at its closing frame. A list with a missing frame or a
/// wrong CRC is rejected with one fault that states the reason. Frames may arrive in any order; a repeated frame
/// replaces the earlier one, and the CRC checks the result. Near and HRR lists are separate scans: they are measured
/// some 30 ms apart and have different unambiguous intervals. Both share one counter. Only the ego motion in the header
/// of the object list is used.
class Srr520 : public Decoder {
 public:
  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
  /// Rejects a list without a further frame for 50 ms.
  void tick(std::int64_t now_ns, DecoderOutput& output) override;

 private:
  static constexpr std::size_t kNone = wire::srr520::kLists.size();

  void take_header(std::size_t list, std::span<const std::uint8_t> payload, const FrameStamp& stamp,
                   DecoderOutput& output);
  void take_records(std::size_t list, std::span<const std::uint8_t> payload, const FrameStamp& stamp,
                    DecoderOutput& output);
  static void take_status(std::span<const std::uint8_t> payload, DecoderOutput& output);
  void take_closing(std::span<const std::uint8_t> payload, DecoderOutput& output);
  void reject_unclosed(DecoderOutput& output);
  [[nodiscard]] bool is_sound(std::uint16_t crc, DecoderOutput& output) const;
  void publish_detections(DecoderOutput& output);
  void publish_ego(DecoderOutput& output) const;
  [[nodiscard]] SensorStamp sensor_stamp();
  [[nodiscard]] std::span<const std::uint8_t> collected() const;

  std::array<std::uint8_t,
             wire::srr520::kHeaderBytes + wire::srr520::kMaxRecordFrames * wire::srr520::kRecordFrameBytes>
      bytes_{};
  std::bitset<wire::srr520::kMaxRecordFrames> received_;
  std::size_t open_ = kNone;      ///< the list being collected
  std::size_t rejected_ = kNone;  ///< the rejected list with a reported fault; its remaining frames are dropped
  bool started_ = false;          ///< a header was received; frames before the first one are no fault
  FrameStamp first_;
  std::int64_t last_ns_ = 0;
  std::optional<std::uint32_t> sensor_clock_us_;  ///< last received value
  std::int64_t sensor_time_us_ = 0;               ///< the same without its wraps
};

}  // namespace boresight::ingest
