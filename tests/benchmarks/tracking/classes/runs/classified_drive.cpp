#include "tests/benchmarks/tracking/classes/runs/classified_drive.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "services/boresight/run/chain.hpp"
#include "services/boresight/run/settings.hpp"
#include "services/simulator/drive.hpp"
#include "services/simulator/judge/hidden.hpp"
#include "services/simulator/judge/matching.hpp"
#include "services/simulator/scenario/read_profile.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::bench::tracking {

using extended_object::RoadUserClass;

namespace {

constexpr const char* kVehicle = "demo";

[[nodiscard]] RoadUserClass class_of(simulator::BodyKind kind) {
  switch (kind) {
    case simulator::BodyKind::kPedestrian:
      return RoadUserClass::kPedestrian;
    case simulator::BodyKind::kCyclist:
      return RoadUserClass::kTwoWheeler;
    case simulator::BodyKind::kVan:
      return RoadUserClass::kVan;
    case simulator::BodyKind::kTruck:
      return RoadUserClass::kTruck;
    case simulator::BodyKind::kCar:
      break;
  }
  return RoadUserClass::kCar;
}

/// Without the share of the unknown class, which is divided among the others alike.
[[nodiscard]] ReportedClasses reported(const Track& track) {
  const auto p = [&](ObjectClass of) {
    return static_cast<double>(track.class_probability[static_cast<std::size_t>(of)]);
  };
  ReportedClasses classes = {p(ObjectClass::kPedestrian), p(ObjectClass::kTwoWheeler), p(ObjectClass::kCar),
                             p(ObjectClass::kVan), p(ObjectClass::kTruck)};
  for (double& share : classes) share += p(ObjectClass::kUnknown) / static_cast<double>(classes.size());
  return classes;
}

class DriveOfClasses {
 public:
  explicit DriveOfClasses(const simulator::Drive& drive) : drive_(drive) {}

  void add(const simulator::Event& event, const TrackList& list) {
    std::vector<judge::Object> objects = closed_loop::objects_at(drive_, event.t_s);
    last_seen_.mark(event.t_s, *event.truth, objects);
    const judge::Matching matching = judge::match(list, list.number_of_confirmed_tracks, objects);
    for (std::size_t o = 0; o < objects.size(); ++o) {
      const std::size_t k = matching.track_of_object[o];
      if (k == judge::kNone || objects[o].is_hidden) continue;
      const Track& track = list.tracks[k];
      const simulator::BodyKind kind = drive_.world().body(objects[o].id - 1, event.t_s).kind;
      judge_.add(track.tracking_id, objects[o].id, static_cast<std::size_t>(class_of(kind)),
                 static_cast<double>(track.age_s), reported(track));
    }
  }
  [[nodiscard]] ClassJudge finish() {
    judge_.end_drive();
    return std::move(judge_);
  }

 private:
  const simulator::Drive& drive_;
  judge::LastSeen last_seen_;
  ClassJudge judge_;
};

}  // namespace

ClassJudge judge_drive(const ClassifiedDrive& of, const std::filesystem::path& config) {
  runtime::Configuration configuration;
  configuration.directory = config;
  configuration.vehicle_name = kVehicle;
  configuration.statistics = of.profile;
  const VehicleConfig vehicle = configuration.vehicle(config::VehicleUse::kOffline);
  run::Settings settings = run::read_settings(configuration, vehicle);
  if (!of.tracker.empty()) settings.tracker.tracker = of.tracker;
  simulator::Scenario scenario = simulator::scenario(of.scenario);
  simulator::use_profile(scenario, of.profile);
  const double duration_s = of.longest_s > 0.0 ? std::min(of.longest_s, scenario.duration_s) : scenario.duration_s;
  simulator::Drive drive(scenario, vehicle, of.seed, duration_s);
  run::Chain chain(vehicle, settings);
  DriveOfClasses judged(drive);
  const auto scan = std::make_unique<RadarScan>();
  while (const simulator::Event* event = drive.next()) {
    chain.advance(event->stamp_ns);
    if (event->scan == nullptr) {
      EgoMotion motion = simulator::to_message(*event, vehicle.ego);
      chain.add_ego(motion, event->stamp_ns);
      continue;
    }
    *scan = *event->scan;
    if (chain.add_scan(*scan, event->stamp_ns)) judged.add(*event, chain.tracks());
  }
  return judged.finish();
}

}  // namespace boresight::bench::tracking
