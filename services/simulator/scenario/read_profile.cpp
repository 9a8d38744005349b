#include "services/simulator/scenario/read_profile.hpp"

#include <filesystem>
#include <stdexcept>
#include <tuple>

#include "services/simulator/scenario/shipped.hpp"
#include "services/simulator/scenario/table_keys.hpp"

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

/// Three lists: RCS at the quantiles 10, 50 and 90 %, by range.
template <typename Spec>
struct Quantiles {
  std::string_view name;
  radar::StrengthQuantiles Spec::*member;
};
template <typename Spec>
Quantiles(std::string_view, radar::StrengthQuantiles Spec::*) -> Quantiles<Spec>;

template <typename Spec>
void read_key(Reader& r, Spec& s, const Quantiles<Spec>& key) {
  const std::string what(key.name);
  radar::StrengthQuantiles& q = s.*key.member;
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

void read_table(Reader table, radar::PresenceSpec& spec) {
  using S = radar::PresenceSpec;
  read_keys(table, spec,
            std::tuple{
                Increasing{"range_m", &S::range_m, kFarRange_m},
                Key{"car", &S::car, kShare},
                Key{"truck", &S::truck, kShare},
                Key{"two_wheeler", &S::two_wheeler, kShare},
                Key{"pedestrian", &S::pedestrian, kShare},
                Key{"standing_vehicle", &S::standing_vehicle, kShare},
                Key{"standing_truck", &S::standing_truck, kShare},
                Key{"car_after_none", &S::car_after_none, kCorrelation},
                Key{"truck_after_none", &S::truck_after_none, kCorrelation},
                Key{"two_wheeler_after_none", &S::two_wheeler_after_none, kCorrelation},
                Key{"pedestrian_after_none", &S::pedestrian_after_none, kCorrelation},
                Key{"standing_vehicle_after_none", &S::standing_vehicle_after_none, kCorrelation},
                Key{"standing_truck_after_none", &S::standing_truck_after_none, kCorrelation},
            });
}

void read_table(Reader table, radar::CountSpec& spec) {
  using S = radar::CountSpec;
  constexpr Range kFactor{0.0, 10.0};
  read_keys(table, spec,
            std::tuple{
                Increasing{"range_m", &S::range_m, kFarRange_m},
                Key{"car", &S::car, kObjectDetections},
                Key{"truck", &S::truck, kObjectDetections},
                Key{"two_wheeler", &S::two_wheeler, kObjectDetections},
                Key{"pedestrian", &S::pedestrian, kObjectDetections},
                Key{"standing_vehicle", &S::standing_vehicle, kObjectDetections},
                Key{"standing_truck", &S::standing_truck, kObjectDetections},
                Key{"rear_factor", &S::rear_factor, kFactor},
                Key{"side_factor", &S::side_factor, kFactor},
                Key{"front_factor", &S::front_factor, kFactor},
                Key{"correlation", &S::correlation, kCorrelation},
                Key{"most", &S::most, {1, 100}},
            });
}

void read_table(Reader table, radar::SpotSpec& spec) {
  using S = radar::SpotSpec;
  constexpr Range kBehind_m{0.01, 100.0};
  read_keys(table, spec,
            std::tuple{
                Key{"car_behind_m", &S::car_behind_m, kBehind_m},
                Key{"truck_behind_m", &S::truck_behind_m, kBehind_m},
                Key{"car_inside_share", &S::car_inside_share, {0.0, 0.99}},
                Key{"truck_inside_share", &S::truck_inside_share, {0.0, 0.99}},
                Key{"correlation", &S::correlation, kCorrelation},
            });
}

void read_table(Reader table, radar::MicroDopplerSpec& spec) {
  using S = radar::MicroDopplerSpec;
  read_keys(table, spec,
            std::tuple{
                Key{"rear", &S::rear, kShare},
                Key{"side", &S::side, kShare},
                Key{"front", &S::front, kShare},
                Key{"pedestrian", &S::pedestrian, kShare},
                Key{"two_wheeler", &S::two_wheeler, kShare},
                Key{"large_share", &S::large_share, kShare},
                Key{"ratio", &S::ratio, {-1.0, 0.6}},
                Key{"pedestrian_std_mps", &S::pedestrian_std_mps, {0.0, 5.0}},
            });
}

void read_table(Reader table, radar::StrengthSpec& spec) {
  using S = radar::StrengthSpec;
  read_keys(table, spec,
            std::tuple{
                Increasing{"range_m", &S::range_m, kFarRange_m},
                Quantiles{"vehicle", &S::vehicle},
                Quantiles{"false_mover", &S::false_mover},
                Quantiles{"stationary", &S::stationary},
                Key{"pedestrian_dbsm", &S::pedestrian_dbsm, kStatedRcs_dbsm},
                Key{"two_wheeler_dbsm", &S::two_wheeler_dbsm, kStatedRcs_dbsm},
                Key{"person_std_db", &S::person_std_db, kStd_db},
                Key{"detection_std_db", &S::detection_std_db, kStd_db},
                Key{"detection_correlation", &S::detection_correlation, kCorrelation},
                Key{"scan_std_db", &S::scan_std_db, kStd_db},
                Key{"object_correlation", &S::object_correlation, kCorrelation},
                Key{"radar_offset_db", &S::radar_offset_db, {0.0, 40.0}},
            });
}

void read_table(Reader table, radar::MirrorStrengthSpec& spec) {
  using S = radar::MirrorStrengthSpec;
  read_keys(table, spec,
            std::tuple{
                Key{"mirror_strength_db", &S::mirror_strength_db, {-60.0, 20.0}},
                Key{"mirror_strength_std_db", &S::mirror_strength_std_db, kStd_db},
                Key{"working_share", &S::working_share, kShare},
            });
}

void read_table(Reader table, radar::FalseMoverSpec& spec) {
  using S = radar::FalseMoverSpec;
  constexpr Range kRate{0.0, 200.0};
  read_keys(table, spec,
            std::tuple{
                Key{"median_per_scan", &S::median_per_scan, kRate},
                Key{"p90_per_scan", &S::p90_per_scan, kRate},
                Key{"correlation_after_1s", &S::correlation_after_1s, kCorrelation},
                Key{"abeam_factor", &S::abeam_factor, kShare},
                Key{"range_m", &S::range_m, kFarRange_m},
                Key{"deviation_share", &S::deviation_share, kShare},
                Key{"near_zero_share", &S::near_zero_share, kShare},
                Key{"lasting_share", &S::lasting_share, kShare},
                Key{"lasting_scans", &S::lasting_scans, {2.0, 20.0}},
                NotLess{"p90_per_scan", &S::p90_per_scan, "median_per_scan", &S::median_per_scan},
            });
}

void read_table(Reader table, radar::DopplerAmbiguitySpec& spec) {
  using S = radar::DopplerAmbiguitySpec;
  constexpr Range kWidth_mps{0.0, 200.0};
  read_keys(table, spec,
            std::tuple{
                Key{"stationary_share", &S::stationary_share, kShare},
                Key{"moving_share", &S::moving_share, kShare},
                Key{"width_min_mps", &S::width_min_mps, kWidth_mps},
                UpperEnd{"width_max_mps", &S::width_max_mps, kWidth_mps, &S::width_min_mps},
                NotLess{"width_max_mps", &S::width_max_mps, "width_min_mps", &S::width_min_mps},
            });
}

void read_table(Reader table, radar::AzimuthAmbiguitySpec& spec) {
  using S = radar::AzimuthAmbiguitySpec;
  read_keys(table, spec,
            std::tuple{
                Key{"per_scan", &S::per_scan, {0.0, 100.0}},
                Key{"sine_step", &S::sine_step, {0.0, 2.0}},
                Key{"sine_step_std", &S::sine_step_std, {0.0, 1.0}},
            });
}

void read_table(Reader table, radar::SideLobeSpec& spec) {
  using S = radar::SideLobeSpec;
  read_keys(table, spec,
            std::tuple{
                Key{"per_object", &S::per_object, {0.0, 20.0}},
                Angle{"least_offset_deg", &S::least_offset_rad, {0.0, 90.0}},
                Key{"strength_db", &S::strength_db, {-60.0, 20.0}},
                Key{"strength_std_db", &S::strength_std_db, kStd_db},
            });
}

void read_table(Reader table, radar::BurstSpec& spec) {
  using S = radar::BurstSpec;
  constexpr Range kDuration_s{0.0, 60.0};
  read_keys(table, spec,
            std::tuple{
                Key{"every_s", &S::every_s, {1.0, 36000.0}},
                Key{"duration_min_s", &S::duration_min_s, kDuration_s},
                UpperEnd{"duration_max_s", &S::duration_max_s, kDuration_s, &S::duration_min_s},
                Key{"per_scan", &S::per_scan, {0.0, 200.0}},
                Key{"range_min_m", &S::range_min_m, kFarRange_m},
                UpperEnd{"range_max_m", &S::range_max_m, kFarRange_m, &S::range_min_m},
                Key{"depth_m", &S::depth_m, {0.0, 100.0}},
                Angle{"azimuth_width_deg", &S::azimuth_width_rad, {0.0, 180.0}},
                Key{"range_rate_std_mps", &S::range_rate_std_mps, {0.0, 10.0}},
                NotLess{"duration_max_s", &S::duration_max_s, "duration_min_s", &S::duration_min_s},
                NotLess{"every_s", &S::every_s, "duration_max_s", &S::duration_max_s},
                NotLess{"range_max_m", &S::range_max_m, "range_min_m", &S::range_min_m},
            });
}

void read_table(Reader table, radar::StationaryWorldSpec& spec) {
  using S = radar::StationaryWorldSpec;
  read_keys(table, spec,
            std::tuple{
                Key{"reflector_seen", &S::reflector_seen, kShare},
                Key{"per_ring", &S::per_ring, {0.0, 300.0}},
                Key{"seen_again", &S::seen_again, kCorrelation},
                Key{"bright_share", &S::bright_share, {0.01, 1.0}},
                Key{"neighbours", &S::neighbours, {0.0, 20.0}},
                Key{"patch_std_m", &S::patch_std_m, {0.0, 10.0}},
                Key{"path_half_width_m", &S::path_half_width_m, {0.0, 20.0}},
            });
}

void read_table(Reader table, radar::ValiditySpec& spec) {
  using S = radar::ValiditySpec;
  read_keys(table, spec,
            std::tuple{
                Key{"valid_real", &S::valid_real, kShare},
                Key{"valid_false", &S::valid_false, kShare},
                Key{"unambiguous_real", &S::unambiguous_real, kShare},
                Key{"unambiguous_false", &S::unambiguous_false, kShare},
                Key{"existence_separation", &S::existence_separation, {0.0, 5.0}},
            });
}

void read_table(Reader table, radar::LatencySpec& spec) {
  using S = radar::LatencySpec;
  read_keys(table, spec,
            std::tuple{
                Key{"constant_s", &S::constant_s, {0.0, 1.0}},
                Key{"per_detection_s", &S::per_detection_s, {0.0, 0.01}},
            });
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
  read_table(root.table("presence"), p.presence);
  read_table(root.table("count"), p.count);
  read_table(root.table("spots"), p.spots);
  read_table(root.table("micro_doppler"), p.micro_doppler);
  read_table(root.table("strength"), p.strength);
  read_table(root.table("mirror"), p.mirror);
  read_table(root.table("false_mover"), p.false_mover);
  read_table(root.table("doppler_ambiguity"), p.doppler_ambiguity);
  read_table(root.table("azimuth_ambiguity"), p.azimuth_ambiguity);
  read_table(root.table("side_lobe"), p.side_lobe);
  read_table(root.table("burst"), p.burst);
  read_table(root.table("stationary_world"), p.stationary_world);
  read_table(root.table("validity"), p.validity);
  read_table(root.table("latency"), p.latency);
  root.skip("evidence");  // the ghost filter's
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
