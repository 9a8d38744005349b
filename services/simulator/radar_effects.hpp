// The radar settings of a scenario: misalignment, disturbances, propagation, resolution and sensitivity.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "interfaces/messages/header.hpp"
#include "services/simulator/car/real_car.hpp"
#include "services/simulator/radar/profile.hpp"

namespace boresight::simulator {

/// Mounting error of a radar, radians: actual = nominal + these angles.
struct Misalignment {
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  [[nodiscard]] bool operator==(const Misalignment&) const = default;
};

/// A sudden misalignment: from `time_s` on the mounting error has changed by `by`.
struct RadarStepChange {
  std::uint32_t radar = 0;
  double time_s = 0.0;
  Misalignment by{};
  [[nodiscard]] bool operator==(const RadarStepChange&) const = default;
};

/// Dirt, snow or ice on a radar. The two-way loss grows linearly from 0 at `begin_s` to `loss_db` at `full_s`, then it
/// stays constant. The loss applies between the two azimuths (sensor frame); the defaults cover every field of view.
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
  double detections_per_scan = 0.0;  ///< mean number of false detections, in addition to clutter
  [[nodiscard]] bool operator==(const RadarInterference&) const = default;
};

/// Damage to the lists that a radar sends.
enum class DataFaultKind : std::uint8_t {
  kFew,              ///< only the first `detections` of each list
  kNear,             ///< nothing beyond `reach_m`, as behind ice or mud
  kLost,             ///< lists are not sent, with probability `share`
  kFrozen,           ///< the first list again and again, with new counters and stamps
  kRepeated,         ///< each list twice
  kMirroredAzimuth,  ///< the sign of the azimuths is wrong, as of a radar that was mounted upside down
  kRandom,           ///< range, azimuth and range rate at random within the limits of the radar
};

struct RadarDataFault {
  std::uint32_t radar = 0;  ///< 0: all
  DataFaultKind kind = DataFaultKind::kFew;
  double begin_s = 0.0;
  double duration_s = 0.0;
  std::uint32_t detections = 0;
  double reach_m = 8.0;
  double share = 0.8;
  [[nodiscard]] bool operator==(const RadarDataFault&) const = default;
};

/// Propagation paths that include reflections from mirrors.
struct MultipathSpec {
  bool on = true;
  std::uint32_t max_bounces = 3;  ///< reflections of a path, including the one at the target; 2 and 3 make ghosts
  bool ground_bounce = true;      ///< two-ray interference with the road, and paths below an obstacle by the road
  /// Loss per mirror reflection in addition to the surface's own, by scattering from its unevenness. The default is
  /// fitted: with it, highway_multipath has about the numbers of ghosts that Le Ba Thanh 2023 reports.
  double extra_loss_db = 8.0;
  /// A corner reflects mostly back to the transmitter. At this angle between incident and reflected path the echo is
  /// 3 dB weaker; the loss grows to at most 18 dB. 0: no such loss.
  double bistatic_rad = 0.12;
  bool of_stationary =
      false;  ///< ghosts of stationary targets too; behind a stationary mirror they look like real ones
  [[nodiscard]] bool operator==(const MultipathSpec&) const = default;
};

/// An echo that is nearer than this to a stronger echo in all three quantities merges with it into one detection at
/// their centroid. 0: every difference in that quantity is resolved.
struct ResolutionCell {
  double range_m = 0.4;
  double azimuth_rad = 0.035;
  double range_rate_mps = 0.15;
  [[nodiscard]] bool operator==(const ResolutionCell&) const = default;
};

/// The detection probability is half of `max_probability` at a power of `threshold_db` relative to a 0 dBsm reflector
/// at 10 m. The received power falls with the fourth power of range.
struct SensitivitySpec {
  double threshold_db = -40.0;
  double max_probability = 0.95;
  double rcs_fluctuation_db = 3.0;  ///< standard deviation from scan to scan
  std::uint32_t max_detections = 300;
  [[nodiscard]] bool operator==(const SensitivitySpec&) const = default;
};

/// A radar id in a scenario file, and its place there: "my.toml:7: radars.step_change[0].radar".
struct NamedRadar {
  std::uint32_t id = 0;
  std::string place;
  [[nodiscard]] bool operator==(const NamedRadar& other) const { return id == other.id; }
};

/// The profile of one radar that has another than all radars.
struct ProfileOfRadar {
  std::uint32_t id = 0;
  radar::Profile profile{};
  [[nodiscard]] bool operator==(const ProfileOfRadar&) const = default;
};

struct RadarEffects {
  double speed_scale = 1.0;                                 ///< k_v: true speed = k_v · signalled speed
  bool noise = true;                                        ///< noise of measurements, ego signals and RCS
  std::array<Misalignment, kMaxRadars + 1> misalignment{};  ///< by radar id
  std::vector<RadarStepChange> step_changes;
  std::vector<RadarBlockage> blockages;
  std::vector<RadarInterference> interference;
  std::vector<RadarDataFault> data_faults;
  double clutter_per_scan = 1.5;  ///< mean number
  MultipathSpec multipath{};
  ResolutionCell resolution{};
  SensitivitySpec sensitivity{};
  double unambiguous_mps = 80.0;  ///< range rates fold into ± this; 0: no folding
  radar::Profile profile{};       ///< statistics of all radars that `profiles` does not list
  std::vector<ProfileOfRadar> profiles;
  car::RealCar real_car{};
  std::vector<NamedRadar> named;  ///< in the order of the file; for errors, since the vehicle is known only later
  [[nodiscard]] bool operator==(const RadarEffects&) const = default;

  [[nodiscard]] const radar::Profile& profile_of(std::uint32_t id) const {
    for (const ProfileOfRadar& other : profiles) {
      if (other.id == id) return other.profile;
    }
    return profile;
  }
};

}  // namespace boresight::simulator
