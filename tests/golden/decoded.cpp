#include "tests/golden/support/decoded.hpp"

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/core/gateway.hpp"

namespace boresight::golden {

namespace {

class Memory : public ingest::Sink {
 public:
  explicit Memory(Decoding& decoding) : decoding_(decoding) {}
  RadarScan* begin_scan() override {
    scan_ = std::make_unique<RadarScan>();
    return scan_.get();
  }
  void publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) override {
    scan_->header.source_id = radar_id;
    scan_->header.measurement_time_ns = time.time_ns;
    scan_->header.time_source = time.source;
    decoding_.messages.push_back({std::move(scan_), nullptr});
  }
  void discard_scan() override { scan_.reset(); }
  SourceStatistics& statistics(std::uint32_t) override { return statistics_; }
  EgoMotion* begin_ego() override {
    ego_ = std::make_unique<EgoMotion>();
    return ego_.get();
  }
  void publish_ego(const ingest::MeasurementTime& time) override {
    ego_->header.measurement_time_ns = time.time_ns;
    decoding_.messages.push_back({nullptr, std::move(ego_)});
  }
  void fault(Fault, std::string_view what, std::uint32_t) override { decoding_.faults.emplace_back(what); }

 private:
  Decoding& decoding_;
  std::unique_ptr<RadarScan> scan_;
  SourceStatistics statistics_{};
  std::unique_ptr<EgoMotion> ego_;
};

}  // namespace

VehicleConfig vehicle(const std::string& name) {
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle" / (name + ".toml"));
}

Decoding decode(const VehicleConfig& vehicle, const std::filesystem::path& recording) {
  Decoding decoding;
  Memory memory(decoding);
  ingest::Gateway gateway(vehicle, memory);
  const auto reader =
      recording::open_recording(recording, [&](const std::string& problem) { decoding.faults.push_back(problem); });
  recording::Frame frame;
  while (reader->next(frame)) gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
  gateway.finish();
  return decoding;
}

std::filesystem::path shared_data() {
  return BORESIGHT_SHARED_DATA;
}

}  // namespace boresight::golden
