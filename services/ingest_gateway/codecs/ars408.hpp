// Continental ARS408 on CAN → one scan per cycle, of clusters or of objects, as the sensor is configured.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interfaces/wire/ars408.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// Collects the frames of one cycle: a status frame that announces the number of entries, a general frame per entry,
/// and, if so configured, a quality frame per entry. The decoder learns from the cycles if quality frames are sent. A
/// cycle is complete with all announced entries. If the next cycle begins, or 30 ms pass without a frame, the received
/// entries are published as incomplete, with a fault that gives the number of missing ones. Clusters are measurements;
/// objects are the sensor's own tracks.
///
/// Range, azimuth and range rate are computed from the Cartesian position and relative velocity. The sensor does not
/// measure the lateral velocity of a cluster but reports an assumed one (zero for moving clusters in a public data
/// set). The measured quantity is the projection on the line of sight.
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
  List open_ = List::kNone;      ///< list being collected
  bool started_ = false;         ///< a status frame was received; entries before the first one are no fault
  bool stray_reported_ = false;  ///< one fault for all entries outside of their cycle
  Quality quality_ = Quality::kUnknown;
  std::size_t announced_ = 0;
  std::size_t with_general_ = 0;
  std::size_t with_quality_ = 0;
  std::size_t with_both_ = 0;
  std::uint32_t counter_ = 0;
  FrameStamp first_;
  std::int64_t last_ns_ = 0;
  std::array<Entry, 256> entries_{};       ///< by the id of the cluster or object
  std::array<std::uint8_t, 256> order_{};  ///< ids in the order of their general frames
};

}  // namespace boresight::ingest
