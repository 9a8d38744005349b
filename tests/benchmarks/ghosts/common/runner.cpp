#include "tests/benchmarks/ghosts/common/runner.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/common/statistics.hpp"
#include "tests/closed_loop/chain.hpp"
#include "tests/closed_loop/objects.hpp"
#include "tests/simulator/scenario_file.hpp"

namespace boresight::bench {

namespace {

using closed_loop::Chain;
using closed_loop::Object;

/// A track this near to an object's box is that object's; ghosts this near to a track made it.
constexpr double kNear_m = 3.0;
constexpr std::size_t kLong_scans = 5;
constexpr std::size_t kEnough = 10;  // detections of an object in a second, for a verdict

bool is_ghost(Provenance p) {
  return p == Provenance::kGhostType1 || p == Provenance::kGhostType2;
}

/// Counts the scans of confirmed tracks that live on ghosts.
class GhostTracks {
 public:
  void add(const Chain& chain, const std::vector<simulator::DetectionTruth>& truth,
           const std::vector<Object>& objects) {
    const TrackList& tracks = *chain.tracks;
    for (std::size_t k = 0; k < tracks.number_of_confirmed_tracks; ++k) {
      const Track& track = tracks.tracks[k];
      if (track.number_of_detections == 0) continue;
      const Eigen::Vector2d place(track.position_vehicle_m[0], track.position_vehicle_m[1]);
      if (std::any_of(objects.begin(), objects.end(), [&](const Object& o) { return o.distance_m(place) < kNear_m; })) {
        continue;
      }
      if (mostly_ghosts(*chain.classified, truth, place)) ++scans_[track.tracking_id];
    }
  }
  void write(Outcome& out) const {
    for (const auto& [id, scans] : scans_) {
      out.long_ghost_tracks += scans > kLong_scans ? 1 : 0;
      out.longest_ghost_track_scans = std::max(out.longest_ghost_track_scans, scans);
    }
  }

 private:
  static bool mostly_ghosts(const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth,
                            const Eigen::Vector2d& place) {
    std::size_t ghosts = 0, others = 0;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      // What the tracker never got made no track.
      if (scan.provenance[i] != Provenance::kMoving) continue;
      if ((Eigen::Vector2d(scan.x_vehicle_m[i], scan.y_vehicle_m[i]) - place).norm() > kNear_m) continue;
      ++(is_ghost(truth[i].provenance) ? ghosts : others);
    }
    return ghosts > others;
  }
  std::map<std::uint32_t, std::size_t> scans_;
};

/// Looks for objects that the filter takes away, second by second.
class LostObjects {
 public:
  void add(const Chain& chain, const std::vector<simulator::DetectionTruth>& truth,
           const std::vector<Object>& objects) {
    const ClassifiedScan& scan = *chain.classified;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      const bool moves = (scan.detection_flags[i] & corrected_flag::kMoving) != 0 &&
                         (scan.detection_flags[i] & corrected_flag::kRejected) == 0;
      if (truth[i].provenance != Provenance::kMoving || !moves) continue;
      Second& second = seconds_[truth[i].object_id];
      ++second.detections;
      second.taken_away += scan.provenance[i] != Provenance::kMoving ? 1 : 0;
    }
    const TrackList& tracks = *chain.tracks;
    for (const Object& object : objects) {
      const auto found = seconds_.find(object.id);
      if (found == seconds_.end()) continue;
      ++found->second.scans;
      for (std::size_t k = 0; k < tracks.number_of_confirmed_tracks; ++k) {
        const Track& track = tracks.tracks[k];
        if (object.distance_m({track.position_vehicle_m[0], track.position_vehicle_m[1]}) > kNear_m) continue;
        ++found->second.tracked;
        break;
      }
    }
  }
  void end_second(Outcome& out) {
    for (const auto& [id, second] : seconds_) {
      if (second.detections < kEnough) continue;
      ++out.object_seconds;
      if (2 * second.taken_away > second.detections && 2 * second.tracked < second.scans) ++out.lost_object_seconds;
    }
    seconds_.clear();
  }

 private:
  struct Second {
    std::size_t detections = 0, taken_away = 0, scans = 0, tracked = 0;
  };
  std::map<std::uint32_t, Second> seconds_;
};

/// The vehicle that a scenario is meant for.
VehicleConfig vehicle_of(const simulator::Scenario& scenario) {
  const std::string name = scenario.vehicle.empty() ? "demo" : scenario.vehicle;
  return config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle" / (name + ".toml"));
}

}  // namespace

Outcome run_ghost_drive(const std::string& name, const ghosts::Config& config, std::uint64_t seed, double duration_s) {
  const simulator::Scenario scenario = simulator::scenario(name);
  const VehicleConfig vehicle = vehicle_of(scenario);
  simulator::Drive drive(scenario, vehicle, seed, std::min(duration_s, scenario.duration_s));
  Chain chain(vehicle, config);
  Outcome out;
  GhostTracks ghost_tracks;
  LostObjects lost_objects;
  double second_ends_s = 1.0;
  while (const simulator::Event* event = drive.next()) {
    if (!chain.take(*event)) continue;
    ++out.scans;
    const std::vector<simulator::DetectionTruth>& truth = *event->truth;
    const ClassifiedScan& scan = *chain.classified;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      out.confusion.add(truth[i].provenance, scan.provenance[i],
                        (scan.detection_flags[i] & corrected_flag::kRejected) != 0);
    }
    if (event->t_s > second_ends_s) {
      lost_objects.end_second(out);
      second_ends_s += 1.0;
    }
    const std::vector<Object> objects = closed_loop::objects_at(drive, event->t_s);
    ghost_tracks.add(chain, truth, objects);
    lost_objects.add(chain, truth, objects);
  }
  lost_objects.end_second(out);
  ghost_tracks.write(out);
  return out;
}

std::vector<Outcome> run_ghost_drives(const std::string& scenario, const ghosts::Config& config, std::size_t seeds,
                                      double duration_s, const Options& options) {
  std::vector<Outcome> outcomes(seeds);
  parallel_for(seeds, options.jobs,
               [&](std::size_t i) { outcomes[i] = run_ghost_drive(scenario, config, i + 1, duration_s); });
  return outcomes;
}

double median_percent(const std::vector<Outcome>& outcomes, Provenance truth, Provenance label) {
  std::vector<double> values;
  for (const Outcome& o : outcomes) {
    if (o.confusion.count(truth) > 0) values.push_back(o.confusion.percent(truth, label));
  }
  return median(values);
}

double median_percent_ghost(const std::vector<Outcome>& outcomes, Provenance truth) {
  std::vector<double> values;
  for (const Outcome& o : outcomes) {
    if (o.confusion.count(truth) > 0) values.push_back(o.confusion.percent_ghost(truth));
  }
  return median(values);
}

double median_count(const std::vector<Outcome>& outcomes, Provenance truth) {
  std::vector<double> values;
  for (const Outcome& o : outcomes) {
    values.push_back(static_cast<double>(o.confusion.count(truth) + o.confusion.rejected(truth)));
  }
  return median(values);
}

}  // namespace boresight::bench
