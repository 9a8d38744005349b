// Turns the gateway's decoded messages into rows of a table and into findings.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "services/boresight/decode/check.hpp"
#include "services/ingest_gateway/core/sink.hpp"

namespace boresight::decode {

enum class Table : std::uint8_t { kDetections, kEgo, kNone };

class DecodeSink : public ingest::Sink {
 public:
  explicit DecodeSink(Table table)
      : table_(table), scan_(std::make_unique<RadarScan>()), ego_(std::make_unique<EgoMotion>()) {}

  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override;
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return ego_.get(); }
  void publish_ego(const ingest::MeasurementTime& time) override;
  void fault(Fault fault, std::string_view what, std::uint32_t radar_id) override;
  SourceStatistics& statistics(std::uint32_t radar_id) override;

  /// Rows since the caller cleared them.
  [[nodiscard]] std::string& rows() { return rows_; }
  [[nodiscard]] Check& check() { return check_; }
  [[nodiscard]] const std::array<SourceStatistics, kMaxRadars + 1>& all_statistics() const { return statistics_; }

 private:
  Table table_;
  std::unique_ptr<RadarScan> scan_;
  std::unique_ptr<EgoMotion> ego_;
  std::array<SourceStatistics, kMaxRadars + 1> statistics_{};  // by radar id
  std::string rows_;
  Check check_;
};

}  // namespace boresight::decode
