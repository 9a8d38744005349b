#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

#include "services/ingest_gateway/mapping/mapping_file.hpp"

namespace boresight::ingest {

Mappings read_mappings(const VehicleConfig& vehicle) {
  Mappings mappings;
  if (vehicle.ego.profile == EgoProfile::kMapping) mappings.ego = read_ego_mapping(vehicle.ego.mapping);
  for (const RadarConfig& radar : vehicle.radars) {
    if (radar.profile == RadarProfile::kMapping) {
      mappings.radars.emplace(radar.id, read_radar_mapping(radar.mapping));
    }
  }
  return mappings;
}

}  // namespace boresight::ingest
