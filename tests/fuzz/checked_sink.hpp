// Sink for a gateway's products in fuzz targets: it checks and drops them.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "services/ingest_gateway/core/sink.hpp"
#include "tests/fuzz/support.hpp"

namespace boresight::fuzz {

class CheckedSink : public ingest::Sink {
 public:
  RadarScan* begin_scan() override {
    require(!std::exchange(begun_, true));
    return stale(scan_);
  }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override {
    require(std::exchange(begun_, false));
    require(radar_id >= 1 && radar_id <= kMaxRadars && time.source != TimeSource::kUnknown);
    require_possible(scan_);
  }
  void discard_scan() override { require(std::exchange(begun_, false)); }
  EgoMotion* begin_ego() override {
    require(!std::exchange(begun_ego_, true));
    return stale(ego_);
  }
  void publish_ego(const ingest::MeasurementTime& time) override {
    require(std::exchange(begun_ego_, false) && time.source != TimeSource::kUnknown);
    require(ego_.fields < 1u << 4 && ego_.has(ego_field::kSpeed) && std::abs(ego_.speed_mps) <= 100.0F);
    for (const float value : {ego_.speed_std_mps, ego_.yaw_rate_radps, ego_.yaw_rate_std_radps, ego_.steering_angle_rad,
                              ego_.steering_angle_std_rad, ego_.longitudinal_acceleration_mps2}) {
      require(std::isfinite(value));
    }
  }
  void fault(Fault fault, std::string_view what, std::uint32_t radar_id) override {
    require(static_cast<std::size_t>(fault) < kNumberOfFaults && !what.empty() && radar_id <= kMaxRadars);
  }
  SourceStatistics& statistics(std::uint32_t radar_id) override { return statistics_.at(radar_id); }
  void send(const recording::Frame& frame) override {
    volatile std::uint8_t sum = 0;
    for (const std::uint8_t b : frame.payload) sum = static_cast<std::uint8_t>(sum + b);
  }
  void join(const recording::Endpoint& group, std::string_view) override {
    require(group.address.is_multicast());
    ++joined_;
  }
  void leave(const recording::Endpoint&, std::string_view) override { require(joined_-- > 0); }
  void require_at_rest() const { require(!begun_ && !begun_ego_); }

 private:
  static inline RadarScan scan_;
  EgoMotion ego_{};
  std::array<SourceStatistics, kMaxRadars + 1> statistics_{};
  bool begun_ = false, begun_ego_ = false;
  std::size_t joined_ = 0;
};

}  // namespace boresight::fuzz
