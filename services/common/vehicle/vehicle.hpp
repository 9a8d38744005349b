// The vehicle's configuration: mounting, field of view, data source and tolerances of each radar.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "services/common/e2e/profile.hpp"

namespace boresight {

/// Nominal mounting in the vehicle frame (ISO 8855); rotation R_z(yaw)·R_y(−pitch)·R_x(roll), positive pitch looks up.
struct MountingPose {
  std::array<double, 3> position_m{0.0, 0.0, 0.5};
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
};

/// The sensor's field of view, in its own frame around boresight; detections outside are not expected.
struct FieldOfView {
  double azimuth_min_rad = -1.3;
  double azimuth_max_rad = 1.3;
  double elevation_min_rad = -0.35;
  double elevation_max_rad = 0.35;
  double range_max_m = 300.0;
};

/// Main lobe of the antenna, transmission and reception alike, around boresight: full widths between the directions of
/// half the power, one way.
struct AntennaLobe {
  double azimuth_width_rad;
  double elevation_width_rad;
};

/// The directions from the radar, in vehicle axes, in which its data are needed; the part outside of its nominal field
/// of view does not count. By default the whole view is needed.
struct RegionOfInterest {
  double azimuth_min_rad = -std::numbers::pi;
  double azimuth_max_rad = std::numbers::pi;  ///< up to 2π, for a region across the rear
  double elevation_min_rad = -std::numbers::pi / 2.0;
  double elevation_max_rad = std::numbers::pi / 2.0;
};

/// Standard deviations to use if the sensor states none.
struct SensorNoise {
  double range_std_m = 0.2;
  double azimuth_std_rad = 0.0087;
  double elevation_std_rad = 0.0175;
  double range_rate_std_mps = 0.1;
};

/// Largest misalignment of each axis of a sensor that is not degraded, or that can be used at all.
struct AlignmentTolerance {
  double yaw_rad = 0.02618;  // 1.5°: the alignment error criterion of field service manuals
  double pitch_rad = 0.02618;
  double roll_rad = 0.05236;
};
/// Limit of use per tolerance where the vehicle file states no limit (choice).
inline constexpr double kLimitPerTolerance = 2.0;

enum class LinkKind : std::uint8_t {
  kCan,     ///< a CAN bus: SocketCAN interface, or bus name of a recording
  kUdp,     ///< UDP datagrams to a fixed address
  kSomeIp,  ///< an instance of the Boresight service, found by SOME/IP service discovery
};

/// Radar protocols of the gateway. kMapping: CAN signals of a DBC file, assigned by a mapping file.
enum class RadarProfile : std::uint8_t { kToyota, kArs548, kSrr520, kArs408, kMapping, kBoresight };
/// Ego signal sets of the gateway.
enum class EgoProfile : std::uint8_t { kToyota, kSrr520, kMapping, kBoresight };

/// Source of frames.
/// kCan: `interface` ("can1"; "" is any interface, for tools).
/// kUdp: local address to listen on, or multicast group to join; its port; the sensor's address as `sender` ("": any).
/// kSomeIp: local address for service discovery, and its port for events; instance; group and port of discovery. With a
/// `sender`, the receiver does not wait for an offer.
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

/// Output that an ARS408 is configured to send at start.
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
  double steering_ratio = 15.0;  ///< angle of steering wheel / front axle, for `ego_feed`
  MountingPose mounting_pose;
  FieldOfView field_of_view;
  SensorNoise noise;
  /// By default as wide as the field of view (choice: as the simulator's antenna).
  AntennaLobe antenna{.azimuth_width_rad = field_of_view.azimuth_max_rad - field_of_view.azimuth_min_rad,
                      .elevation_width_rad = field_of_view.elevation_max_rad - field_of_view.elevation_min_rad};
  RegionOfInterest region_of_interest;
  AlignmentTolerance tolerance;
  /// Limit of use: beyond it the data are not available; larger than the tolerance.
  AlignmentTolerance limit{.yaw_rad = kLimitPerTolerance * tolerance.yaw_rad,
                           .pitch_rad = kLimitPerTolerance * tolerance.pitch_rad,
                           .roll_rad = kLimitPerTolerance * tolerance.roll_rad};
  /// Radar profile whose weights of evidence the ghost filter uses: a name in config/radar_profiles, or a file.
  std::string statistics = "series_77ghz";
  double cycle_time_s = 0.05;
  /// Time from measurement to reception, for a radar without stamps of a synchronised clock.
  double latency_s = 0.0;
  double deadline_s = 0.25;  ///< NOT_AVAILABLE if silent for longer
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
