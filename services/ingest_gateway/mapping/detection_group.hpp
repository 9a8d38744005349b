// The tables [[detections]] of a radar's mapping file.
#pragma once

#include "services/common/runtime/config/reader.hpp"
#include "services/ingest_gateway/mapping/radar_parts.hpp"
#include "services/ingest_gateway/mapping/resolver.hpp"

namespace boresight::ingest {

/// Reads one table into `radar`; errors are noted at their keys.
void read_detection_group(config::Reader table, const Resolver& names, RadarParts& radar);

}  // namespace boresight::ingest
