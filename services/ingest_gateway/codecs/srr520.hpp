// Continental SRR520 on CAN FD → one scan per detection list, and the ego motion that its object list carries.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>

#include "interfaces/wire/srr520.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// One detection as the sensor says it; the radar measures no elevation and states no stds.
struct Srr520Detection {
  double range_m;
  double azimuth_rad;     ///< + left
  double range_rate_mps;  ///< + receding; folded into the unambiguous interval
  double rcs_dbsm;        ///< 0 where the sensor states none
  double snr_db;
  std::uint8_t hypotheses;  ///< bit n: "pdh" n
  bool valid;               ///< azimuth and range rate are available
};
[[nodiscard]] Srr520Detection decode_srr520_detection(
    std::span<const std::uint8_t, wire::srr520::kDetectionBytes> record);

/// Collects the frames of one list at a time and judges it as a whole when its closing frame comes: a list with a
/// frame missing or a wrong CRC is rejected with one fault that says why. Frames may come in any order; a repeated
/// frame replaces the earlier one, and the CRC tells whether it should have. Near and HRR lists are scans of their own
/// since they are measured some 30 ms apart and have different unambiguous intervals; both count on one counter. Of the
/// object list, only the ego motion in its header is used.
class Srr520 : public Decoder {
 public:
  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
  /// Rejects a list whose next frame has not come for 50 ms.
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
  std::size_t rejected_ = kNone;  ///< the list whose remaining frames are dropped, its fault having been reported
  bool started_ = false;          ///< a header has come: what precedes the first is nobody's fault
  FrameStamp first_;
  std::int64_t last_ns_ = 0;
  std::optional<std::uint32_t> sensor_clock_us_;  ///< as received last
  std::int64_t sensor_time_us_ = 0;               ///< the same without its wraps
};

}  // namespace boresight::ingest
