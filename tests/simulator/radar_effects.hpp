// What a scenario says about its radars: how they are mounted, what disturbs them, and which waves they get.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "interfaces/messages/header.hpp"

namespace boresight::simulator {

/// Angles by which a radar is crooked, radians: actual = nominal + these.
struct Misalignment {
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  [[nodiscard]] bool operator==(const Misalignment&) const = default;
};

/// From `time_s` on the radar is crooked by `by` more.
struct RadarStepChange {
  std::uint32_t radar = 0;
  double time_s = 0.0;
  Misalignment by{};
  [[nodiscard]] bool operator==(const RadarStepChange&) const = default;
};

/// Dirt, snow or ice on a radar: its two-way loss grows linearly from 0 at `begin_s` to `loss_db` at `full_s` and
/// stays. Within the azimuths only, in the sensor's frame; the defaults cover every view.
struct RadarBlockage {
  std::uint32_t radar = 0;
  double begin_s = 0.0;
  double full_s = 0.0;
  double loss_db = 0.0;
  double azimuth_min_rad = -3.2;
  double azimuth_max_rad = 3.2;
  [[nodiscard]] bool operator==(const RadarBlockage&) const = default;
};

/// Another radar transmits into this one: the noise floor rises, and false detections appear.
struct RadarInterference {
  std::uint32_t radar = 0;  ///< 0: all
  double begin_s = 0.0;
  double duration_s = 0.0;
  double noise_rise_db = 0.0;
  double detections_per_scan = 0.0;  ///< mean number of false ones, besides the clutter
  [[nodiscard]] bool operator==(const RadarInterference&) const = default;
};

/// Paths by way of mirrors.
struct MultipathSpec {
  bool on = true;
  std::uint32_t max_bounces = 3;  ///< on anything, the target included: 2 and 3 make ghosts
  bool ground_bounce = true;      ///< fades direct paths by height and adds images below the road
  /// Per mirror bounce, on top of the surface's own: what its unevenness scatters elsewhere. The default gives Report
  /// B's numbers of ghosts in highway_multipath.
  double extra_loss_db = 8.0;
  /// A corner sends waves back to where they came from: 3 dB less at this angle between the ways out and back at the
  /// target, at most 18 dB; 0: as much to everywhere.
  double bistatic_rad = 0.12;
  bool of_stationary = false;  ///< also of what stands; by a standing mirror such a ghost looks as real as a wall
  [[nodiscard]] bool operator==(const MultipathSpec&) const = default;
};

/// What is nearer than this to a stronger echo in all three is one detection with it, at the centroid of all. 0: no
/// cell in that quantity.
struct ResolutionCell {
  double range_m = 0.4;
  double azimuth_rad = 0.035;
  double range_rate_mps = 0.15;
  [[nodiscard]] bool operator==(const ResolutionCell&) const = default;
};

/// Detection probability: 0.5 where the power over that of a 0 dBsm reflector at 10 m equals `threshold_db`, falling
/// with range to the fourth power.
struct SensitivitySpec {
  double threshold_db = -40.0;
  double max_probability = 0.95;
  double rcs_fluctuation_db = 3.0;  ///< standard deviation from scan to scan
  std::uint32_t max_detections = 300;
  [[nodiscard]] bool operator==(const SensitivitySpec&) const = default;
};

/// A radar that a scenario file names, and where it does so: "my.toml:7: radars.knock[0].radar".
struct NamedRadar {
  std::uint32_t id = 0;
  std::string place;
  [[nodiscard]] bool operator==(const NamedRadar& other) const { return id == other.id; }
};

struct RadarEffects {
  double speed_scale = 1.0;                                 ///< k_v: true speed = k_v · signalled speed
  bool noise = true;                                        ///< of measurements, ego signals and RCS
  std::array<Misalignment, kMaxRadars + 1> misalignment{};  ///< by radar id
  std::vector<RadarStepChange> step_changes;
  std::vector<RadarBlockage> blockages;
  std::vector<RadarInterference> interference;
  double clutter_per_scan = 1.5;  ///< mean number
  MultipathSpec multipath{};
  ResolutionCell resolution{};
  SensitivitySpec sensitivity{};
  double unambiguous_mps = 80.0;  ///< range rates fold into ± this; 0: they do not fold
  std::vector<NamedRadar> named;  ///< in the order of the file; for errors, as the vehicle is not known before
  [[nodiscard]] bool operator==(const RadarEffects&) const = default;
};

}  // namespace boresight::simulator
