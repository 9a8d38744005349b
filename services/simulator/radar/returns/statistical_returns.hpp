// What a real radar's statistics make of the detected echoes of a scan. The stage stands between detection and
// measurement noise. The physical chain decides what is in sight and which paths exist; this stage decides how often,
// how many, where, how strong, and what is false.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/radar/antenna.hpp"
#include "services/simulator/radar/one_way.hpp"
#include "services/simulator/radar/profile.hpp"
#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/returns/false_movers.hpp"
#include "services/simulator/radar/returns/stationary_field.hpp"
#include "services/simulator/radar/returns/strength.hpp"
#include "services/simulator/radar/round_trip.hpp"
#include "services/simulator/radar/viewpoint.hpp"
#include "services/simulator/radar_effects.hpp"
#include "services/simulator/scene.hpp"

namespace boresight::simulator::radar {

/// A scan as the stage needs it.
struct ScanContext {
  const Scene& scene;
  const Viewpoint& view;
  const Antenna& antenna;  ///< with the dirt of the scan
  const Propagation& propagation;
  std::span<const Dirt> dirt;
  double noise_rise_db;
  Draws draws;
};

class StatisticalReturns {
 public:
  StatisticalReturns(const Profile& profile, const SensitivitySpec& sensitivity, double cycle_time_s);

  [[nodiscard]] bool is_on() const { return profile_.changes_detections(); }
  [[nodiscard]] const Profile& profile() const { return profile_; }

  /// Notes the bodies in sight: those with a direct echo among `echoes`, all of which are of bodies.
  void note_bodies(const Scene& scene, std::span<const Echo> echoes);

  /// States the RCS of an echo of clutter or interference as that of a false mover.
  void restate_noise(const Draws& draws, const FieldOfView& fov, Echo& echo) const;

  /// Replaces the detected echoes of the scan by what the profile makes of them.
  void apply(const ScanContext& context, std::vector<Echo>& echoes);

 private:
  /// A body in sight of this radar.
  struct Sighting {
    const Body* body;
    std::size_t first_echo, echoes;  // in direct_
    bool moving;
    bool present;
    CommonStrength common;
  };
  [[nodiscard]] const Sighting* sighting_of(std::uint32_t object) const;
  void apply_to_objects(const ScanContext& context, std::vector<Echo>& echoes);
  void draw_detections(const ScanContext& context, const Sighting& sighting, std::vector<Echo>& drawn);
  void disturb_rates(const ScanContext& context, std::vector<Echo>& echoes) const;
  void thin_reflectors(const ScanContext& context, std::vector<Echo>& echoes) const;
  void add_field(const ScanContext& context, std::vector<Echo>& drawn);
  void restate_strength(const ScanContext& context, std::vector<Echo>& echoes) const;
  void restate_mirror_images(const ScanContext& context, std::vector<Echo>& echoes) const;
  /// Whether the sensor reports an echo of this stated RCS.
  [[nodiscard]] bool is_reported(const ScanContext& context, const Echo& echo) const;
  void add_side_lobes_of(const ScanContext& context, std::vector<Echo>& echoes) const;
  void append_surviving(const ScanContext& context, std::vector<Echo>& drawn, std::vector<Echo>& echoes) const;

  Profile profile_;
  SensitivitySpec sensitivity_;
  double cycle_time_s_;
  FalseMovers false_movers_;
  StationaryField field_;
  std::vector<Sighting> sightings_;
  std::vector<Echo> direct_, drawn_;
  std::vector<FieldPoint> points_;
};

}  // namespace boresight::simulator::radar
