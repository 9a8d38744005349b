#include "services/simulator/radar/returns/statistical_returns.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/radar/blockage.hpp"
#include "services/simulator/radar/detector.hpp"
#include "services/simulator/radar/returns/azimuth_ambiguity.hpp"
#include "services/simulator/radar/returns/doppler_ambiguity.hpp"
#include "services/simulator/radar/returns/micro_doppler.hpp"
#include "services/simulator/radar/returns/object_count.hpp"
#include "services/simulator/radar/returns/place.hpp"
#include "services/simulator/radar/returns/presence.hpp"
#include "services/simulator/radar/returns/side_lobes.hpp"
#include "services/simulator/radar/returns/spots.hpp"
#include "services/simulator/radar/returns/strength.hpp"

namespace boresight::simulator::radar {

namespace {

constexpr std::uint64_t kDrawnKey = 0xD2A40;

bool is_of_body(const Echo& echo) {
  return echo.truth.object_id != 0 && is_direct(echo);
}

bool is_reflector(const Echo& echo) {
  return echo.truth.object_id == 0 && echo.truth.provenance == Provenance::kStationary;
}

bool is_ghost(const Echo& echo) {
  return echo.truth.provenance == Provenance::kGhostType1 || echo.truth.provenance == Provenance::kGhostType2;
}

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

/// Velocity of a rigid body at a place.
Eigen::Vector3d velocity_at(const Body& body, const Eigen::Vector3d& place_m) {
  const Eigen::Vector2d offset = place_m.head<2>() - body.position_m;
  const Eigen::Vector2d v = body.velocity_mps + body.yaw_rate_radps * Eigen::Vector2d(-offset.y(), offset.x());
  return {v.x(), v.y(), 0.0};
}

/// Two-way loss in the direction of an echo by dirt, and by a raised noise floor.
double disturbance_db(const ScanContext& context, const Echo& echo) {
  return loss_db(context.dirt, echo.azimuth_rad) + context.noise_rise_db;
}

}  // namespace

StatisticalReturns::StatisticalReturns(const Profile& profile, const SensitivitySpec& sensitivity, double cycle_time_s)
    : profile_(profile),
      sensitivity_(sensitivity),
      cycle_time_s_(cycle_time_s),
      false_movers_(profile.false_mover),
      field_(profile.stationary_world) {}

void StatisticalReturns::note_bodies(const Scene& scene, std::span<const Echo> echoes) {
  sightings_.clear();
  direct_.clear();
  for (const Echo& echo : echoes) {
    if (!is_of_body(echo)) continue;
    if (sightings_.empty() || sightings_.back().body->id != echo.truth.object_id) {
      const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                     [&](const Body& b) { return b.id == echo.truth.object_id; });
      if (body == scene.bodies.end()) continue;
      const bool moving = echo.truth.provenance == Provenance::kMoving;
      sightings_.push_back({&*body, direct_.size(), 0, moving, true, {}});
    }
    direct_.push_back(echo);
    ++sightings_.back().echoes;
  }
}

const StatisticalReturns::Sighting* StatisticalReturns::sighting_of(std::uint32_t object) const {
  const auto found =
      std::find_if(sightings_.begin(), sightings_.end(), [&](const Sighting& s) { return s.body->id == object; });
  return found == sightings_.end() ? nullptr : &*found;
}

void StatisticalReturns::draw_detections(const ScanContext& context, const Sighting& sighting,
                                         std::vector<Echo>& drawn) {
  const Body& body = *sighting.body;
  const Draws& draws = context.draws;
  const FieldOfView& fov = context.antenna.view();
  const ObjectClass object_class = class_of(body.kind, sighting.moving);
  const Eigen::Vector2d sensor = context.view.position_m.head<2>();
  const double range = range_of(body, sensor);
  const double mean = mean_count(profile_.count, object_class, range, aspect_of(body, sensor));
  const unsigned count = count_of(profile_.count, mean, body.id, draws);
  const Eigen::Vector2d sensor_body = turned(sensor - body.position_m, -body.heading_rad);
  for (unsigned i = 0; i < count; ++i) {
    const std::uint64_t key = key_of(kDrawnKey, key_of(body.id, i));
    // Any of its reflection centres in sight is the pattern for what the profile does not state.
    const auto pick =
        static_cast<std::size_t>(draws.once("centre", key).uniform() * static_cast<double>(sighting.echoes));
    Echo e = direct_[sighting.first_echo + pick];
    double rcs = rcs_of(e, fov) + loss_db(context.dirt, e.azimuth_rad);
    if (profile_.spots.on) {
      const Eigen::Vector3d offset = spot_of(profile_.spots, body, sensor_body, i, draws);
      const Eigen::Vector2d place = body.position_m + turned(offset.head<2>(), body.heading_rad);
      const Eigen::Vector3d spot(place.x(), place.y(), offset.z());
      // A place out of view: the detection stays at the reflection centre, which is in view.
      Echo placed = e;
      if (place_echo(context.view, context.antenna, spot, velocity_at(body, spot), placed)) e = placed;
    }
    if (profile_.strength.on) rcs = object_rcs(profile_.strength, body.kind, e.range_m, sighting.common, key, draws);
    set_rcs(e, rcs, fov);
    e.truth = {};
    e.truth.provenance = sighting.moving ? Provenance::kMoving : Provenance::kStationary;
    e.truth.object_id = body.id;
    e.key = key;
    drawn.push_back(e);
  }
}

void StatisticalReturns::apply_to_objects(const ScanContext& context, std::vector<Echo>& echoes) {
  const Eigen::Vector2d sensor = context.view.position_m.head<2>();
  for (Sighting& s : sightings_) {
    const double range = range_of(*s.body, sensor);
    s.present = !profile_.presence.on ||
                is_present(profile_.presence, class_of(s.body->kind, s.moving), range, s.body->id, context.draws);
  }
  std::erase_if(echoes, [&](const Echo& e) {
    if (!is_of_body(e)) return false;
    if (profile_.count.on) return true;
    const Sighting* const s = sighting_of(e.truth.object_id);
    return s != nullptr && !s->present;
  });
  if (!profile_.count.on) return;
  for (const Sighting& s : sightings_) {
    if (s.present) draw_detections(context, s, drawn_);
  }
}

void StatisticalReturns::disturb_rates(const ScanContext& context, std::vector<Echo>& echoes) const {
  const Eigen::Vector2d sensor = context.view.position_m.head<2>();
  for (Echo& e : echoes) {
    if (e.truth.provenance != Provenance::kMoving) continue;
    const Sighting* const s = sighting_of(e.truth.object_id);
    if (s == nullptr) continue;
    const Eigen::Vector3d direction = direction_of(context.view, e);
    const Eigen::Vector3d velocity = velocity_at(*s->body, context.view.position_m + e.range_m * direction);
    Stream stream = context.draws.once("micro-doppler", e.key);
    const MicroDoppler micro = micro_doppler(profile_.micro_doppler, s->body->kind, aspect_of(*s->body, sensor),
                                             direction.dot(velocity), stream);
    e.range_rate_mps = direction.dot(velocity - context.view.velocity_mps) + micro.deviation_mps;
    if (micro.deviates) e.truth.cause = Cause::kMicroDoppler;
  }
}

void StatisticalReturns::thin_reflectors(const ScanContext& context, std::vector<Echo>& echoes) const {
  std::erase_if(echoes, [&](const Echo& e) {
    return is_reflector(e) &&
           context.draws.once("reflector", e.key).uniform() >= profile_.stationary_world.reflector_seen;
  });
}

void StatisticalReturns::add_field(const ScanContext& context, std::vector<Echo>& drawn) {
  field_.look(context.view, context.antenna, context.scene.ego, context.draws, points_);
  for (const FieldPoint& point : points_) {
    Echo e{};
    if (!place_echo(context.view, context.antenna, point.position_m, Eigen::Vector3d::Zero(), e)) continue;
    if (!context.propagation.clear(point.position_m)) continue;
    set_rcs(e, stationary_rcs(profile_.strength, e.range_m, point.strength, point.key, context.draws),
            context.antenna.view());
    e.truth.provenance = Provenance::kStationary;
    e.key = point.key;
    drawn.push_back(e);
  }
}

void StatisticalReturns::restate_strength(const ScanContext& context, std::vector<Echo>& echoes) const {
  const Draws& draws = context.draws;
  for (Echo& e : echoes) {
    double rcs = 0.0;
    if (is_reflector(e)) {
      const double place = draws.always("rcs of place", e.key).gaussian();
      rcs = stationary_rcs(profile_.strength, e.range_m, place, e.key, draws);
    } else if (const Sighting* const s = is_of_body(e) ? sighting_of(e.truth.object_id) : nullptr; s != nullptr) {
      rcs = object_rcs(profile_.strength, s->body->kind, e.range_m, s->common, e.key, draws);
    } else {
      continue;
    }
    set_rcs(e, rcs, context.antenna.view());
    e.power_db -= disturbance_db(context, e);
  }
}

void StatisticalReturns::append_surviving(const ScanContext& context, std::vector<Echo>& drawn,
                                          std::vector<Echo>& echoes) const {
  constexpr double kLeast = 1e-9;  // probability
  for (Echo& e : drawn) {
    const double loss = disturbance_db(context, e);
    if (loss > 0.0) {
      const double clear = std::max(kLeast, detection_probability(e.power_db, sensitivity_));
      e.power_db -= loss;
      const double share = detection_probability(e.power_db, sensitivity_) / clear;
      if (context.draws.once("loss", e.key).uniform() >= share) continue;
    }
    echoes.push_back(e);
  }
  drawn.clear();
}

bool StatisticalReturns::is_reported(const ScanContext& context, const Echo& echo) const {
  if (!profile_.strength.on) return true;
  const double excess_db = rcs_of(echo, context.antenna.view()) - sensitivity_dbsm(profile_.strength, echo.range_m);
  return context.draws.once("reported", echo.key).uniform() <
         steady_detection_probability(excess_db + kHalfDetected_db);
}

void StatisticalReturns::restate_mirror_images(const ScanContext& context, std::vector<Echo>& echoes) const {
  const FieldOfView& fov = context.antenna.view();
  const MirrorStrengthSpec& spec = profile_.mirror;
  const auto is_image = [](const Echo& e) { return is_ghost(e) && e.truth.object_id != 0; };
  std::erase_if(echoes, [&](const Echo& e) {
    return is_image(e) && context.draws.once("mirror works", e.key).uniform() >= spec.working_share;
  });
  for (Echo& e : echoes) {
    if (!is_image(e)) continue;
    const auto body = std::find_if(context.scene.bodies.begin(), context.scene.bodies.end(),
                                   [&](const Body& b) { return b.id == e.truth.object_id; });
    if (body == context.scene.bodies.end()) continue;
    // A mirror image shows the object from another side, so it does not fluctuate with the object's own detections.
    const double level = strongest_level_dbsm(profile_.strength, body->kind, e.range_m);
    Stream stream = context.draws.once("mirror strength", e.key);
    set_rcs(e, level + spec.mirror_strength_db + spec.mirror_strength_std_db * stream.gaussian(), fov);
  }
  std::erase_if(echoes, [&](const Echo& e) { return is_image(e) && !is_reported(context, e); });
}

void StatisticalReturns::add_side_lobes_of(const ScanContext& context, std::vector<Echo>& echoes) const {
  const FieldOfView& fov = context.antenna.view();
  const std::size_t parents = echoes.size();
  for (const Sighting& s : sightings_) {
    if (!s.moving) continue;
    std::size_t strongest = parents;
    for (std::size_t i = 0; i < parents; ++i) {
      if (!is_of_body(echoes[i]) || echoes[i].truth.object_id != s.body->id) continue;
      if (strongest == parents || rcs_of(echoes[i], fov) > rcs_of(echoes[strongest], fov)) strongest = i;
    }
    if (strongest == parents) continue;
    const Echo parent = echoes[strongest];
    add_side_lobes(profile_.side_lobe, parent, context.draws, fov, echoes);
  }
  const auto first = echoes.begin() + static_cast<std::ptrdiff_t>(parents);
  echoes.erase(std::remove_if(first, echoes.end(), [&](const Echo& e) { return !is_reported(context, e); }),
               echoes.end());
}

void StatisticalReturns::restate_noise(const Draws& draws, const FieldOfView& fov, Echo& echo) const {
  if (!profile_.strength.on) return;
  Stream stream = draws.once("rcs of noise", echo.key);
  set_rcs(echo, false_rcs(profile_.strength, echo.range_m, stream), fov);
}

void StatisticalReturns::apply(const ScanContext& context, std::vector<Echo>& echoes) {
  const Profile& p = profile_;
  const FieldOfView& fov = context.antenna.view();
  const double t_s = context.scene.t_s;
  drawn_.clear();
  if (p.strength.on) {
    for (Sighting& s : sightings_) s.common = common_strength(p.strength, s.body->id, context.draws);
  }
  // What is real.
  if (p.presence.on || p.count.on) apply_to_objects(context, echoes);
  if (p.stationary_world.on) thin_reflectors(context, echoes);
  if (p.strength.on) restate_strength(context, echoes);
  if (p.stationary_world.on) add_field(context, drawn_);
  append_surviving(context, drawn_, echoes);
  if (p.micro_doppler.on) disturb_rates(context, echoes);
  // What follows from it.
  if (p.mirror.on) restate_mirror_images(context, echoes);
  if (p.side_lobe.on) add_side_lobes_of(context, echoes);
  if (p.azimuth_ambiguity.on) add_ambiguous_azimuths(p.azimuth_ambiguity, context.draws, fov, p.strength, echoes);
  if (p.doppler_ambiguity.on) shift_range_rates(p.doppler_ambiguity, context.draws, echoes);
  // What is false without a cause in the scene.
  if (p.false_mover.on) {
    false_movers_.add(t_s, cycle_time_s_, context.draws, context.view, context.scene.ego.heading_rad, fov, p.strength,
                      drawn_);
  }
  if (p.burst.on) add_bursts(p.burst, t_s, context.draws, fov, p.strength, drawn_);
  append_surviving(context, drawn_, echoes);
}

}  // namespace boresight::simulator::radar
