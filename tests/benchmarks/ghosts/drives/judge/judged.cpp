#include "tests/benchmarks/ghosts/drives/judge/judged.hpp"

#include <algorithm>
#include <memory>

#include "services/simulator/judge/hidden.hpp"
#include "services/simulator/judge/true_tracks.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/scenario_vehicle.hpp"
#include "tests/benchmarks/ghosts/drives/judge/base_rate.hpp"
#include "tests/closed_loop/chain.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::bench::ghosts_drives {

namespace {

using simulator::DetectionTruth;

/// A filter without a tracker behind it.
struct Alone {
  explicit Alone(const ghosts::Config& config) : method(ghosts::make_method(config)) {}
  void take(const CorrectedScan& scan) {
    classified->header = scan.header;
    method->classify(scan, *classified);
  }
  std::unique_ptr<ghosts::Method> method;
  std::unique_ptr<ClassifiedScan> classified = std::make_unique<ClassifiedScan>();
};

void keep_evidence(const ghosts::Method& method, const std::vector<DetectionTruth>& truth,
                   std::vector<ghosts::LabelledEvidence>& out) {
  for (const ghosts::JudgedEvidence& each : method.evidence()) {
    const Provenance origin = truth[each.index].provenance;
    out.push_back({each.levels, origin == Provenance::kMoving,
                   origin == Provenance::kGhostType1 || origin == Provenance::kGhostType2});
  }
}

}  // namespace

DriveResult run_drive(const DriveSpec& spec, const ghosts::Config& config) {
  simulator::Scenario scenario = simulator::scenario(spec.scenario);
  simulator::use_profile(scenario, spec.profile);
  const VehicleConfig vehicle = vehicle_of(scenario);
  simulator::Drive drive(scenario, vehicle, spec.seed, std::min(spec.longest_s, scenario.duration_s));
  closed_loop::Front front(vehicle);
  Alone without(config), perfect(config);
  auto product = ghosts::make_method(config);
  const ghosts::Method& in_chain = *product;
  closed_loop::Back chain(vehicle, std::move(product));
  ghosts::Config published_config = config;
  published_config.method = ghosts::MethodName::kPublished;
  closed_loop::Back published(vehicle, ghosts::make_method(published_config));
  judge::LastSeen last_seen;
  judge::TrueTracks true_tracks;
  const auto tracks = std::make_unique<TrackList>();
  BaseRate base_rate;
  DriveResult result;
  while (const simulator::Event* event = drive.next()) {
    if (!front.take(*event)) continue;
    const CorrectedScan& scan = *front.corrected;
    const std::vector<DetectionTruth>& truth = *event->truth;
    const std::uint32_t radar = scan.header.source_id;
    without.take(scan);
    perfect.take(scan);
    chain.take(scan);
    published.take(scan);
    const std::array<const ClassifiedScan*, kLanes> lanes = {without.classified.get(), perfect.classified.get(),
                                                             chain.classified.get(), published.classified.get()};
    const double base = base_rate.at(radar, event->t_s);
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      const std::uint16_t flags = scan.detection_flags[i];
      if ((flags & corrected_flag::kMoving) == 0 || (flags & corrected_flag::kRejected) != 0) continue;
      JudgedDetection d;
      d.truth = truth[i].provenance;
      d.is_real = d.truth == Provenance::kMoving;
      d.is_ambiguous = d.is_real && truth[i].cause == simulator::Cause::kDopplerAmbiguity;
      d.known_s = d.is_real ? static_cast<float>(true_tracks.age_s(truth[i].object_id, event->t_s)) : -1.0F;
      d.base_rate = static_cast<float>(base);
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        d.p_moving[lane] = lanes[lane]->probability(Provenance::kMoving, i);
      base_rate.add(radar, d.is_real);
      result.detections.push_back(d);
    }
    keep_evidence(*without.method, truth, result.evidence_of(Lane::kWithout));
    keep_evidence(*perfect.method, truth, result.evidence_of(Lane::kPerfect));
    keep_evidence(in_chain, truth, result.evidence_of(Lane::kChain));
    // What is known after this scan is known in the next one.
    std::vector<closed_loop::Object> objects = closed_loop::objects_at(drive, event->t_s);
    last_seen.mark(event->t_s, truth, objects);
    tracks->header = scan.header;
    true_tracks.write(event->t_s, objects, *tracks);
    perfect.method->add_tracks(*tracks);
  }
  return result;
}

}  // namespace boresight::bench::ghosts_drives
