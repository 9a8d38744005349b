// Hands the messages of the ingest gateway to the chain at once, in the order in which the gateway publishes them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "services/boresight/run/chain.hpp"
#include "services/ingest_gateway/core/sink.hpp"

namespace boresight::run {

/// Number of messages by the text of a fault; at most 32 texts, then "other reasons".
using Reasons = std::map<std::string, std::uint64_t, std::less<>>;

class GatewayFeed : public ingest::Sink {
 public:
  /// `chain` must outlive the feed.
  explicit GatewayFeed(Chain& chain) : chain_(chain) {}

  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override;
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const ingest::MeasurementTime& time) override { chain_.add_ego(ego_, time.time_ns); }
  void fault(Fault fault, std::string_view what, std::uint32_t radar_id) override;
  SourceStatistics& statistics(std::uint32_t radar_id) override;

  /// Messages that were rejected, and other faults such as a clock that jumped; by radar id, 0 for the vehicle and for
  /// what belongs to no radar.
  [[nodiscard]] const std::array<Reasons, kMaxRadars + 1>& rejected() const { return rejected_; }
  [[nodiscard]] const std::array<Reasons, kMaxRadars + 1>& noted() const { return noted_; }
  [[nodiscard]] std::uint64_t number_rejected() const { return number_rejected_; }

 private:
  Chain& chain_;
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  EgoMotion ego_{};
  std::array<Reasons, kMaxRadars + 1> rejected_, noted_;
  std::uint64_t number_rejected_ = 0;
};

}  // namespace boresight::run
