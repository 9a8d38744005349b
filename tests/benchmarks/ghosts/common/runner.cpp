#include "tests/benchmarks/ghosts/common/runner.hpp"

#include <algorithm>
#include <memory>

#include "services/simulator/judge/hidden.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/parallel.hpp"
#include "tests/benchmarks/common/scenario_vehicle.hpp"
#include "tests/benchmarks/ghosts/common/changed_method.hpp"
#include "tests/benchmarks/ghosts/common/truth_method.hpp"
#include "tests/closed_loop/chain.hpp"

namespace boresight::bench {

namespace {

using closed_loop::Back;
using closed_loop::Object;
using simulator::DetectionTruth;

Matching match_confirmed(const Back& back, const std::vector<Object>& objects) {
  return match(*back.tracks, back.tracks->number_of_confirmed_tracks, objects);
}

/// The tracker with perfect labels.
struct Perfect {
  explicit Perfect(const VehicleConfig& vehicle) : Perfect(vehicle, std::make_unique<TruthMethod>()) {}
  /// … of which a random share of the moving detections is labelled as ghosts.
  Perfect(const VehicleConfig& vehicle, std::uint64_t seed)
      : Perfect(vehicle, std::make_unique<TruthMethod>(LostByChance::kMislabelledShare, seed)) {}

  void take(const CorrectedScan& scan, const std::vector<DetectionTruth>& truth, const std::vector<Object>& objects) {
    labels.set_truth(truth);
    back.take(scan);
    tracked.add(match_confirmed(back, objects), objects);
  }

  TruthMethod& labels;
  Back back;
  TrackedObjects tracked;
  LostObjects lost;  ///< compared with unchanged perfect labels

 private:
  Perfect(const VehicleConfig& vehicle, std::unique_ptr<TruthMethod> method)
      : labels(*method), back(vehicle, std::move(method)) {}
};

/// One method with its tracker, and the counts of both.
struct Lane {
  Lane(const VehicleConfig& vehicle, const NamedGhostMethod& method)
      : back(vehicle, std::make_unique<ChangedMethod>(method.config, method.change)) {}
  Back back;
  FalseTracks false_tracks;
  TrackedObjects tracked;
  Outcome out;
};

void count_detections(const ClassifiedScan& scan, const std::vector<DetectionTruth>& truth, Outcome& out) {
  ++out.scans;
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    const bool rejected = (scan.detection_flags[i] & corrected_flag::kRejected) != 0;
    const Provenance is = truth[i].provenance;
    out.confusion.add(is, scan.provenance[i], rejected);
    if (rejected || (scan.detection_flags[i] & corrected_flag::kMoving) == 0) continue;
    out.reliability.add(static_cast<double>(scan.ghost_probability(i)),
                        is != Provenance::kMoving && is != Provenance::kStationary);
  }
}

void count_apart(const ClassifiedScan& scan, const std::vector<DetectionTruth>& truth,
                 const std::vector<Object>& objects, ApartGhosts& out) {
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    if (truth[i].provenance != Provenance::kGhostType1) continue;
    if ((scan.detection_flags[i] & corrected_flag::kRejected) != 0) continue;
    const auto object =
        std::find_if(objects.begin(), objects.end(), [&](const Object& o) { return o.id == truth[i].object_id; });
    ++out.all;
    if (object == objects.end()) continue;
    if (object->distance_m({scan.x_vehicle_m[i], scan.y_vehicle_m[i]}) <= ApartGhosts::kApart_m) continue;
    ++out.apart;
    const Provenance label = scan.provenance[i];
    out.apart_classified_ghost += label == Provenance::kGhostType1 || label == Provenance::kGhostType2 ? 1 : 0;
  }
}

}  // namespace

std::vector<Outcome> run_ghost_drive(const GhostDrive& of, std::span<const NamedGhostMethod> methods,
                                     const Observer& observe) {
  simulator::Scenario scenario = simulator::scenario(of.scenario);
  if (!of.profile.empty()) simulator::use_profile(scenario, of.profile);
  const VehicleConfig vehicle = vehicle_of(scenario);
  simulator::Drive drive(scenario, vehicle, of.seed, std::min(of.duration_s, scenario.duration_s));
  // The stages before the ghost filter are the same for all methods and run once.
  closed_loop::Front front(vehicle);
  Perfect perfect(vehicle);
  std::vector<std::unique_ptr<Perfect>> by_chance;
  for (std::size_t draw = 0; draw < LostByChance::kDraws; ++draw) {
    by_chance.push_back(std::make_unique<Perfect>(vehicle, LostByChance::kDraws * of.seed + draw));
  }
  std::vector<std::unique_ptr<Lane>> lanes;
  for (const NamedGhostMethod& method : methods) lanes.push_back(std::make_unique<Lane>(vehicle, method));
  judge::LastSeen last_seen;
  double second_ends_s = 1.0;
  while (const simulator::Event* event = drive.next()) {
    if (!front.take(*event)) continue;
    if (event->t_s > second_ends_s) {
      for (const auto& lane : lanes) {
        lane->out.lost.add_second(second_ends_s, perfect.tracked, lane->tracked);
        lane->tracked.clear();
      }
      for (const auto& draw : by_chance) {
        draw->lost.add_second(second_ends_s, perfect.tracked, draw->tracked);
        draw->tracked.clear();
      }
      perfect.tracked.clear();
      second_ends_s += 1.0;
    }
    const std::vector<DetectionTruth>& truth = *event->truth;
    std::vector<Object> objects = closed_loop::objects_at(drive, event->t_s);
    last_seen.mark(event->t_s, truth, objects);
    perfect.take(*front.corrected, truth, objects);
    perfect.tracked.add_detections(*perfect.back.classified, truth);
    for (const auto& draw : by_chance) draw->take(*front.corrected, truth, objects);
    for (std::size_t m = 0; m < lanes.size(); ++m) {
      Lane& lane = *lanes[m];
      lane.back.take(*front.corrected);
      count_detections(*lane.back.classified, truth, lane.out);
      count_apart(*lane.back.classified, truth, objects, lane.out.type1);
      const Matching matching = match_confirmed(lane.back, objects);
      lane.false_tracks.add(event->t_s, *lane.back.classified, truth, *lane.back.tracks, matching);
      lane.tracked.add(matching, objects);
      lane.tracked.add_detections(*lane.back.classified, truth);
      if (observe) observe({drive, *event, objects, *lane.back.classified, *lane.back.tracks, m});
    }
  }
  std::vector<Outcome> outcomes;
  for (const auto& lane : lanes) {
    std::transform(by_chance.begin(), by_chance.end(), lane->out.lost_by_chance.seconds.begin(),
                   [](const auto& draw) { return draw->lost.lost.size(); });
    lane->out.long_ghost_tracks = lane->false_tracks.long_ghost_tracks();
    lane->out.longest_ghost_track_scans = lane->false_tracks.longest_ghost_track_scans();
    lane->out.long_other_tracks = lane->false_tracks.long_other_tracks();
    outcomes.push_back(lane->out);
  }
  return outcomes;
}

std::vector<std::vector<Outcome>> run_ghost_drives(const std::string& scenario,
                                                   std::span<const NamedGhostMethod> methods, std::size_t seeds,
                                                   double duration_s, const Options& options) {
  std::vector<std::vector<Outcome>> outcomes(methods.size(), std::vector<Outcome>(seeds));
  parallel_for(seeds, options.jobs, [&](std::size_t i) {
    const std::vector<Outcome> of_seed =
        run_ghost_drive({scenario, options.profile, options.first_seed + i, duration_s}, methods);
    for (std::size_t m = 0; m < methods.size(); ++m) outcomes[m][i] = of_seed[m];
  });
  return outcomes;
}

}  // namespace boresight::bench
