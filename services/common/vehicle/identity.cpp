#include "services/common/vehicle/identity.hpp"

#include <algorithm>
#include <string_view>

#include "services/common/state/fingerprint.hpp"

namespace boresight {

namespace {

using state::Fingerprint;

std::uint64_t fingerprint_of(const RadarConfig& radar) {
  Fingerprint print;
  print.add(static_cast<std::uint64_t>(radar.id));
  for (const double x : radar.mounting_pose.position_m) print.add(x);
  print.add(radar.mounting_pose.yaw_rad);
  print.add(radar.mounting_pose.pitch_rad);
  print.add(radar.mounting_pose.roll_rad);
  print.add(static_cast<std::uint64_t>(radar.profile));
  print.add(static_cast<std::uint64_t>(radar.sensor_id));
  print.add(radar.mapping);
  return print.value();
}

}  // namespace

Identity identity_of(const VehicleConfig& vehicle) {
  Identity identity;
  Fingerprint name;
  name.add(std::string_view(vehicle.name));
  identity.vehicle = name.value();
  identity.number_of_radars = std::min(vehicle.radars.size(), identity.radars.size());
  for (std::size_t i = 0; i < identity.number_of_radars; ++i) {
    identity.radars[i] = {vehicle.radars[i].id, fingerprint_of(vehicle.radars[i])};
  }
  return identity;
}

}  // namespace boresight
