// A decoder output that checks every product.
#pragma once

#include <utility>

#include "services/ingest_gateway/codecs/decoder.hpp"
#include "tests/fuzz/support.hpp"

namespace boresight::fuzz {

class CheckedOutput : public ingest::DecoderOutput {
 public:
  /// `always_finite`: flagged detections must hold finite numbers too.
  explicit CheckedOutput(bool always_finite = false) : always_finite_(always_finite) {}
  RadarScan* begin_scan() override {
    require(!std::exchange(begun_, true));
    return stale(scan_);
  }
  void publish_scan(const ingest::FrameStamp&, const std::optional<ingest::SensorStamp>&, unsigned bits) override {
    require(std::exchange(begun_, false) && bits <= 32);
    require_possible(scan_);
    if (always_finite_) require_finite(scan_);
  }
  void discard_scan() override { require(std::exchange(begun_, false)); }
  void report_conditions(std::uint32_t conditions) override { require(conditions < 1u << 7); }
  void take_ego(const ingest::EgoReading& reading, const ingest::FrameStamp&) override {
    for (const auto& value : {reading.speed_mps, reading.yaw_rate_radps, reading.steering_angle_rad}) {
      require(!value || std::isfinite(*value));
    }
  }
  void fault(Fault fault, std::string_view what) override {
    require(static_cast<std::size_t>(fault) < kNumberOfFaults && !what.empty());
  }
  /// Call after each frame: requires that no scan is unfinished.
  void require_at_rest() const { require(!begun_); }

 private:
  static inline RadarScan scan_;
  const bool always_finite_;
  bool begun_ = false;
};

}  // namespace boresight::fuzz
