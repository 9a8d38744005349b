#include "services/boresight/run/gateway_feed.hpp"

#include <algorithm>

namespace boresight::run {

namespace {
constexpr std::size_t kMostReasons = 32;
}

void GatewayFeed::publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) {
  SourceStatistics& source = statistics(radar_id);
  ++source.messages;
  source.last_measurement_time_ns = time.time_ns;
  scan_->header.source_id = radar_id;
  chain_.add_scan(*scan_, time.time_ns);
}

void GatewayFeed::fault(Fault fault, std::string_view what, std::uint32_t radar_id) {
  // The gateway's service counts these kinds as rejected messages of a radar.
  const bool is_rejected = fault == Fault::kWireLength || fault == Fault::kWireValue || fault == Fault::kWireUnknown;
  if (is_rejected) ++number_rejected_;
  if (is_rejected && radar_id != 0) ++statistics(radar_id).rejected;
  Reasons& reasons = (is_rejected ? rejected_ : noted_)[std::min<std::size_t>(radar_id, kMaxRadars)];
  std::string reason(what);
  if (reasons.size() >= kMostReasons && !reasons.contains(reason)) reason = "other reasons";
  ++reasons[reason];
}

SourceStatistics& GatewayFeed::statistics(std::uint32_t radar_id) {
  return chain_.sources[std::min<std::size_t>(radar_id, kMaxRadars)];
}

}  // namespace boresight::run
