#include "services/common/runtime/config/vehicle_source.hpp"

#include <string>

#include <Eigen/Core>
#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/common/recording/ip_address.hpp"
#include "services/common/runtime/config/network_values.hpp"

namespace boresight::config {

namespace {

using recording::IpAddress;

constexpr double kSamePlace_m = 0.01;
constexpr double kSameDirection_rad = 1.0 * kRadiansPerDegree;

void check_interface(Reader& reader, const std::string& name) {
  if (reader.has("interface") && !is_interface_name(name)) {
    reader.reject("interface", "must be a network interface's name of 1 … 15 characters without blanks, '/' and ':'");
  }
}

/// The address under `key`, unspecified if the key is absent. Notes an error if the text is no IP address.
IpAddress checked_address(Reader& reader, std::string_view key, const std::string& text) {
  const auto address = recording::parse_ip(text);
  if (reader.has(key) && !address) {
    reader.reject(key, fmt::format("\"{}\" is neither an IPv4 nor an IPv6 address", text));
  }
  return address.value_or(IpAddress{});
}

/// Notes an error unless the address is absent, invalid or that of one host.
void expect_host(Reader& reader, std::string_view key, const std::string& text, const IpAddress& address) {
  if (recording::parse_ip(text) && (address.is_unspecified() || address.is_multicast())) {
    reader.reject(key, fmt::format("\"{}\" is not the address of one host; must be a unicast address", text));
  }
}

/// Notes an error at `key` if both addresses are given and not of one version of IP.
void expect_one_version(Reader& reader, std::string_view key, const IpAddress& a, const IpAddress& b) {
  if (a.is_unspecified() || b.is_unspecified() || a.is_v4() == b.is_v4()) return;
  reader.reject(key, "must be of the same IP version as address");
}

SourceAddress read_can(Reader& reader, SourceAddress source) {
  reader.require("interface");
  source.interface = reader.text("interface", "");
  check_interface(reader, source.interface);
  return source;
}

void read_someip(Reader& reader, SourceAddress& source, const IpAddress& address) {
  source.instance = static_cast<std::uint16_t>(reader.integer("instance", {1, 65534}, 1));
  source.sender_port = static_cast<std::uint16_t>(reader.integer("sender_port", {1, 65535}, 0));
  source.discovery_address = reader.text("discovery_address", source.discovery_address);
  source.discovery_port =
      static_cast<std::uint16_t>(reader.integer("discovery_port", {1, 65535}, source.discovery_port));
  expect_host(reader, "address", source.address, address);
  const IpAddress group = checked_address(reader, "discovery_address", source.discovery_address);
  if (recording::parse_ip(source.discovery_address) && !group.is_multicast()) {
    reader.reject("discovery_address", fmt::format("\"{}\" must be a multicast group", source.discovery_address));
  }
  // The default group is of IPv4.
  expect_one_version(reader, "discovery_address", group, address);
  if (source.sender.empty() != (source.sender_port == 0)) {
    reader.reject("sender", "sender and sender_port are given together or not at all");
  }
  if (source.port == source.discovery_port) reader.reject("port", "is the port of service discovery");
}

SourceAddress read_ip(Reader& reader, SourceAddress source) {
  const bool someip = source.link == LinkKind::kSomeIp;
  constexpr std::int64_t kEventPort = 30600;
  reader.require("address");
  reader.require(someip ? "instance" : "port");
  source.address = reader.text("address", "");
  source.port = static_cast<std::uint16_t>(reader.integer("port", {1, 65535}, someip ? kEventPort : 0));
  source.sender = reader.text("sender", "");
  source.interface = reader.text("interface", "");
  check_interface(reader, source.interface);
  const IpAddress address = checked_address(reader, "address", source.address);
  if (someip) read_someip(reader, source, address);
  const IpAddress sender = checked_address(reader, "sender", source.sender);
  expect_host(reader, "sender", source.sender, sender);
  expect_one_version(reader, "sender", sender, address);
  return source;
}

bool is_same_address(const std::string& a, const std::string& b) {
  return a == b || recording::ip_or_unspecified(a) == recording::ip_or_unspecified(b);
}

}  // namespace

SourceAddress read_source(Reader reader) {
  SourceAddress source;
  reader.require("link");
  source.link = reader.choice<LinkKind>(
      "link", {{"can", LinkKind::kCan}, {"udp", LinkKind::kUdp}, {"someip", LinkKind::kSomeIp}}, source.link);
  return source.link == LinkKind::kCan ? read_can(reader, source) : read_ip(reader, source);
}

bool is_same_source(const RadarConfig& a, const RadarConfig& b) {
  const SourceAddress& s = a.source;
  const SourceAddress& t = b.source;
  if (s.link != t.link) return false;
  if (s.link == LinkKind::kCan) {
    return a.profile == b.profile && s.interface == t.interface && a.sensor_id == b.sensor_id && a.mapping == b.mapping;
  }
  if (s.link == LinkKind::kSomeIp) return s.instance == t.instance;
  return is_same_address(s.address, t.address) && s.port == t.port &&
         (s.sender.empty() || t.sender.empty() || is_same_address(s.sender, t.sender));
}

bool is_same_pose(const MountingPose& a, const MountingPose& b) {
  const Eigen::Vector3d offset_m =
      Eigen::Map<const Eigen::Vector3d>(a.position_m.data()) - Eigen::Map<const Eigen::Vector3d>(b.position_m.data());
  const auto rotation = [](const MountingPose& pose) {
    return geometry::sensor_to_vehicle(pose.yaw_rad, pose.pitch_rad, pose.roll_rad);
  };
  const Eigen::Matrix3d turn = rotation(a).transpose() * rotation(b);
  return offset_m.norm() < kSamePlace_m && geometry::so3_log(turn).norm() < kSameDirection_rad;
}

}  // namespace boresight::config
