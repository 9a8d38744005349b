// The mapping files of a vehicle, with their names resolved.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "services/ingest_gateway/dbc/mapping.hpp"

namespace boresight::ingest {

struct Mappings {
  std::map<std::uint32_t, dbc::RadarMapping> radars;  ///< by radar id
  std::optional<dbc::EgoMapping> ego;
};

}  // namespace boresight::ingest
