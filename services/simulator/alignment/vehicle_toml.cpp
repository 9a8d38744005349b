#include "services/simulator/alignment/vehicle_toml.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace boresight::simulator {

namespace {

/// Angle in degrees, without the last digits, which the conversion from radians spoils.
std::string degrees(double angle_rad) {
  return fmt::format("{:.12g}", angle_rad * (180.0 / M_PI));
}

/// A basic string of TOML. Names come from a TOML file, so they hold no control characters.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string radar_toml(const RadarConfig& radar) {
  const MountingPose& pose = radar.mounting_pose;
  const FieldOfView& view = radar.field_of_view;
  const SensorNoise& noise = radar.noise;
  std::string text =
      fmt::format("\n[[radar]]\nid = {}\nname = {}\nprofile = \"ars548\"\n", radar.id, quoted(radar.name));
  text += fmt::format("source = {{link = \"udp\", address = \"{}\", port = {}, sender = \"{}\"}}\n",
                      radar.source.address, radar.source.port, radar.source.sender);
  text += fmt::format("cycle_time_s = {}\ndeadline_s = {}\n", radar.cycle_time_s, radar.deadline_s);
  text += fmt::format("mounting_pose = {{position_m = [{}, {}, {}], yaw_deg = {}, pitch_deg = {}, roll_deg = {}}}\n",
                      pose.position_m[0], pose.position_m[1], pose.position_m[2], degrees(pose.yaw_rad),
                      degrees(pose.pitch_rad), degrees(pose.roll_rad));
  text += fmt::format(
      "field_of_view = {{azimuth_min_deg = {}, azimuth_max_deg = {}, elevation_min_deg = {}, elevation_max_deg = {}, "
      "range_max_m = {}}}\n",
      degrees(view.azimuth_min_rad), degrees(view.azimuth_max_rad), degrees(view.elevation_min_rad),
      degrees(view.elevation_max_rad), view.range_max_m);
  text += fmt::format(
      "noise = {{range_std_m = {}, azimuth_std_deg = {}, elevation_std_deg = {}, range_rate_std_mps = {}}}\n",
      noise.range_std_m, degrees(noise.azimuth_std_rad), degrees(noise.elevation_std_rad), noise.range_rate_std_mps);
  for (const auto& [key, angles] : {std::pair{"tolerance", radar.tolerance}, std::pair{"limit", radar.limit}}) {
    text += fmt::format("{} = {{yaw_deg = {}, pitch_deg = {}, roll_deg = {}}}\n", key, degrees(angles.yaw_rad),
                        degrees(angles.pitch_rad), degrees(angles.roll_rad));
  }
  return text;
}

}  // namespace

std::string vehicle_toml(const VehicleConfig& vehicle) {
  std::string text = fmt::format(
      "# The nominal vehicle of a simulated alignment drive.\nname = {}\n\n[ego]\n"
      "profile = \"toyota\"\nsource = {{link = \"can\", interface = \"{}\"}}\nspeed_std_mps = {}\n"
      "yaw_rate_std_radps = {}\n",
      quoted(vehicle.name), vehicle.ego.source.interface, vehicle.ego.speed_std_mps, vehicle.ego.yaw_rate_std_radps);
  for (const RadarConfig& radar : vehicle.radars) text += radar_toml(radar);
  return text;
}

}  // namespace boresight::simulator
