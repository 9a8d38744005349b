// Continental ARS408 on CAN → one scan per cycle, of its clusters or of its objects, whichever it is configured to
// send.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interfaces/wire/ars408.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// Collects the frames of one cycle: a status frame that announces how many entries come, a general frame for each,
/// and, if the sensor is so configured, a quality frame for each. Whether quality frames come is learnt from the cycles
/// themselves. A cycle is complete when all announced entries have come; if the next one begins or 30 ms pass without a
/// frame, what came of it is published as incomplete, with a fault that says how many are missing. Clusters are the
/// measurements to use: objects are the sensor's own tracks.
///
/// Range, azimuth and range rate are computed from the Cartesian position and relative velocity. The sensor does not
/// measure the lateral velocity of a cluster: it reports an assumption (users of a public data set recorded with it
/// find that of moving clusters to be zero), and what it measures is the projection on the line of sight.
class Ars408 : public Decoder {
 public:
  /// `sensor_id`: 0 … wire::ars408::kMaxSensorId, as the sensor is configured; shifts all ids. Higher bits are ignored.
  explicit Ars408(unsigned sensor_id);

  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
  void tick(std::int64_t now_ns, DecoderOutput& output) override;

 private:
  enum class List : std::uint8_t { kNone, kClusters, kObjects };
  enum class Quality : std::uint8_t { kUnknown, kAbsent, kSent };
  struct Entry {
    std::array<std::uint8_t, wire::ars408::kClusterGeneralBytes> general{};
    std::array<std::uint8_t, wire::ars408::kObjectQualityBytes> quality{};
    bool has_general = false;
    bool has_quality = false;
  };

  void take_status(List list, std::span<const std::uint8_t> payload, const FrameStamp& stamp, DecoderOutput& output);
  void take_entry(List list, bool is_quality, std::span<const std::uint8_t> payload, const FrameStamp& stamp,
                  DecoderOutput& output);
  [[nodiscard]] bool is_complete() const;
  void finish(DecoderOutput& output);
  void publish(bool complete, DecoderOutput& output) const;
  void write_entry(const Entry& entry, std::size_t i, RadarScan& scan) const;

  std::uint32_t id_offset_;
  List open_ = List::kNone;      ///< what is being collected
  bool started_ = false;         ///< a status frame has come: what precedes the first is nobody's fault
  bool stray_reported_ = false;  ///< one fault for all entries that come outside of their cycle
  Quality quality_ = Quality::kUnknown;
  std::size_t announced_ = 0;
  std::size_t with_general_ = 0;
  std::size_t with_quality_ = 0;
  std::size_t with_both_ = 0;
  std::uint32_t counter_ = 0;
  FrameStamp first_;
  std::int64_t last_ns_ = 0;
  std::array<Entry, 256> entries_{};       ///< by the id of the cluster or object
  std::array<std::uint8_t, 256> order_{};  ///< ids in the order in which their general frames came
};

}  // namespace boresight::ingest
