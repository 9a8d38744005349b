// Takes what a decoder makes of fuzzed frames and holds it to what every decoder promises.
#pragma once

#include <cmath>
#include <cstdlib>
#include <memory>

#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::fuzz {

class DecoderSink : public ingest::DecoderOutput {
 public:
  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(const ingest::FrameStamp&, const std::optional<ingest::SensorStamp>&, unsigned bits) override {
    require(bits <= 32 && scan_->number_of_valid_detections <= kMaxDetections);
    for (std::size_t i = 0; i < scan_->number_of_valid_detections; ++i) {
      for (const auto* column :
           {&scan_->range_m, &scan_->azimuth_rad, &scan_->elevation_rad, &scan_->range_rate_mps, &scan_->rcs_dbsm,
            &scan_->snr_db, &scan_->range_std_m, &scan_->azimuth_std_rad, &scan_->elevation_std_rad,
            &scan_->range_rate_std_mps, &scan_->existence_probability}) {
        require(std::isfinite((*column)[i]));
      }
      require(scan_->existence_probability[i] >= 0.0F && scan_->existence_probability[i] <= 1.0F);
    }
  }
  void discard_scan() override {}
  void report_conditions(std::uint32_t) override {}
  void take_ego(const ingest::EgoReading& reading, const ingest::FrameStamp&) override {
    for (const auto& value : {reading.speed_mps, reading.yaw_rate_radps, reading.steering_angle_rad}) {
      require(!value || std::isfinite(*value));
    }
  }
  void fault(Fault, std::string_view what) override { require(!what.empty()); }

 private:
  static void require(bool holds) {
    if (!holds) std::abort();
  }
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
};

}  // namespace boresight::fuzz
