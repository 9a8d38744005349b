#include "services/boresight/decode/made_up_vehicle.hpp"

#include <numbers>

namespace boresight::decode {

const std::vector<std::pair<std::string, RadarProfile>>& profiles() {
  static const std::vector<std::pair<std::string, RadarProfile>> kProfiles = {{"ars548", RadarProfile::kArs548},
                                                                              {"toyota", RadarProfile::kToyota}};
  return kProfiles;
}

VehicleConfig made_up_vehicle(const MadeUp& options) {
  // A name that no interface can have: the vehicle's motion is not looked for where its signals are unknown.
  constexpr const char* kNowhere = "-";
  VehicleConfig vehicle;
  vehicle.name = "recording";
  vehicle.ego.source = {.link = LinkKind::kCan, .interface = kNowhere, .address = {}, .port = 0, .sender = {}};
  RadarConfig radar;
  radar.id = 1;
  radar.name = "radar";
  radar.profile = options.profile;
  radar.field_of_view = {.azimuth_min_rad = -std::numbers::pi,
                         .azimuth_max_rad = std::numbers::pi,
                         .elevation_min_rad = -std::numbers::pi / 2.0,
                         .elevation_max_rad = std::numbers::pi / 2.0,
                         .range_max_m = 1500.0};
  switch (options.profile) {
    case RadarProfile::kArs548:
      radar.source.link = LinkKind::kUdp;  // to any address and port: what is no ARS548 message is told by its length
      break;
    case RadarProfile::kToyota:
      radar.source = {.link = LinkKind::kCan, .interface = options.interface, .address = {}, .port = 0, .sender = {}};
      vehicle.ego.profile = EgoProfile::kToyota;
      vehicle.ego.source.interface = options.interface;
      break;
  }
  vehicle.radars.push_back(radar);
  return vehicle;
}

}  // namespace boresight::decode
