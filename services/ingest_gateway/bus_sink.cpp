#include "services/ingest_gateway/bus_sink.hpp"

#include "services/common/runtime/clock.hpp"

namespace boresight::ingest {

BusSink::BusSink(runtime::Node& node) : node_(node), scans_(node), egos_(node) {}

RadarScan* BusSink::begin_scan() {
  scan_ = scans_.loan();
  return scan_ ? &*scan_ : nullptr;
}

void BusSink::publish_scan(std::uint32_t radar_id, const MeasurementTime& time) {
  SourceStatistics& statistics = node_.source_statistics(radar_id);
  ++statistics.messages;
  statistics.last_measurement_time_ns = time.time_ns;
  const runtime::Origin origin{.source_id = radar_id,
                               .measurement_time_ns = time.time_ns,
                               .time_source = time.source,
                               .stage = Stage::kIngest,
                               .begin_ns = begin_ns_};
  scans_.publish(std::move(scan_), origin);
  node_.count_input(runtime::monotonic_now_ns() - begin_ns_);
}

EgoMotion* BusSink::begin_ego() {
  ego_ = egos_.loan();
  return ego_ ? &*ego_ : nullptr;
}

void BusSink::publish_ego(const MeasurementTime& time) {
  const runtime::Origin origin{.source_id = 0,
                               .measurement_time_ns = time.time_ns,
                               .time_source = time.source,
                               .stage = std::nullopt,
                               .begin_ns = 0};
  egos_.publish(std::move(ego_), origin);
}

void BusSink::fault(Fault fault, std::string_view what, std::uint32_t radar_id) {
  node_.fault(fault, what);
  const bool rejected = fault == Fault::kWireLength || fault == Fault::kWireValue || fault == Fault::kWireUnknown;
  if (radar_id != 0 && rejected) ++node_.source_statistics(radar_id).rejected;
}

}  // namespace boresight::ingest
