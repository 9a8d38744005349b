#include "services/simulator/scenario/read_profile.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "services/simulator/scenario/shipped.hpp"

namespace boresight::simulator {

namespace {

using config::Range;
using config::Reader;

constexpr Range kShare{0.0, 1.0};
constexpr Range kObjectDetections{0.0, 100.0};
constexpr Range kStatedRcs_dbsm{-80.0, 80.0};
constexpr Range kStd_db{0.0, 40.0};
constexpr Range kFarRange_m{0.0, 1000.0};
/// A correlation from scan to scan of 1 would never renew a draw.
constexpr Range kCorrelation{0.0, 0.98};

template <std::size_t N>
void read_list(Reader& reader, std::string_view key, Range allowed, std::array<double, N>& values) {
  const std::vector<double> read = reader.numbers(key, N, allowed, {values.begin(), values.end()});
  std::copy_n(read.begin(), N, values.begin());
}

/// A list of N numbers that must increase.
template <std::size_t N>
void read_increasing(Reader& reader, std::string_view key, Range allowed, std::array<double, N>& values) {
  std::array<double, N> read = values;
  read_list(reader, key, allowed, read);
  if (std::adjacent_find(read.begin(), read.end(), std::greater_equal<>()) == read.end()) {
    values = read;
  } else if (reader.has(key)) {
    reader.reject(key, "must increase from number to number");
  }
}

void read_number(Reader& reader, std::string_view key, Range allowed, double& value) {
  value = reader.number(key, allowed, value);
}

radar::PresenceSpec read_presence(Reader r) {
  radar::PresenceSpec s;
  s.on = r.boolean("on", s.on);
  read_increasing(r, "range_m", kFarRange_m, s.range_m);
  read_list(r, "car", kShare, s.car);
  read_list(r, "truck", kShare, s.truck);
  read_list(r, "two_wheeler", kShare, s.two_wheeler);
  read_list(r, "pedestrian", kShare, s.pedestrian);
  read_list(r, "standing_vehicle", kShare, s.standing_vehicle);
  read_number(r, "car_after_none", kCorrelation, s.car_after_none);
  read_number(r, "truck_after_none", kCorrelation, s.truck_after_none);
  read_number(r, "two_wheeler_after_none", kCorrelation, s.two_wheeler_after_none);
  read_number(r, "pedestrian_after_none", kCorrelation, s.pedestrian_after_none);
  read_number(r, "standing_vehicle_after_none", kCorrelation, s.standing_vehicle_after_none);
  return s;
}

radar::CountSpec read_count(Reader r) {
  radar::CountSpec s;
  s.on = r.boolean("on", s.on);
  read_increasing(r, "range_m", kFarRange_m, s.range_m);
  read_list(r, "car", kObjectDetections, s.car);
  read_list(r, "truck", kObjectDetections, s.truck);
  read_list(r, "two_wheeler", kObjectDetections, s.two_wheeler);
  read_list(r, "pedestrian", kObjectDetections, s.pedestrian);
  read_list(r, "standing_vehicle", kObjectDetections, s.standing_vehicle);
  constexpr Range kFactor{0.0, 10.0};
  read_number(r, "rear_factor", kFactor, s.rear_factor);
  read_number(r, "side_factor", kFactor, s.side_factor);
  read_number(r, "front_factor", kFactor, s.front_factor);
  read_number(r, "correlation", kCorrelation, s.correlation);
  s.most = static_cast<std::uint32_t>(r.integer("most", {1, 100}, s.most));
  return s;
}

radar::SpotSpec read_spots(Reader r) {
  radar::SpotSpec s;
  s.on = r.boolean("on", s.on);
  constexpr Range kBehind_m{0.01, 100.0};
  read_number(r, "car_behind_m", kBehind_m, s.car_behind_m);
  read_number(r, "truck_behind_m", kBehind_m, s.truck_behind_m);
  read_number(r, "car_inside_share", {0.0, 0.99}, s.car_inside_share);
  read_number(r, "truck_inside_share", {0.0, 0.99}, s.truck_inside_share);
  read_number(r, "correlation", kCorrelation, s.correlation);
  return s;
}

radar::MicroDopplerSpec read_micro_doppler(Reader r) {
  radar::MicroDopplerSpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "rear", kShare, s.rear);
  read_number(r, "side", kShare, s.side);
  read_number(r, "front", kShare, s.front);
  read_number(r, "pedestrian", kShare, s.pedestrian);
  read_number(r, "two_wheeler", kShare, s.two_wheeler);
  read_number(r, "large_share", kShare, s.large_share);
  read_list(r, "ratio", {-1.0, 0.6}, s.ratio);
  read_number(r, "pedestrian_std_mps", {0.0, 5.0}, s.pedestrian_std_mps);
  return s;
}

void read_quantiles(Reader& r, const std::string& what, radar::StrengthQuantiles& q) {
  read_list(r, what + "_p10_dbsm", kStatedRcs_dbsm, q.low_dbsm);
  read_list(r, what + "_p50_dbsm", kStatedRcs_dbsm, q.median_dbsm);
  read_list(r, what + "_p90_dbsm", kStatedRcs_dbsm, q.high_dbsm);
  for (std::size_t i = 0; i < radar::kStrengthKnots; ++i) {
    if (q.low_dbsm[i] > q.median_dbsm[i] || q.median_dbsm[i] > q.high_dbsm[i]) {
      r.reject(what + "_p50_dbsm", "must lie between " + what + "_p10_dbsm and " + what + "_p90_dbsm at each range");
      return;
    }
  }
}

radar::StrengthSpec read_strength(Reader r) {
  radar::StrengthSpec s;
  s.on = r.boolean("on", s.on);
  read_increasing(r, "range_m", kFarRange_m, s.range_m);
  read_quantiles(r, "vehicle", s.vehicle);
  read_quantiles(r, "false_mover", s.false_mover);
  read_quantiles(r, "stationary", s.stationary);
  read_number(r, "pedestrian_dbsm", kStatedRcs_dbsm, s.pedestrian_dbsm);
  read_number(r, "two_wheeler_dbsm", kStatedRcs_dbsm, s.two_wheeler_dbsm);
  read_number(r, "person_std_db", kStd_db, s.person_std_db);
  read_number(r, "detection_std_db", kStd_db, s.detection_std_db);
  read_number(r, "scan_std_db", kStd_db, s.scan_std_db);
  read_number(r, "object_correlation", kCorrelation, s.object_correlation);
  read_number(r, "radar_offset_db", {0.0, 40.0}, s.radar_offset_db);
  return s;
}

radar::MirrorStrengthSpec read_mirror(Reader r) {
  radar::MirrorStrengthSpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "mirror_strength_db", {-60.0, 20.0}, s.mirror_strength_db);
  read_number(r, "mirror_strength_std_db", kStd_db, s.mirror_strength_std_db);
  return s;
}

radar::FalseMoverSpec read_false_mover(Reader r) {
  constexpr Range kRate{0.0, 200.0};
  radar::FalseMoverSpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "median_per_scan", kRate, s.median_per_scan);
  read_number(r, "p90_per_scan", kRate, s.p90_per_scan);
  read_number(r, "correlation_after_1s", kCorrelation, s.correlation_after_1s);
  read_list(r, "range_m", kFarRange_m, s.range_m);
  read_list(r, "deviation_share", kShare, s.deviation_share);
  read_number(r, "near_zero_share", kShare, s.near_zero_share);
  read_number(r, "lasting_share", kShare, s.lasting_share);
  read_number(r, "lasting_scans", {2.0, 20.0}, s.lasting_scans);
  if (s.p90_per_scan < s.median_per_scan) r.reject("p90_per_scan", "must not be less than median_per_scan");
  return s;
}

radar::DopplerAmbiguitySpec read_doppler_ambiguity(Reader r) {
  constexpr Range kWidth_mps{0.0, 200.0};
  radar::DopplerAmbiguitySpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "stationary_share", kShare, s.stationary_share);
  read_number(r, "moving_share", kShare, s.moving_share);
  read_number(r, "width_min_mps", kWidth_mps, s.width_min_mps);
  s.width_max_mps = std::max(s.width_max_mps, s.width_min_mps);
  read_number(r, "width_max_mps", kWidth_mps, s.width_max_mps);
  if (s.width_max_mps < s.width_min_mps) r.reject("width_max_mps", "must not be less than width_min_mps");
  return s;
}

radar::AzimuthAmbiguitySpec read_azimuth_ambiguity(Reader r) {
  radar::AzimuthAmbiguitySpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "per_scan", {0.0, 100.0}, s.per_scan);
  read_number(r, "sine_step", {0.0, 2.0}, s.sine_step);
  read_number(r, "sine_step_std", {0.0, 1.0}, s.sine_step_std);
  return s;
}

radar::SideLobeSpec read_side_lobe(Reader r) {
  radar::SideLobeSpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "per_object", {0.0, 20.0}, s.per_object);
  s.least_offset_rad = r.angle_deg("least_offset_deg", {0.0, 90.0}, s.least_offset_rad);
  read_number(r, "strength_db", {-60.0, 20.0}, s.strength_db);
  read_number(r, "strength_std_db", kStd_db, s.strength_std_db);
  return s;
}

radar::BurstSpec read_burst(Reader r) {
  constexpr Range kDuration_s{0.0, 60.0};
  radar::BurstSpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "every_s", {1.0, 36000.0}, s.every_s);
  read_number(r, "duration_min_s", kDuration_s, s.duration_min_s);
  s.duration_max_s = std::max(s.duration_max_s, s.duration_min_s);
  read_number(r, "duration_max_s", kDuration_s, s.duration_max_s);
  read_number(r, "per_scan", {0.0, 200.0}, s.per_scan);
  read_number(r, "range_min_m", kFarRange_m, s.range_min_m);
  s.range_max_m = std::max(s.range_max_m, s.range_min_m);
  read_number(r, "range_max_m", kFarRange_m, s.range_max_m);
  read_number(r, "depth_m", {0.0, 100.0}, s.depth_m);
  s.azimuth_width_rad = r.angle_deg("azimuth_width_deg", {0.0, 180.0}, s.azimuth_width_rad);
  read_number(r, "range_rate_std_mps", {0.0, 10.0}, s.range_rate_std_mps);
  if (s.duration_max_s < s.duration_min_s) r.reject("duration_max_s", "must not be less than duration_min_s");
  if (s.duration_max_s > s.every_s) r.reject("every_s", "must not be less than duration_max_s");
  if (s.range_max_m < s.range_min_m) r.reject("range_max_m", "must not be less than range_min_m");
  return s;
}

radar::StationaryWorldSpec read_stationary_world(Reader r) {
  radar::StationaryWorldSpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "reflector_seen", kShare, s.reflector_seen);
  read_list(r, "per_ring", {0.0, 300.0}, s.per_ring);
  read_number(r, "seen_again", kCorrelation, s.seen_again);
  read_number(r, "bright_share", {0.01, 1.0}, s.bright_share);
  read_number(r, "neighbours", {0.0, 20.0}, s.neighbours);
  read_number(r, "patch_std_m", {0.0, 10.0}, s.patch_std_m);
  read_number(r, "path_half_width_m", {0.0, 20.0}, s.path_half_width_m);
  return s;
}

radar::ValiditySpec read_validity(Reader r) {
  radar::ValiditySpec s;
  s.on = r.boolean("on", s.on);
  read_number(r, "valid_real", kShare, s.valid_real);
  read_number(r, "valid_false", kShare, s.valid_false);
  read_number(r, "unambiguous_real", kShare, s.unambiguous_real);
  read_number(r, "unambiguous_false", kShare, s.unambiguous_false);
  read_number(r, "existence_separation", {0.0, 5.0}, s.existence_separation);
  return s;
}

radar::LatencySpec read_latency(Reader r) {
  radar::LatencySpec s;
  read_number(r, "constant_s", {0.0, 1.0}, s.constant_s);
  read_number(r, "per_detection_s", {0.0, 0.01}, s.per_detection_s);
  return s;
}

bool is_profile_file(std::string_view name) {
  return name.find('/') != std::string_view::npos || name.ends_with(".toml");
}

}  // namespace

radar::Profile read_profile(Reader root) {
  radar::Profile p;
  root.require("name");
  p.name = root.text("name", "");
  static_cast<void>(root.text("about", ""));
  p.presence = read_presence(root.table("presence"));
  p.count = read_count(root.table("count"));
  p.spots = read_spots(root.table("spots"));
  p.micro_doppler = read_micro_doppler(root.table("micro_doppler"));
  p.strength = read_strength(root.table("strength"));
  p.mirror = read_mirror(root.table("mirror"));
  p.false_mover = read_false_mover(root.table("false_mover"));
  p.doppler_ambiguity = read_doppler_ambiguity(root.table("doppler_ambiguity"));
  p.azimuth_ambiguity = read_azimuth_ambiguity(root.table("azimuth_ambiguity"));
  p.side_lobe = read_side_lobe(root.table("side_lobe"));
  p.burst = read_burst(root.table("burst"));
  p.stationary_world = read_stationary_world(root.table("stationary_world"));
  p.validity = read_validity(root.table("validity"));
  p.latency = read_latency(root.table("latency"));
  root.finish();
  return p;
}

std::vector<std::string> radar_profile_names() {
  std::vector<std::string> names;
  for (const ShippedFile& shipped : shipped_radar_profiles()) names.emplace_back(shipped.name);
  return names;
}

radar::Profile radar_profile(std::string_view name_or_file) {
  if (is_profile_file(name_or_file)) return read_profile(Reader::open(std::filesystem::path(name_or_file)));
  std::string known;
  for (const ShippedFile& shipped : shipped_radar_profiles()) {
    if (shipped.name == name_or_file) {
      return read_profile(Reader::parse(shipped.text, "config/radar_profiles/" + std::string(shipped.name) + ".toml"));
    }
    known += (known.empty() ? "" : ", ") + std::string(shipped.name);
  }
  throw std::invalid_argument("radar profile \"" + std::string(name_or_file) + "\" is unknown; known: " + known +
                              "; name your own file by its path, such as ./my_radar.toml");
}

void use_profile(Scenario& scenario, std::string_view name_or_file) {
  scenario.effects.profile = radar_profile(name_or_file);
  scenario.effects.profiles.clear();
}

}  // namespace boresight::simulator
