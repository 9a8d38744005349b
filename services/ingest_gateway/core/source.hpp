// One source of the vehicle file: its decoder, its clock, and the receiver of its output.
#pragma once

#include <cstdint>
#include <memory>

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/codecs/decoder.hpp"
#include "services/ingest_gateway/core/scan_integrity.hpp"
#include "services/ingest_gateway/core/sensor_clock.hpp"
#include "services/ingest_gateway/core/sink.hpp"

namespace boresight::ingest {

/// Takes ego readings of the sources that the vehicle file names.
class EgoReceiver {
 public:
  virtual ~EgoReceiver() = default;
  virtual void take_ego(std::uint32_t source_id, const EgoReading& reading, const FrameStamp& reception) = 0;
  /// The motion for the check of scans; nullptr if unknown or too old at that time.
  [[nodiscard]] virtual const EgoMotion* latest_ego(std::int64_t time_ns) const = 0;
};

/// Adds a time of measurement and integrity bits to every scan of its decoder.
class Source : public DecoderOutput {
 public:
  /// `radar` nullptr for the source of ego signals, whose id is 0.
  Source(const RadarConfig* radar, std::unique_ptr<Decoder> decoder, EgoReceiver& ego, Sink& sink,
         const ContradictionConfig& contradiction = {});

  [[nodiscard]] std::uint32_t id() const { return id_; }
  [[nodiscard]] Decoder& decoder() { return *decoder_; }
  void take(const recording::Frame& frame, const FrameStamp& stamp) {
    now_ns_ = stamp.received_ns;
    decoder_->take(frame, stamp, *this);
  }
  void tick(std::int64_t now_ns) {
    now_ns_ = now_ns;
    decoder_->tick(now_ns, *this);
  }

  [[nodiscard]] RadarScan* begin_scan() override;
  void publish_scan(const FrameStamp& reception, const std::optional<SensorStamp>& sensor,
                    unsigned cycle_counter_bits) override;
  void discard_scan() override;
  void report_conditions(std::uint32_t conditions) override;
  void count_e2e(const E2eCounts& counts) override;
  void take_ego(const EgoReading& reading, const FrameStamp& reception) override;
  void fault(Fault fault, std::string_view what) override;

 private:
  void report(const SensorClock::Result& time);
  std::uint32_t id_;
  SensorClock clock_;
  ScanJudge judge_;
  std::unique_ptr<Decoder> decoder_;
  EgoReceiver& ego_;
  Sink& sink_;
  RadarScan* scan_ = nullptr;
  std::uint32_t counted_cycles_ = 0;
  std::int64_t now_ns_ = 0;
};

}  // namespace boresight::ingest
