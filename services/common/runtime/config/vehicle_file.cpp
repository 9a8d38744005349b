#include "services/common/runtime/config/vehicle_file.hpp"

#include <algorithm>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "interfaces/messages/header.hpp"

namespace boresight::config {

namespace {

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

SourceAddress read_source(Reader reader) {
  SourceAddress source;
  reader.require("link");
  source.link = reader.choice<LinkKind>("link", {{"can", LinkKind::kCan}, {"udp", LinkKind::kUdp}}, source.link);
  if (source.link == LinkKind::kCan) {
    reader.require("interface");
    source.interface = reader.text("interface", "");
    if (reader.has("interface") && (source.interface.empty() || source.interface.size() > 15)) {
      reader.reject("interface", "must be an interface's name of 1 … 15 characters");
    }
    return source;
  }
  reader.require("address");
  reader.require("port");
  source.address = reader.text("address", "");
  source.port = static_cast<std::uint16_t>(reader.integer("port", {1, 65535}, 0));
  source.sender = reader.text("sender", "");
  source.interface = reader.text("interface", "");
  if (reader.has("address") && !is_ipv4(source.address)) {
    reader.reject("address", fmt::format("\"{}\" is not an IPv4 address", source.address));
  }
  if (!source.sender.empty() && !is_ipv4(source.sender)) {
    reader.reject("sender", fmt::format("\"{}\" is not an IPv4 address", source.sender));
  }
  return source;
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
  tolerance.yaw_rad = reader.angle_deg("yaw_deg", {0.1, 45.0}, tolerance.yaw_rad);
  tolerance.pitch_rad = reader.angle_deg("pitch_deg", {0.1, 45.0}, tolerance.pitch_rad);
  tolerance.roll_rad = reader.angle_deg("roll_deg", {0.1, 45.0}, tolerance.roll_rad);
  return tolerance;
}

EgoConfig read_ego(Reader reader) {
  EgoConfig ego;
  reader.require("source");
  ego.profile = reader.choice<EgoProfile>("profile", {{"toyota", EgoProfile::kToyota}}, ego.profile);
  ego.source = read_source(reader.table("source"));
  ego.speed_std_mps = reader.number("speed_std_mps", {1e-4, 10.0}, ego.speed_std_mps);
  ego.yaw_rate_std_radps = reader.number("yaw_rate_std_radps", {1e-6, 1.0}, ego.yaw_rate_std_radps);
  ego.steering_angle_std_rad = reader.number("steering_angle_std_rad", {1e-6, 1.0}, ego.steering_angle_std_rad);
  return ego;
}

RadarConfig read_radar(Reader reader) {
  RadarConfig radar;
  for (const char* key : {"id", "name", "profile", "source", "mounting_pose"}) reader.require(key);
  radar.id = static_cast<std::uint32_t>(reader.integer("id", {1, kMaxRadars}, 0));
  radar.name = reader.text("name", "");
  if (reader.has("name") && (radar.name.empty() || radar.name.size() > 31)) {
    reader.reject("name", "must have 1 … 31 characters");
  }
  radar.profile = reader.choice<RadarProfile>(
      "profile", {{"toyota", RadarProfile::kToyota}, {"ars548", RadarProfile::kArs548}}, radar.profile);
  radar.source = read_source(reader.table("source"));
  const LinkKind needed = radar.profile == RadarProfile::kToyota ? LinkKind::kCan : LinkKind::kUdp;
  if (reader.has("profile") && reader.has("source") && radar.source.link != needed) {
    reader.reject("source", fmt::format("this profile needs link = \"{}\"", needed == LinkKind::kCan ? "can" : "udp"));
  }
  radar.mounting_pose = read_pose(reader.table("mounting_pose"));
  radar.field_of_view = read_field_of_view(reader.table("field_of_view"));
  radar.noise = read_noise(reader.table("noise"));
  radar.tolerance = read_tolerance(reader.table("tolerance"));
  radar.cycle_time_s = reader.number("cycle_time_s", {0.005, 2.0}, radar.cycle_time_s);
  radar.latency_s = reader.number("latency_s", {0.0, 1.0}, radar.latency_s);
  radar.deadline_s = reader.number("deadline_s", {0.02, 10.0}, radar.deadline_s);
  if (radar.deadline_s <= radar.cycle_time_s) reader.reject("deadline_s", "must be longer than cycle_time_s");
  return radar;
}

bool same_source(const RadarConfig& a, const RadarConfig& b) {
  const SourceAddress& s = a.source;
  const SourceAddress& t = b.source;
  if (s.link != t.link) return false;
  if (s.link == LinkKind::kCan) return a.profile == b.profile && s.interface == t.interface;
  return s.address == t.address && s.port == t.port && (s.sender == t.sender || s.sender.empty() || t.sender.empty());
}

}  // namespace

VehicleConfig read_vehicle(Reader root) {
  VehicleConfig vehicle;
  for (const char* key : {"name", "ego", "radar"}) root.require(key);
  vehicle.name = root.text("name", "");
  vehicle.ego = read_ego(root.table("ego"));
  std::vector<Reader> readers = root.tables("radar");
  if (readers.size() > kMaxRadars) root.reject("radar", fmt::format("at most {} radars", kMaxRadars));
  for (Reader& reader : readers) {
    RadarConfig radar = read_radar(reader);
    for (const RadarConfig& other : vehicle.radars) {
      if (other.id == radar.id) reader.reject("id", fmt::format("{} is already used by {}", radar.id, other.name));
      if (other.name == radar.name) reader.reject("name", fmt::format("\"{}\" is already used", radar.name));
      if (same_source(other, radar)) reader.reject("source", fmt::format("is the source of {} too", other.name));
    }
    vehicle.radars.push_back(std::move(radar));
  }
  root.finish();
  std::sort(vehicle.radars.begin(), vehicle.radars.end(),
            [](const RadarConfig& a, const RadarConfig& b) { return a.id < b.id; });
  return vehicle;
}

VehicleConfig read_vehicle_file(const std::filesystem::path& file) {
  return read_vehicle(Reader::open(file));
}

}  // namespace boresight::config
