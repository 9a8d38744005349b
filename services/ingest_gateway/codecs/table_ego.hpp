// Signals of the vehicle's motion described by a mapping file → ego readings.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/codecs/frame_guard.hpp"
#include "services/ingest_gateway/dbc/mapping.hpp"

namespace boresight::ingest {

/// Speed from counters of wheel pulses, as the mean over a window of time.
class PulseSpeed {
 public:
  explicit PulseSpeed(const dbc::EgoPulses& pulses) : pulses_(pulses) {}

  struct Result {
    std::optional<double> speed_mps;  ///< absent until half a window has passed
    std::int64_t stamp_ns = 0;        ///< the middle of the window
    bool jumped = false;              ///< a counter exceeded the greatest plausible speed
  };
  [[nodiscard]] Result take(std::span<const std::uint8_t> payload, std::int64_t stamp_ns);

 private:
  struct Sample {
    std::int64_t stamp_ns;
    double distance_m;
  };
  static constexpr std::size_t kMaxSamples = 64;  // a shorter window is used if frames come faster
  void restart(std::span<const std::uint64_t> counters, std::int64_t stamp_ns);
  void add(const Sample& sample);
  [[nodiscard]] const Sample& oldest() const { return samples_[first_]; }

  dbc::EgoPulses pulses_;
  std::array<std::uint64_t, dbc::kMaxWheels> last_{};
  std::array<Sample, kMaxSamples> samples_{};
  std::size_t first_ = 0, count_ = 0;
};

/// Every frame gives a reading of its signals. Implausible values are rejected and reported.
class TableEgo : public Decoder {
 public:
  explicit TableEgo(dbc::EgoMapping mapping);

  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;

 private:
  void take_pulses(PulseSpeed& pulses, std::span<const std::uint8_t> payload, const FrameStamp& stamp,
                   DecoderOutput& output) const;
  dbc::EgoMapping mapping_;
  std::vector<std::uint64_t> keys_;  // of the messages, sorted
  std::vector<FrameGuard> guards_;
  std::vector<std::optional<PulseSpeed>> pulses_;
};

}  // namespace boresight::ingest
