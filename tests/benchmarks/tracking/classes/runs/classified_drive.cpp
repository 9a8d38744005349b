#include "tests/benchmarks/tracking/classes/runs/classified_drive.hpp"

#include <utility>
#include <vector>

#include "services/simulator/judge/hidden.hpp"
#include "services/simulator/judge/matching.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::bench::tracking {

using extended_object::RoadUserClass;

namespace {

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

ClassJudge judge_drive(const SimulatedDrive& of, const std::filesystem::path& config) {
  SimulatedChain chain(of, config);
  DriveOfClasses judged(chain.drive());
  chain.play([&](const simulator::Event& event, const run::Chain& played) { judged.add(event, played.tracks()); });
  return judged.finish();
}

}  // namespace boresight::bench::tracking
