// Fuzzer of the ARS408 codec. The input is a sequence of frames of two sensors on one bus. Frames have their right
// length unless the input chooses another. Every published scan must be possible.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "services/ingest_gateway/codecs/ars408.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace boresight;
using fuzz::require;
namespace layout = wire::ars408;

/// Checks what comes out.
class Output : public ingest::DecoderOutput {
 public:
  RadarScan* begin_scan() override { return fuzz::stale(scan_); }
  void publish_scan(const ingest::FrameStamp&, const std::optional<ingest::SensorStamp>& sensor,
                    unsigned bits) override {
    require(!sensor.has_value() && bits == 16);
    fuzz::require_possible(scan_);
    require(scan_.number_of_valid_detections <= 256);
    for (std::size_t i = 0; i < scan_.number_of_valid_detections; ++i) {
      require(scan_.range_m[i] >= 0.0F && scan_.range_m[i] < 1200.0F);
      require(std::abs(scan_.azimuth_rad[i]) < 3.15F);
      require(std::abs(scan_.range_rate_mps[i]) < 145.0F);
      require(scan_.range_std_m[i] >= 0.0F && scan_.range_std_m[i] < 10.1F);
      require(scan_.azimuth_std_rad[i] >= 0.0F && scan_.azimuth_std_rad[i] < 1.82F);
      require(scan_.range_rate_std_mps[i] >= 0.0F && std::isfinite(scan_.range_rate_std_mps[i]));
      require(scan_.existence_probability[i] >= 0.0F && scan_.existence_probability[i] <= 1.0F);
    }
  }
  void discard_scan() override { std::abort(); }
  void report_conditions(std::uint32_t) override {}
  void take_ego(const ingest::EgoReading&, const ingest::FrameStamp&) override { std::abort(); }
  void fault(Fault, std::string_view what) override { require(!what.empty()); }

 private:
  static inline RadarScan scan_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* input, std::size_t size) {
  static const std::array<std::pair<std::uint32_t, std::size_t>, 8> kKinds{
      {{layout::kClusterStatusId, layout::kClusterStatusBytes},
       {layout::kClusterGeneralId, layout::kClusterGeneralBytes},
       {layout::kClusterQualityId, layout::kClusterQualityBytes},
       {layout::kObjectStatusId, layout::kObjectStatusBytes},
       {layout::kObjectGeneralId, layout::kObjectGeneralBytes},
       {layout::kObjectQualityId, layout::kObjectQualityBytes},
       {layout::kObjectExtendedId, layout::kObjectExtendedBytes},
       {layout::kStateId, layout::kStateBytes}}};
  ingest::Ars408 first(0), second(5);
  Output output;
  const fuzz::NoAllocation guard;
  std::int64_t now_ns = 1'000'000'000;
  std::span<const std::uint8_t> rest(input, size);
  const auto take = [&rest](std::size_t bytes) {
    const auto taken = rest.first(std::min(bytes, rest.size()));
    rest = rest.subspan(taken.size());
    return taken;
  };
  while (!rest.empty()) {
    const std::uint8_t choice = take(1)[0];
    // Bits 0 … 2: kind of frame; 3: sensor; 4 … 7: sometimes another length or a pause.
    const auto& [id, length] = kKinds[choice & 7u];
    const bool other_length = choice >> 4 == 14 && !rest.empty();
    recording::Frame frame;
    frame.can_id = id + ((choice & 8u) != 0 ? 5 * layout::kIdStep : 0);
    frame.payload = take(other_length ? take(1)[0] % 65 : length);
    if (choice >> 4 == 15) {
      now_ns += 31'000'000;
      first.tick(now_ns, output);
    }
    first.take(frame, {now_ns, 0, TimeSource::kLinkArrival}, output);
    second.take(frame, {now_ns, 0, TimeSource::kLinkArrival}, output);
    now_ns += 200'000;
  }
  return 0;
}
