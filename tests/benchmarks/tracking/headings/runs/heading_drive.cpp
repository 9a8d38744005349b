#include "tests/benchmarks/tracking/headings/runs/heading_drive.hpp"

#include <utility>
#include <vector>

#include "services/simulator/judge/hidden.hpp"
#include "services/tracker/core/classical/classical_filter.hpp"
#include "services/tracker/core/model/radar_model.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::bench::tracking {

namespace {

using boresight::tracking::BoxMemory;
using boresight::tracking::ObjectEstimate;
using boresight::tracking::RadarModel;
using boresight::tracking::classical::ClassicalFilter;
using boresight::tracking::classical::HeadingSources;

/// The track nearest to the object's box; null if none is near.
const ObjectEstimate* track_at(const judge::Object& object, const RadarModel& model, const ClassicalFilter& filter) {
  const ObjectEstimate* nearest = nullptr;
  double least_m = kFarthestFromBox_m;
  for (const ObjectEstimate& e : filter.estimates()) {
    if (e.existence < kLeastExistence) continue;
    const Eigen::Vector2d centre = model.box(*e.component).centre_m;
    const boresight::tracking::Vector2<double> at =
        model.axes().to_vehicle(boresight::tracking::Vector2<double>{centre.x(), centre.y()});
    const double distance_m = object.distance_m({at.x, at.y});
    if (distance_m > least_m) continue;
    least_m = distance_m;
    nearest = &e;
  }
  return nearest;
}

void judge_track(const ObjectEstimate& track, const judge::Object& object, const RadarModel& model,
                 const ClassicalFilter& filter, HeadingJudge& judge) {
  const double truth_rad = object.heading_rad + model.axes().heading_rad;
  const auto add = [&](HeadingSource source, const boresight::tracking::Heading& heading) {
    judge.add(object.id, source, heading, truth_rad);
  };
  if (const BoxMemory* box = model.memory(track.id); box != nullptr && track.detected) {
    add(HeadingSource::kFused, {box->heading_rad, box->heading_variance_rad2});
  }
  for (const HeadingSources& sources : filter.headings()) {
    if (sources.id != track.id) continue;
    if (sources.course) add(HeadingSource::kCourse, *sources.course);
    if (sources.shape) add(HeadingSource::kOutline, *sources.shape);
    if (sources.line) add(HeadingSource::kLine, *sources.line);
    if (sources.interval) add(HeadingSource::kInterval, *sources.interval);
  }
}

}  // namespace

HeadingJudge judge_headings(const SimulatedDrive& of, const std::filesystem::path& config) {
  SimulatedChain chain(of, config);
  const boresight::tracking::Config& settings = chain.settings().tracker;
  RadarModel model(chain.vehicle(), settings.model, settings.capacity.objects);
  ClassicalFilter filter(settings.classical, settings.capacity.objects, settings.capacity.measurements);
  HeadingJudge judge;
  judge::LastSeen last_seen;
  chain.play([&](const simulator::Event& event, const run::Chain& played) {
    const boresight::tracking::ScanStart start = model.begin_scan(played.classified());
    if (start.restarted) filter.clear();
    filter.step(model, start.elapsed_s);
    model.learn(filter.explained(), filter.estimates());
    std::vector<judge::Object> objects = closed_loop::objects_at(chain.drive(), event.t_s);
    last_seen.mark(event.t_s, *event.truth, objects);
    for (const judge::Object& object : objects) {
      if (object.is_hidden || object.position_m.norm() > kFarthest_m || object.velocity_mps.norm() < kSlowest_mps) {
        continue;
      }
      if (chain.drive().world().body(object.id - 1, event.t_s).kind != simulator::BodyKind::kCar) continue;
      if (const ObjectEstimate* const track = track_at(object, model, filter); track != nullptr) {
        judge_track(*track, object, model, filter, judge);
      }
    }
  });
  judge.end_drive();
  return judge;
}

}  // namespace boresight::bench::tracking
