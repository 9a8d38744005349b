#include "tests/closed_loop/figures.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "services/boresight/run/chain.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ghost_filter/weights_file.hpp"
#include "services/simulator/judge/hidden.hpp"
#include "services/simulator/judge/track_judge.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::closed_loop {

namespace {

std::vector<judge::ScoredTrack> to_scored(const TrackList& list) {
  std::vector<judge::ScoredTrack> tracks;
  for (std::size_t k = 0; k < list.number_of_confirmed_tracks; ++k) {
    const Track& from = list.tracks[k];
    judge::ScoredTrack& track = tracks.emplace_back();
    track.id = from.tracking_id;
    track.confirmed = true;
    track.movement = from.movement;
    track.position_m = Eigen::Vector2f(from.position_vehicle_m[0], from.position_vehicle_m[1]).cast<double>();
    track.velocity_mps = Eigen::Map<const Eigen::Vector2f>(from.velocity_over_ground_mps.data()).cast<double>();
    track.heading_rad = from.heading_rad;
    track.length_m = from.length_m;
    track.width_m = from.width_m;
    track.position_covariance_m2 =
        Eigen::Map<const Eigen::Matrix<float, kTrackStateSize, kTrackStateSize, Eigen::RowMajor>>(
            from.covariance.data())
            .topLeftCorner<2, 2>()
            .cast<double>();
  }
  return tracks;
}

/// The tracks of one drive beside its objects.
class DriveJudge {
 public:
  void add(const simulator::Drive& drive, const simulator::Event& scan, const TrackList& list) {
    std::vector<Object> boxes = objects_at(drive, scan.t_s);
    last_seen_.mark(scan.t_s, *scan.truth, boxes);
    std::vector<judge::TrueObject> objects;
    for (const Object& box : boxes) {
      judge::TrueObject& object = objects.emplace_back(judge::TrueObject{.box = box});
      object.in_view = !box.is_hidden && box.position_m.norm() <= kFarthest_m;
    }
    const std::vector<judge::ScoredTrack> tracks = to_scored(list);
    for (const judge::ScoredTrack& track : tracks) ids_.insert(track.id);
    drive_.add(scan.t_s, tracks, objects);
    (scan.t_s < kAligned_s ? before_aligned_ : afterwards_).add(scan.t_s, tracks, objects);
  }

  [[nodiscard]] Figures finish() {
    Figures figures;
    for (auto [judge, list] : {std::pair(&drive_, &figures.drive), std::pair(&before_aligned_, &figures.before_aligned),
                               std::pair(&afterwards_, &figures.afterwards)}) {
      judge->finish();
      judge->write(*list);
    }
    figures.ids = ids_.size();
    return figures;
  }

 private:
  judge::TrackJudge drive_, before_aligned_, afterwards_;
  judge::LastSeen last_seen_;
  std::set<std::uint32_t> ids_;
};

}  // namespace

Figures judge_drive(const DriveOfFigures& of) {
  const VehicleConfig vehicle =
      config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
  simulator::Scenario scenario = simulator::scenario(of.scenario);
  simulator::use_profile(scenario, of.profile);
  simulator::Drive drive(scenario, vehicle, of.seed, of.duration_s);
  run::Settings settings;
  settings.ghosts.method = of.method;
  settings.ghosts.evidence.weights = ghosts::read_weights(std::filesystem::path(BORESIGHT_SOURCE_DIR) /
                                                          "config/radar_profiles" / (of.profile + ".toml"));
  run::Chain chain(vehicle, settings);
  DriveJudge judge;
  const auto scan = std::make_unique<RadarScan>();
  while (const simulator::Event* event = drive.next()) {
    chain.advance(event->stamp_ns);
    if (event->scan == nullptr) {
      EgoMotion motion = simulator::to_message(*event, vehicle.ego);
      chain.add_ego(motion, event->stamp_ns);
      continue;
    }
    *scan = *event->scan;
    if (chain.add_scan(*scan, event->stamp_ns)) judge.add(drive, *event, chain.tracks());
  }
  chain.finish();
  return judge.finish();
}

}  // namespace boresight::closed_loop
