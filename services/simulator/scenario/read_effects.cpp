#include <exception>
#include <string>
#include <string_view>

#include "interfaces/messages/header.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario/read_real_car.hpp"
#include "services/simulator/scenario/reading.hpp"

namespace boresight::simulator {

namespace {

using config::Range;
using config::Reader;

constexpr Range kTime_s{0.0, 36000.0};
constexpr Range kLoss_db{0.0, 60.0};
constexpr Range kPerScan{0.0, 200.0};

std::uint32_t read_radar(Reader& reader, RadarEffects& effects, bool all_allowed = false) {
  if (!all_allowed) reader.require("radar");
  const auto id = static_cast<std::uint32_t>(reader.integer("radar", {all_allowed ? 0.0 : 1.0, kMaxRadars}, 0));
  effects.named.push_back({id, reader.place("radar")});
  return id;
}

Misalignment read_angles(Reader& reader) {
  constexpr Range kAngle_deg{-15.0, 15.0};
  return {reader.angle_deg("yaw_deg", kAngle_deg, 0.0), reader.angle_deg("pitch_deg", kAngle_deg, 0.0),
          reader.angle_deg("roll_deg", kAngle_deg, 0.0)};
}

RadarBlockage read_blockage(Reader reader, RadarEffects& effects) {
  RadarBlockage b;
  b.radar = read_radar(reader, effects);
  b.begin_s = reader.number("begin_s", kTime_s, b.begin_s);
  b.full_s = reader.number("full_s", kTime_s, b.begin_s);
  b.loss_db = reader.number("loss_db", kLoss_db, b.loss_db);
  constexpr Range kView_deg{-190.0, 190.0};
  b.azimuth_min_rad = reader.angle_deg("azimuth_min_deg", kView_deg, b.azimuth_min_rad);
  b.azimuth_max_rad = reader.angle_deg("azimuth_max_deg", kView_deg, b.azimuth_max_rad);
  if (b.full_s < b.begin_s) reader.reject("full_s", "must not be before begin_s");
  if (b.azimuth_max_rad < b.azimuth_min_rad) reader.reject("azimuth_max_deg", "must not be less than azimuth_min_deg");
  return b;
}

RadarInterference read_interference(Reader reader, RadarEffects& effects) {
  RadarInterference i;
  i.radar = read_radar(reader, effects, true);
  i.begin_s = reader.number("begin_s", kTime_s, i.begin_s);
  i.duration_s = reader.number("duration_s", kTime_s, i.duration_s);
  i.noise_rise_db = reader.number("noise_rise_db", kLoss_db, i.noise_rise_db);
  i.detections_per_scan = reader.number("detections_per_scan", kPerScan, i.detections_per_scan);
  return i;
}

RadarDataFault read_data_fault(Reader reader, RadarEffects& effects) {
  RadarDataFault f;
  f.radar = read_radar(reader, effects, true);
  reader.require("kind");
  f.kind = reader.choice<DataFaultKind>("kind",
                                        {{"few", DataFaultKind::kFew},
                                         {"near", DataFaultKind::kNear},
                                         {"lost", DataFaultKind::kLost},
                                         {"frozen", DataFaultKind::kFrozen},
                                         {"repeated", DataFaultKind::kRepeated},
                                         {"mirrored_azimuth", DataFaultKind::kMirroredAzimuth},
                                         {"random", DataFaultKind::kRandom}},
                                        f.kind);
  f.begin_s = reader.number("begin_s", kTime_s, f.begin_s);
  f.duration_s = reader.number("duration_s", kTime_s, f.duration_s);
  f.detections = static_cast<std::uint32_t>(reader.integer("detections", {0, kMaxDetections}, f.detections));
  f.reach_m = reader.number("reach_m", {0.0, 1000.0}, f.reach_m);
  f.share = reader.number("share", {0.0, 1.0}, f.share);
  return f;
}

MultipathSpec read_multipath(Reader reader) {
  MultipathSpec m;
  m.on = reader.boolean("on", m.on);
  m.max_bounces = static_cast<std::uint32_t>(reader.integer("max_bounces", {1, 3}, m.max_bounces));
  m.ground_bounce = reader.boolean("ground_bounce", m.ground_bounce);
  m.bistatic_rad = reader.angle_deg("bistatic_deg", {0.0, 180.0}, m.bistatic_rad);
  m.of_stationary = reader.boolean("of_stationary", m.of_stationary);
  m.extra_loss_db = reader.number("extra_loss_db", {-30.0, 60.0}, m.extra_loss_db);
  return m;
}

ResolutionCell read_resolution(Reader reader) {
  ResolutionCell c;
  c.range_m = reader.number("range_m", {0.0, 10.0}, c.range_m);
  c.azimuth_rad = reader.angle_deg("azimuth_deg", {0.0, 30.0}, c.azimuth_rad);
  c.range_rate_mps = reader.number("range_rate_mps", {0.0, 10.0}, c.range_rate_mps);
  return c;
}

SensitivitySpec read_sensitivity(Reader reader) {
  SensitivitySpec s;
  s.threshold_db = reader.number("threshold_db", {-120.0, 60.0}, s.threshold_db);
  s.max_probability = reader.number("max_probability", {0.0, 1.0}, s.max_probability);
  s.rcs_fluctuation_db = reader.number("rcs_fluctuation_db", {0.0, 20.0}, s.rcs_fluctuation_db);
  s.max_detections = static_cast<std::uint32_t>(reader.integer("max_detections", {1, 800}, s.max_detections));
  return s;
}

/// The profile that a key names; an error is noted at the key.
radar::Profile read_named_profile(Reader& reader, std::string_view key) {
  const std::string name = reader.text(key, "ideal");
  try {
    return radar_profile(name);
  } catch (const std::exception& error) {
    reader.reject(key, error.what());
    return {};
  }
}

}  // namespace

RadarEffects read_effects(Reader reader) {
  RadarEffects e;
  e.speed_scale = reader.number("speed_scale", {0.9, 1.1}, e.speed_scale);
  e.noise = reader.boolean("noise", e.noise);
  e.clutter_per_scan = reader.number("clutter_per_scan", kPerScan, e.clutter_per_scan);
  e.unambiguous_mps = reader.number("unambiguous_mps", {0.0, 200.0}, e.unambiguous_mps);
  e.profile = read_named_profile(reader, "profile");
  for (Reader& r : reader.tables("profile_of")) {
    const std::uint32_t id = read_radar(r, e);
    r.require("profile");
    e.profiles.push_back({id, read_named_profile(r, "profile")});
  }
  for (Reader& r : reader.tables("misalignment")) {
    const std::uint32_t radar = read_radar(r, e);
    e.misalignment[radar] = read_angles(r);
  }
  for (Reader& r : reader.tables("step_change")) {
    RadarStepChange step_change;
    step_change.radar = read_radar(r, e);
    step_change.time_s = r.number("time_s", kTime_s, 0.0);
    step_change.by = read_angles(r);
    e.step_changes.push_back(step_change);
  }
  for (Reader& r : reader.tables("blockage")) e.blockages.push_back(read_blockage(r, e));
  for (Reader& r : reader.tables("interference")) e.interference.push_back(read_interference(r, e));
  for (Reader& r : reader.tables("data_fault")) e.data_faults.push_back(read_data_fault(r, e));
  e.multipath = read_multipath(reader.table("multipath"));
  e.resolution = read_resolution(reader.table("resolution"));
  e.sensitivity = read_sensitivity(reader.table("sensitivity"));
  e.real_car = read_real_car(reader.table("real_car"));
  return e;
}

}  // namespace boresight::simulator
