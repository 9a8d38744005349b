#include "services/common/runtime/config/vehicle_file.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "interfaces/messages/header.hpp"
#include "interfaces/wire/boresight_service.hpp"
#include "services/common/recording/ip_address.hpp"
#include "services/common/runtime/config/vehicle_source.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::config {

namespace {

constexpr std::size_t kMaxRadarNameBytes = 31;
constexpr std::size_t kMaxVehicleNameBytes = 63;

/// `fallback` is the definition of the radar's profile.
E2eConfig read_e2e(Reader reader, E2eConfig e2e) {
  using e2e::Profile;
  e2e.required = reader.choice<bool>("mode", {{"off", false}, {"required", true}}, e2e.required);
  e2e.protection.profile = reader.choice<Profile>(
      "profile", {{"p04", Profile::kP04}, {"p06", Profile::kP06}, {"p07", Profile::kP07}}, e2e.protection.profile);
  e2e.protection.data_id =
      static_cast<std::uint32_t>(reader.integer("data_id", {0, 0xFFFFFFFF}, e2e.protection.data_id));
  e2e.protection.offset_bytes = static_cast<std::uint32_t>(
      reader.integer("offset_bytes", {8, e2e::kMaxOffsetBytes}, e2e.protection.offset_bytes));
  e2e.protection.max_delta_counter = static_cast<std::uint32_t>(
      reader.integer("max_delta_counter", {1, 0x7FFFFFFF}, e2e.protection.max_delta_counter));
  if (const auto problem = e2e::validate(e2e.protection)) reader.reject("", *problem);
  return e2e;
}

/// The E2E header follows the SOME/IP header. A gap by lost messages is accepted for one second.
E2eConfig default_e2e(bool required, std::uint32_t data_id) {
  E2eConfig e2e;
  e2e.required = required;
  e2e.protection = {.profile = e2e::Profile::kP07,
                    .data_id = data_id,
                    .offset_bytes = wire::boresight_service::kE2eOffsetBytes,
                    .max_delta_counter = 50};
  return e2e;
}

std::string read_mapping(Reader& reader, bool needed) {
  if (needed) reader.require("mapping");
  std::string mapping = reader.text("mapping", "");
  if (!needed && !mapping.empty()) reader.reject("mapping", "is for profile = \"mapping\" only");
  if (needed && mapping.empty() && reader.has("mapping")) {
    reader.reject("mapping", "must be the path of a mapping file");
  }
  return mapping;
}

/// Offline a source is optional; a given one is checked as well.
bool has_source(const Reader& reader, VehicleUse use) {
  return use == VehicleUse::kLive || reader.has("source");
}

void check_link(Reader& reader, LinkKind link, LinkKind needed) {
  if (!reader.has("profile") || !reader.has("source") || link == needed) return;
  constexpr std::array<std::string_view, 3> kNames = {"can", "udp", "someip"};
  reader.reject("source", fmt::format("this profile needs link = \"{}\"", kNames.at(static_cast<std::size_t>(needed))));
}

MountingPose read_pose(Reader reader) {
  MountingPose pose;
  reader.require("position_m");
  reader.require("yaw_deg");
  const auto position =
      reader.numbers("position_m", 3, {-30.0, 30.0}, {pose.position_m.begin(), pose.position_m.end()});
  std::copy(position.begin(), position.end(), pose.position_m.begin());
  pose.yaw_rad = reader.angle_deg("yaw_deg", {-180.0, 180.0}, pose.yaw_rad);
  pose.pitch_rad = reader.angle_deg("pitch_deg", {-90.0, 90.0}, pose.pitch_rad);
  pose.roll_rad = reader.angle_deg("roll_deg", {-180.0, 180.0}, pose.roll_rad);
  return pose;
}

FieldOfView read_field_of_view(Reader reader) {
  FieldOfView view;
  view.azimuth_min_rad = reader.angle_deg("azimuth_min_deg", {-180.0, 180.0}, view.azimuth_min_rad);
  view.azimuth_max_rad = reader.angle_deg("azimuth_max_deg", {-180.0, 180.0}, view.azimuth_max_rad);
  view.elevation_min_rad = reader.angle_deg("elevation_min_deg", {-90.0, 90.0}, view.elevation_min_rad);
  view.elevation_max_rad = reader.angle_deg("elevation_max_deg", {-90.0, 90.0}, view.elevation_max_rad);
  view.range_max_m = reader.number("range_max_m", {1.0, 1000.0}, view.range_max_m);
  if (view.azimuth_min_rad >= view.azimuth_max_rad) reader.reject("azimuth_min_deg", "must be below azimuth_max_deg");
  if (view.elevation_min_rad >= view.elevation_max_rad) {
    reader.reject("elevation_min_deg", "must be below elevation_max_deg");
  }
  return view;
}

SensorNoise read_noise(Reader reader) {
  SensorNoise noise;
  noise.range_std_m = reader.number("range_std_m", {1e-3, 10.0}, noise.range_std_m);
  noise.azimuth_std_rad = reader.angle_deg("azimuth_std_deg", {1e-3, 20.0}, noise.azimuth_std_rad);
  noise.elevation_std_rad = reader.angle_deg("elevation_std_deg", {1e-3, 20.0}, noise.elevation_std_rad);
  noise.range_rate_std_mps = reader.number("range_rate_std_mps", {1e-3, 10.0}, noise.range_rate_std_mps);
  return noise;
}

AlignmentTolerance read_tolerance(Reader reader) {
  AlignmentTolerance tolerance;
  tolerance.yaw_rad = reader.angle_deg("yaw_deg", {0.1, kMaxTolerance_deg}, tolerance.yaw_rad);
  tolerance.pitch_rad = reader.angle_deg("pitch_deg", {0.1, kMaxTolerance_deg}, tolerance.pitch_rad);
  tolerance.roll_rad = reader.angle_deg("roll_deg", {0.1, kMaxTolerance_deg}, tolerance.roll_rad);
  return tolerance;
}

AlignmentTolerance read_limit(Reader reader, const AlignmentTolerance& tolerance) {
  const auto read = [&reader](std::string_view key, double tolerance_rad) {
    const double limit_rad = reader.angle_deg(key, {0.1, kMaxLimit_deg}, kLimitPerTolerance * tolerance_rad);
    // Otherwise the radar would never be degraded before it is not available.
    if (limit_rad <= tolerance_rad) reader.reject(key, "must be above the tolerance of this axis");
    return limit_rad;
  };
  return {.yaw_rad = read("yaw_deg", tolerance.yaw_rad),
          .pitch_rad = read("pitch_deg", tolerance.pitch_rad),
          .roll_rad = read("roll_deg", tolerance.roll_rad)};
}

/// Without keys the lobe is as wide as the field of view.
AntennaLobe read_antenna(Reader reader, const FieldOfView& view) {
  const double azimuth_rad = view.azimuth_max_rad - view.azimuth_min_rad;
  const double elevation_rad = view.elevation_max_rad - view.elevation_min_rad;
  return {.azimuth_width_rad = reader.angle_deg("azimuth_width_deg", {0.5, 360.0}, azimuth_rad),
          .elevation_width_rad = reader.angle_deg("elevation_width_deg", {0.5, 180.0}, elevation_rad)};
}

RegionOfInterest read_region(Reader reader) {
  RegionOfInterest region;
  region.azimuth_min_rad = reader.angle_deg("azimuth_min_deg", {-180.0, 180.0}, region.azimuth_min_rad);
  region.azimuth_max_rad = reader.angle_deg("azimuth_max_deg", {-180.0, 360.0}, region.azimuth_max_rad);
  region.elevation_min_rad = reader.angle_deg("elevation_min_deg", {-90.0, 90.0}, region.elevation_min_rad);
  region.elevation_max_rad = reader.angle_deg("elevation_max_deg", {-90.0, 90.0}, region.elevation_max_rad);
  if (region.azimuth_min_rad >= region.azimuth_max_rad) {
    reader.reject("azimuth_min_deg", "must be below azimuth_max_deg");
  }
  if (region.elevation_min_rad >= region.elevation_max_rad) {
    reader.reject("elevation_min_deg", "must be below elevation_max_deg");
  }
  return region;
}

EgoConfig read_ego(Reader reader, VehicleUse use) {
  EgoConfig ego;
  if (use == VehicleUse::kLive) reader.require("source");
  ego.profile = reader.choice<EgoProfile>("profile",
                                          {{"toyota", EgoProfile::kToyota},
                                           {"srr520", EgoProfile::kSrr520},
                                           {"mapping", EgoProfile::kMapping},
                                           {"boresight", EgoProfile::kBoresight}},
                                          ego.profile);
  if (has_source(reader, use)) ego.source = read_source(reader.table("source"));
  const bool is_someip = ego.profile == EgoProfile::kBoresight;
  check_link(reader, ego.source.link, is_someip ? LinkKind::kSomeIp : LinkKind::kCan);
  namespace service = wire::boresight_service;
  ego.e2e = default_e2e(is_someip, service::data_id(ego.source.instance, service::kEventEgoMotion));
  if (is_someip) ego.e2e = read_e2e(reader.table("e2e"), ego.e2e);
  ego.mapping = read_mapping(reader, ego.profile == EgoProfile::kMapping);
  ego.speed_std_mps = reader.number("speed_std_mps", {1e-4, 10.0}, ego.speed_std_mps);
  ego.yaw_rate_std_radps = reader.number("yaw_rate_std_radps", {1e-6, 1.0}, ego.yaw_rate_std_radps);
  ego.steering_angle_std_rad = reader.number("steering_angle_std_rad", {1e-6, 1.0}, ego.steering_angle_std_rad);
  return ego;
}

/// A name as in reports: displayed on one line.
std::string read_name(Reader& reader, std::size_t max_bytes) {
  std::string name = reader.text("name", "");
  if (reader.has("name") && (name.empty() || name.size() > max_bytes)) {
    reader.reject("name", fmt::format("must have 1 … {} bytes", max_bytes));
  } else if (name.starts_with(' ') || name.ends_with(' ')) {
    reader.reject("name", "must not begin or end with a blank");
  }
  if (text::printable(name) != name) reader.reject("name", "must not contain control characters");
  return name;
}

RadarConfig read_radar(Reader reader, VehicleUse use) {
  RadarConfig radar;
  for (const char* key : {"id", "name", "mounting_pose"}) reader.require(key);
  if (use == VehicleUse::kLive || reader.has("source")) reader.require("profile");
  if (use == VehicleUse::kLive) reader.require("source");
  radar.id = static_cast<std::uint32_t>(reader.integer("id", {1, kMaxRadars}, 0));
  radar.name = read_name(reader, kMaxRadarNameBytes);
  radar.profile = reader.choice<RadarProfile>("profile",
                                              {{"toyota", RadarProfile::kToyota},
                                               {"ars548", RadarProfile::kArs548},
                                               {"srr520", RadarProfile::kSrr520},
                                               {"ars408", RadarProfile::kArs408},
                                               {"mapping", RadarProfile::kMapping},
                                               {"boresight", RadarProfile::kBoresight}},
                                              radar.profile);
  if (has_source(reader, use)) radar.source = read_source(reader.table("source"));
  const bool is_ars548 = radar.profile == RadarProfile::kArs548;
  const bool is_ars408 = radar.profile == RadarProfile::kArs408;
  const bool is_someip = radar.profile == RadarProfile::kBoresight;
  check_link(reader, radar.source.link, is_ars548 ? LinkKind::kUdp : is_someip ? LinkKind::kSomeIp : LinkKind::kCan);
  namespace service = wire::boresight_service;
  radar.e2e =
      default_e2e(is_someip, is_someip ? service::data_id(radar.source.instance, service::kEventDetectionList) : 0);
  if (is_ars548 || is_someip) radar.e2e = read_e2e(reader.table("e2e"), radar.e2e);
  radar.mapping = read_mapping(reader, radar.profile == RadarProfile::kMapping);
  if (is_ars408) {
    radar.sensor_id = static_cast<std::uint32_t>(reader.integer("sensor_id", {0, 7}, 0));
    radar.output = reader.choice<Ars408Output>("output",
                                               {{"as_it_is", Ars408Output::kAsItIs},
                                                {"clusters", Ars408Output::kClusters},
                                                {"objects", Ars408Output::kObjects}},
                                               radar.output);
  }
  if (is_ars408 || is_ars548) radar.ego_feed = reader.boolean("ego_feed", false);
  if (is_ars548) radar.steering_ratio = reader.number("steering_ratio", {1.0, 50.0}, radar.steering_ratio);
  if (is_ars548 && radar.ego_feed && radar.source.sender.empty()) {
    reader.reject("ego_feed", "needs the sensor's address as source.sender");
  }
  radar.mounting_pose = read_pose(reader.table("mounting_pose"));
  radar.field_of_view = read_field_of_view(reader.table("field_of_view"));
  radar.noise = read_noise(reader.table("noise"));
  radar.antenna = read_antenna(reader.table("antenna"), radar.field_of_view);
  radar.region_of_interest = read_region(reader.table("region_of_interest"));
  radar.tolerance = read_tolerance(reader.table("tolerance"));
  radar.limit = read_limit(reader.table("limit"), radar.tolerance);
  radar.statistics = reader.text("statistics", radar.statistics);
  if (radar.statistics.empty()) reader.reject("statistics", "must be the name of a radar profile, or a file");
  radar.cycle_time_s = reader.number("cycle_time_s", {0.005, 2.0}, radar.cycle_time_s);
  radar.latency_s = reader.number("latency_s", {0.0, 1.0}, radar.latency_s);
  radar.deadline_s = reader.number("deadline_s", {0.02, 10.0}, radar.deadline_s);
  if (radar.deadline_s <= radar.cycle_time_s) reader.reject("deadline_s", "must be longer than cycle_time_s");
  return radar;
}

}  // namespace

VehicleConfig read_vehicle(Reader root, VehicleUse use) {
  VehicleConfig vehicle;
  for (const char* key : {"name", "radar"}) root.require(key);
  if (use == VehicleUse::kLive) root.require("ego");
  vehicle.name = read_name(root, kMaxVehicleNameBytes);
  vehicle.ego = read_ego(root.table("ego"), use);
  std::vector<bool> has_source;
  std::vector<Reader> readers = root.tables("radar", {1, kMaxRadars});
  for (Reader& reader : readers) {
    RadarConfig radar = read_radar(reader, use);
    has_source.push_back(reader.has("source"));
    for (std::size_t i = 0; i < vehicle.radars.size(); ++i) {
      const RadarConfig& other = vehicle.radars[i];
      if (other.id == radar.id) reader.reject("id", fmt::format("{} is already used by {}", radar.id, other.name));
      if (other.name == radar.name) reader.reject("name", fmt::format("\"{}\" is already used", radar.name));
      if (has_source[i] && has_source.back() && is_same_source(other, radar)) {
        reader.reject("source", fmt::format("is the source of {} too; each radar must have its own", other.name));
      }
      if (reader.has("mounting_pose") && is_same_pose(other.mounting_pose, radar.mounting_pose)) {
        reader.reject("mounting_pose",
                      fmt::format("is that of {} too; each radar must have its own place or direction", other.name));
      }
    }
    vehicle.radars.push_back(std::move(radar));
  }
  root.finish();
  std::sort(vehicle.radars.begin(), vehicle.radars.end(),
            [](const RadarConfig& a, const RadarConfig& b) { return a.id < b.id; });
  return vehicle;
}

VehicleConfig read_vehicle_at(const std::filesystem::path& file, Reader root, VehicleUse use) {
  VehicleConfig vehicle = read_vehicle(std::move(root), use);
  const auto resolve = [&file](std::string& mapping) {
    if (!mapping.empty()) mapping = (file.parent_path() / mapping).lexically_normal().string();
  };
  resolve(vehicle.ego.mapping);
  for (RadarConfig& radar : vehicle.radars) resolve(radar.mapping);
  return vehicle;
}

VehicleConfig read_vehicle_file(const std::filesystem::path& file, VehicleUse use) {
  return read_vehicle_at(file, Reader::open(file), use);
}

}  // namespace boresight::config
