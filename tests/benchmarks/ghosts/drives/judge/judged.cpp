#include "tests/benchmarks/ghosts/drives/judge/judged.hpp"

#include <algorithm>
#include <memory>

#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/common/scenario_vehicle.hpp"
#include "tests/closed_loop/chain.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::bench::ghosts_drives {

DriveResult run_drive(const DriveSpec& spec, const ghosts::Config& config) {
  simulator::Scenario scenario = simulator::scenario(spec.scenario);
  simulator::use_profile(scenario, spec.profile);
  const VehicleConfig vehicle = vehicle_of(scenario);
  simulator::Drive drive(scenario, vehicle, spec.seed, std::min(spec.longest_s, scenario.duration_s));
  closed_loop::Front front(vehicle);
  fit_evidence::Lanes lanes(config, true);
  auto product = ghosts::make_method(config);
  const ghosts::Method& in_chain = *product;
  closed_loop::Back chain(vehicle, std::move(product));
  ghosts::Config published_config = config;
  published_config.method = ghosts::MethodName::kPublished;
  closed_loop::Back published(vehicle, ghosts::make_method(published_config));
  DriveResult result;
  while (const simulator::Event* event = drive.next()) {
    if (!front.take(*event)) continue;
    const CorrectedScan& scan = *front.corrected;
    const std::vector<simulator::DetectionTruth>& truth = *event->truth;
    lanes.classify(scan);
    chain.take(scan);
    published.take(scan);
    const std::array<const ClassifiedScan*, kLanes> classified = {&lanes.without(), &lanes.perfect(),
                                                                  chain.classified.get(), published.classified.get()};
    lanes.label(event->t_s, truth, in_chain.evidence(), result.evidence);
    for (const ghosts::JudgedEvidence& each : in_chain.evidence()) {
      const std::size_t i = each.index;
      JudgedDetection d;
      d.truth = truth[i].provenance;
      d.is_real = d.truth == Provenance::kMoving;
      d.is_ambiguous = d.is_real && truth[i].cause == simulator::Cause::kDopplerAmbiguity;
      d.known_s = d.is_real ? static_cast<float>(lanes.age_s(truth[i].object_id, event->t_s)) : -1.0F;
      d.base_rate = result.evidence.base_rates[result.detections.size()];
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        d.p_moving[lane] = classified[lane]->probability(Provenance::kMoving, i);
      result.detections.push_back(d);
    }
    lanes.add_objects(event->t_s, truth, closed_loop::objects_at(drive, event->t_s));
  }
  return result;
}

}  // namespace boresight::bench::ghosts_drives
