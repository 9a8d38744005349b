#include "services/tracker/core/point_process_tracker.hpp"

#include <algorithm>
#include <utility>

namespace boresight::tracking {

PointProcessTracker::PointProcessTracker(std::unique_ptr<Model> model, std::unique_ptr<Filter> filter,
                                         std::unique_ptr<Reporter> reporter)
    : model_(std::move(model)), filter_(std::move(filter)), reporter_(std::move(reporter)) {}

double PointProcessTracker::advance(const ScanStart& start) {
  const double newer_s = start.elapsed_s - (start.restarted ? 0.0 : behind_s_);
  behind_s_ = std::max(0.0, -newer_s);
  return std::max(0.0, newer_s);
}

StepResult PointProcessTracker::step(const ClassifiedScan& scan) {
  const ScanStart start = model_->begin_scan(scan);
  if (start.restarted) {
    filter_->clear();
    reporter_->clear();
  }
  filter_->step(*model_, start.elapsed_s);
  model_->learn(filter_->explained(), filter_->estimates());
  reporter_->take(filter_->estimates(), advance(start));

  const FilterWork& work = filter_->work();
  flags_ = scan.flags;
  result_ = {start.out_of_order,         start.restarted,
             work.budget_reached,        start.dropped_detections + work.dropped_detections,
             work.dropped_objects,       work.cut_gates,
             work.likelihood_evaluations};
  return result_;
}

void PointProcessTracker::write(TrackList& out) const {
  out.number_of_tracks = out.number_of_confirmed_tracks = out.dropped_tracks = 0;
  out.number_of_road_edges = out.number_of_path_objects = 0;
  out.number_of_collision_warnings = out.dropped_path_objects = 0;
  out.flags = flags_;
  out.likelihood_evaluations = result_.likelihood_evaluations;
  out.tracker_flags = 0;
  if (result_.budget_reached) out.tracker_flags |= tracker_flag::kWorkBudgetReached;
  if (result_.cut_gates > 0) out.tracker_flags |= tracker_flag::kGatesCut;
  reporter_->write(out);
  if (result_.dropped_detections + result_.dropped_objects + out.dropped_tracks > 0) {
    out.tracker_flags |= tracker_flag::kCapacityReached;
  }
}

}  // namespace boresight::tracking
