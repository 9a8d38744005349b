#include "services/simulator/truth_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>

#include "interfaces/messages/service_status.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/simulator/car/truth.hpp"
#include "services/simulator/judge/truth_files.hpp"
#include "services/simulator/radar/blockage.hpp"
#include "services/simulator/radar/false_echoes.hpp"
#include "services/simulator/radar/mounting.hpp"

namespace boresight::simulator {

namespace {

constexpr double kObjectReach_m = 150.0;

const char* name_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::kCar:
      return "car";
    case BodyKind::kVan:
      return "van";
    case BodyKind::kTruck:
      return "truck";
    case BodyKind::kPedestrian:
      return "pedestrian";
    case BodyKind::kCyclist:
      return "cyclist";
  }
  return "unknown";
}

const char* name_of_condition(std::uint32_t condition) {
  if ((condition & source_condition::kBlocked) != 0) return "blocked";
  return (condition & source_condition::kPartlyBlocked) != 0 ? "partly_blocked" : "clear";
}

/// Source of the detection: its place in the scenario file, or the radar profile's field of weak reflectors.
std::string name_of(const DetectionTruth& truth) {
  if (truth.object_id != 0) return "body";
  switch (truth.origin.kind) {
    case Origin::Kind::kStructure:
      return "structure[" + std::to_string(truth.origin.index) + "]";
    case Origin::Kind::kScatter:
      return "scatter[" + std::to_string(truth.origin.index) + "]";
    case Origin::Kind::kNone:
      break;
  }
  return truth.provenance == Provenance::kStationary ? "field" : "none";
}

struct View {
  double max_db = 0.0;   // largest two-way loss over the azimuths of the field of view
  double mean_db = 0.0;  // mean two-way loss over these azimuths
};

View dirt_over(const FieldOfView& view, std::span<const radar::Dirt> dirt) {
  constexpr int kSamples = 64;
  View over;
  for (int i = 0; i < kSamples; ++i) {
    const double part = (i + 0.5) / kSamples;
    const double loss =
        radar::loss_db(dirt, view.azimuth_min_rad + part * (view.azimuth_max_rad - view.azimuth_min_rad));
    over.max_db = std::max(over.max_db, loss);
    over.mean_db += loss / kSamples;
  }
  return over;
}

struct Counts {
  std::array<unsigned, kNumberOfProvenances> of{};
  [[nodiscard]] unsigned operator[](Provenance p) const { return of[static_cast<std::size_t>(p)]; }
  [[nodiscard]] unsigned sum() const {
    unsigned n = 0;
    for (const unsigned c : of) n += c;
    return n;
  }
};

/// Number of detections by provenance, of those that `wanted` accepts.
template <typename Wanted>
Counts count(const std::vector<DetectionTruth>& truth, const Wanted& wanted) {
  Counts counts;
  for (const DetectionTruth& t : truth) counts.of[static_cast<std::size_t>(t.provenance)] += wanted(t) ? 1 : 0;
  return counts;
}

void write_rows(const std::vector<car::TruthRow>& rows, std::FILE* out) {
  for (const car::TruthRow& row : rows) {
    const std::string radar = row.radar ? std::to_string(*row.radar) : "";
    std::fprintf(out, "%s,%s,%.8f,%s\n", row.quantity.c_str(), radar.c_str(), row.value, row.unit);
  }
}

unsigned long long scan_number(const Event& event) {
  return event.scan->header.source_sequence;
}

}  // namespace

TruthTables::TruthTables(const std::filesystem::path& folder, const Scenario& scenario, const VehicleConfig& vehicle,
                         std::uint64_t seed)
    : effects_(scenario.effects),
      seed_(seed),
      folder_(folder),
      detections_(folder / "truth_detections.csv"),
      objects_(folder / "truth_objects.csv"),
      sensors_(folder / "truth_sensors.csv"),
      visibility_(folder / "truth_visibility.csv") {
  for (const RadarConfig& radar : vehicle.radars) {
    const car::RadarOfCar of_car = car::radar_of_car(effects_.real_car, seed, radar.id, radar.field_of_view);
    RadarConfig real = radar;
    real.mounting_pose = of_car.true_position(radar.mounting_pose);
    radars_.push_back({&radar, of_car, Sight(real, effects_, ego_body(scenario.ego))});
  }
  std::fputs("t_s,radar,scan,index,provenance,object,bounces,mirror,source,cause\n", detections_.get());
  std::fputs(
      "t_s,object,x_vehicle_m,y_vehicle_m,heading_rad,vx_over_ground_mps,vy_over_ground_mps,length_m,width_m,"
      "height_m,kind,parked\n",
      objects_.get());
  std::fputs(
      "t_s,radar,scan,alignment_yaw_deg,alignment_pitch_deg,alignment_roll_deg,step_changes,blockage_max_db,"
      "blockage_mean_db,stated,noise_rise_db,interference_per_scan,detections,dropped,moving,stationary,ghost_type_1,"
      "ghost_type_2,clutter\n",
      sensors_.get());
  std::fputs("t_s,radar,scan,object,state,centres,in_view,seen,direct,ghost_type_1,ghost_type_2\n", visibility_.get());
}

void TruthTables::add_objects(const Drive& drive, double t_s) {
  const EgoState ego = drive.ego(t_s);
  const double c = std::cos(ego.heading_rad), s = std::sin(ego.heading_rad);
  Eigen::Matrix2d to_vehicle;
  to_vehicle << c, s, -s, c;
  for (std::size_t i = 0; i < drive.world().number_of_bodies(); ++i) {
    const Body b = drive.world().body(i, t_s);
    const Eigen::Vector2d position = to_vehicle * (b.position_m - ego.position_m);
    if (position.norm() > kObjectReach_m) continue;
    const Eigen::Vector2d velocity = to_vehicle * b.velocity_mps;
    std::fprintf(objects_.get(), "%.4f,%u,%.3f,%.3f,%.5f,%.3f,%.3f,%.2f,%.2f,%.2f,%s,%d\n", t_s, b.id, position.x(),
                 position.y(), std::remainder(b.heading_rad - ego.heading_rad, 2.0 * M_PI), velocity.x(), velocity.y(),
                 b.length_m, b.width_m, b.height_m, name_of(b.kind), b.parked ? 1 : 0);
  }
}

void TruthTables::add_detections(const Event& event) {
  for (std::size_t i = 0; i < event.truth->size(); ++i) {
    const DetectionTruth& truth = (*event.truth)[i];
    std::fprintf(detections_.get(), "%.6f,%u,%llu,%zu,%s,%u,%u,%u,%s,%s\n", event.t_s, event.scan->header.source_id,
                 scan_number(event), i, judge::table_word(truth.provenance).data(), truth.object_id, truth.bounces,
                 truth.mirror_body, name_of(truth).c_str(), cause_word(truth.cause).data());
  }
}

void TruthTables::add_sensor(const Event& event, const RadarConfig& radar) {
  const Misalignment m = radar::misalignment_at(effects_, radar.id, event.t_s);
  const auto step_changes =
      std::count_if(effects_.step_changes.begin(), effects_.step_changes.end(),
                    [&](const RadarStepChange& k) { return k.radar == radar.id && k.time_s <= event.t_s; });
  std::vector<radar::Dirt> dirt;
  radar::dirt_at(effects_.blockages, radar.id, event.t_s, dirt);
  const View loss = dirt_over(radar.field_of_view, dirt);
  const radar::Disturbance other = radar::disturbance_at(effects_.interference, radar.id, event.t_s);
  const Counts n = count(*event.truth, [](const DetectionTruth&) { return true; });
  std::fprintf(sensors_.get(), "%.6f,%u,%llu,%.6f,%.6f,%.6f,%td,%.3f,%.3f,%s,%.3f,%.3f,%u,%u,%u,%u,%u,%u,%u\n",
               event.t_s, radar.id, scan_number(event), m.yaw_rad * kDegreesPerRadian, m.pitch_rad * kDegreesPerRadian,
               m.roll_rad * kDegreesPerRadian, step_changes, loss.max_db, loss.mean_db,
               name_of_condition(event.condition), other.noise_rise_db, other.detections_per_scan, n.sum(),
               event.scan->dropped_detections, n[Provenance::kMoving], n[Provenance::kStationary],
               n[Provenance::kGhostType1], n[Provenance::kGhostType2], n[Provenance::kClutter]);
}

void TruthTables::add_visibility(const Drive& drive, const Event& event, Radar& radar) {
  radar.sight.look(drive.scene(), sights_);
  // A body that is detected only by a mirror or below an obstacle need not be in view.
  for (const DetectionTruth& truth : *event.truth) {
    const auto is_it = [&](const BodySight& s) { return s.body_id == truth.object_id; };
    if (truth.object_id == 0 || std::any_of(sights_.begin(), sights_.end(), is_it)) continue;
    for (const Body& body : drive.scene().bodies) {
      if (body.id == truth.object_id) sights_.push_back({body.id, body.number_of_centres, 0, 0});
    }
  }
  for (const BodySight& s : sights_) {
    const Counts n = count(*event.truth, [&](const DetectionTruth& t) { return t.object_id == s.body_id; });
    const char* const state = s.seen > 0 ? "seen" : s.in_view > 0 ? "occluded" : "outside";
    std::fprintf(visibility_.get(), "%.6f,%u,%llu,%u,%s,%u,%u,%u,%u,%u,%u\n", event.t_s, radar.config->id,
                 scan_number(event), s.body_id, state, s.centres, s.in_view, s.seen,
                 n[Provenance::kMoving] + n[Provenance::kStationary], n[Provenance::kGhostType1],
                 n[Provenance::kGhostType2]);
  }
}

void TruthTables::add_scan(const Drive& drive, const Event& event) {
  for (Radar& radar : radars_) {
    if (radar.config->id != event.scan->header.source_id) continue;
    ++radar.scans;
    add_detections(event);
    add_sensor(event, *radar.config);
    add_visibility(drive, event, radar);
  }
}

void TruthTables::finish() {
  for (const TextFile* file : {&detections_, &objects_, &sensors_, &visibility_}) file->finish();
  const TextFile out(folder_ / "truth.csv");
  std::fprintf(out.get(), "quantity,radar,value,unit\nseed,,%llu,1\nspeed_scale,,%.6f,1\n",
               static_cast<unsigned long long>(seed_), effects_.speed_scale);
  write_rows(car::truth_of_car(effects_.real_car), out.get());
  for (const Radar& radar : radars_) {
    const std::uint32_t id = radar.config->id;
    const Misalignment& m = effects_.misalignment[id];
    std::fprintf(out.get(), "alignment_yaw,%u,%.6f,deg\nalignment_pitch,%u,%.6f,deg\nalignment_roll,%u,%.6f,deg\n", id,
                 m.yaw_rad * kDegreesPerRadian, id, m.pitch_rad * kDegreesPerRadian, id,
                 m.roll_rad * kDegreesPerRadian);
    std::fprintf(out.get(), "scans,%u,%zu,1\n", id, radar.scans);
    write_rows(car::truth_of_radar(effects_.real_car, radar.of_car, id), out.get());
  }
  out.finish();
}

}  // namespace boresight::simulator
