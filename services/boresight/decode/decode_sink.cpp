#include "services/boresight/decode/decode_sink.hpp"

#include <algorithm>

#include "services/boresight/decode/csv.hpp"

namespace boresight::decode {

void DecodeSink::publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) {
  SourceStatistics& source = statistics(radar_id);
  ++source.messages;
  source.last_measurement_time_ns = time.time_ns;
  check_.take_scan(radar_id, *scan_, time);
  if (table_ == Table::kDetections) append_detections(rows_, *scan_, radar_id, time);
}

void DecodeSink::publish_ego(const ingest::MeasurementTime& time) {
  check_.take_ego(time);
  if (table_ == Table::kEgo) append_ego(rows_, *ego_, time);
}

void DecodeSink::fault(Fault fault, std::string_view what, std::uint32_t radar_id) {
  ++statistics(radar_id).rejected;
  check_.take_fault(radar_id, fault, what);
}

SourceStatistics& DecodeSink::statistics(std::uint32_t radar_id) {
  SourceStatistics& source = statistics_[std::min<std::size_t>(radar_id, kMaxRadars)];
  source.source_id = radar_id;
  return source;
}

}  // namespace boresight::decode
