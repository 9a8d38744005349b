// The vehicle as configured: where each radar is mounted, what it sees, where its data come from, what is tolerated.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "services/common/e2e/profile.hpp"

namespace boresight {

/// Nominal mounting in the vehicle frame (ISO 8855); rotation R_z(yaw)·R_y(−pitch)·R_x(roll), pitch positive looks up.
struct MountingPose {
  std::array<double, 3> position_m{0.0, 0.0, 0.5};
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
};

/// What the sensor can see, in its own frame around boresight; detections outside are not expected.
struct FieldOfView {
  double azimuth_min_rad = -1.3;
  double azimuth_max_rad = 1.3;
  double elevation_min_rad = -0.35;
  double elevation_max_rad = 0.35;
  double range_max_m = 300.0;
};

/// Stds to use where the sensor states none.
struct SensorNoise {
  double range_std_m = 0.2;
  double azimuth_std_rad = 0.0087;
  double elevation_std_rad = 0.0175;
  double range_rate_std_mps = 0.1;
};

/// Misalignment of an axis beyond which the sensor is degraded.
struct AlignmentTolerance {
  double yaw_rad = 0.02618;  // 1.5°: the alignment error criterion of field service manuals
  double pitch_rad = 0.02618;
  double roll_rad = 0.05236;
};

enum class LinkKind : std::uint8_t {
  kCan,     ///< a CAN bus: SocketCAN interface or recorded bus name
  kUdp,     ///< UDP datagrams to a fixed address
  kSomeIp,  ///< an instance of the Boresight service, found by SOME/IP service discovery
};

/// Names the radar protocols that the gateway speaks. kMapping: CAN signals of a DBC file, assigned by a mapping file.
enum class RadarProfile : std::uint8_t { kToyota, kArs548, kSrr520, kArs408, kMapping, kBoresight };
/// Names the ego signal sets that the gateway speaks.
enum class EgoProfile : std::uint8_t { kToyota, kSrr520, kMapping, kBoresight };

/// Where frames come from. For kCan: `interface` ("can1"; "" takes any, for tools). For kUdp: the local address to
/// listen on or the multicast group to join, its port, and the sender whose datagrams are this sensor's ("" accepts any
/// sender). For kSomeIp: the local address that takes part in service discovery and its port for events, the instance,
/// and the group and port of discovery; with a `sender` its offer is not waited for.
struct SourceAddress {
  LinkKind link = LinkKind::kCan;
  std::string interface;
  std::string address;
  std::uint16_t port = 0;
  std::string sender;
  std::uint16_t sender_port = 0;  ///< kSomeIp with `sender`
  std::uint16_t instance = 0;
  std::string discovery_address = "224.244.224.245";
  std::uint16_t discovery_port = 30490;
};

/// End-to-end protection of a source's messages.
struct E2eConfig {
  bool required = false;
  e2e::Config protection;
};

/// What an ARS408 is asked to send at start.
enum class Ars408Output : std::uint8_t { kAsItIs, kClusters, kObjects };

struct RadarConfig {
  std::uint32_t id = 0;  ///< 1…16
  std::string name;      ///< "front_left"
  RadarProfile profile = RadarProfile::kArs548;
  SourceAddress source;
  E2eConfig e2e;
  std::string mapping;          ///< kMapping: path of the mapping file
  std::uint32_t sensor_id = 0;  ///< kArs408: 0…7, several share a bus
  Ars408Output output = Ars408Output::kAsItIs;
  bool ego_feed = false;         ///< kArs548, kArs408: the vehicle's motion is sent to the sensor
  double steering_ratio = 15.0;  ///< steering wheel to front axle, for that
  MountingPose mounting_pose;
  FieldOfView field_of_view;
  SensorNoise noise;
  AlignmentTolerance tolerance;
  double cycle_time_s = 0.05;
  /// From measurement to reception, for a radar that does not stamp its data with a synchronised clock.
  double latency_s = 0.0;
  double deadline_s = 0.25;  ///< silent for longer: NOT_AVAILABLE
};

struct EgoConfig {
  EgoProfile profile = EgoProfile::kToyota;
  SourceAddress source;
  E2eConfig e2e;
  std::string mapping;  ///< kMapping: path of the mapping file
  double speed_std_mps = 0.05;
  double yaw_rate_std_radps = 0.005;
  double steering_angle_std_rad = 0.02;
};

struct VehicleConfig {
  std::string name;
  EgoConfig ego;
  std::vector<RadarConfig> radars;  ///< sorted by id

  /// The radar with that id, or nullptr.
  [[nodiscard]] const RadarConfig* radar(std::uint32_t id) const {
    for (const RadarConfig& r : radars) {
      if (r.id == id) return &r;
    }
    return nullptr;
  }
};

}  // namespace boresight
