// Decoded messages as rows of CSV with all digits of their numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"

namespace boresight::decode {

[[nodiscard]] std::string_view name_of(TimeSource source);
/// Names of the scan_integrity bits that are set, joined by '+'; "" if none is set.
[[nodiscard]] std::string integrity_names(std::uint16_t bits);

/// Header lines, with line feed.
[[nodiscard]] std::string_view detection_header();
[[nodiscard]] std::string_view ego_header();

/// Appends a row for each detection. Times are seconds on the clock of the recording with nine decimals, numbers the
/// shortest text that reads back as the same number. A quantity that the sensor does not measure is an empty cell.
void append_detections(std::string& rows, const RadarScan& scan, std::uint32_t radar_id,
                       const ingest::MeasurementTime& time);
void append_ego(std::string& rows, const EgoMotion& ego, const ingest::MeasurementTime& time);

}  // namespace boresight::decode
