// Keeps the gateway's output in memory.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/ingest_gateway/core/sink.hpp"
#include "tests/unit/ingest_gateway/fault_counts.hpp"

namespace boresight::ingest {

class MemorySink : public Sink, public FaultCounts {
 public:
  RadarScan* begin_scan() override { return refuse_memory ? nullptr : scan.get(); }
  void publish_scan(std::uint32_t radar_id, const MeasurementTime& time) override {
    ++scans;
    last_radar = radar_id;
    last_time = time;
  }
  void discard_scan() override { ++discarded; }
  EgoMotion* begin_ego() override { return &ego; }
  void publish_ego(const MeasurementTime& time) override {
    ++egos;
    last_time = time;
  }
  void fault(Fault kind, std::string_view, std::uint32_t radar_id) override {
    ++faults[static_cast<std::size_t>(kind)];
    last_fault_radar = radar_id;
  }
  SourceStatistics& statistics(std::uint32_t radar_id) override { return source_statistics[radar_id]; }

  std::unique_ptr<RadarScan> scan = std::make_unique<RadarScan>();
  EgoMotion ego{};
  bool refuse_memory = false;
  std::size_t scans = 0, egos = 0, discarded = 0;
  std::array<SourceStatistics, kMaxRadars + 1> source_statistics{};
  std::uint32_t last_radar = 0, last_fault_radar = 99;
  MeasurementTime last_time{};
};

}  // namespace boresight::ingest
