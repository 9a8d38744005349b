#include "tests/benchmarks/ghosts/explain/explained.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <numbers>
#include <numeric>
#include <ostream>

#include "services/simulator/judge/matching.hpp"

namespace boresight::bench {

namespace {

using closed_loop::Object;

double distance_from_object(const std::vector<Object>& objects, std::uint32_t id, const Eigen::Vector2d& place) {
  double nearest_m = std::numeric_limits<double>::quiet_NaN();
  for (const Object& object : objects) {
    const double distance_m = object.distance_m(place);
    if (object.id == id) return distance_m;
    if (!(nearest_m <= distance_m)) nearest_m = distance_m;
  }
  return nearest_m;
}

const char* name_of(ObjectTrack track) {
  switch (track) {
    case ObjectTrack::kTentative:
      return "tentative";
    case ObjectTrack::kConfirmed:
      return "confirmed";
    case ObjectTrack::kNone:
      break;
  }
  return "none";
}

}  // namespace

const char* csv_header() {
  return "seed,time_s,radar,truth,object_id,bounces,mirror_body,label,rejected,found_moving,ghost_probability,"
         "x_vehicle_m,y_vehicle_m,range_m,azimuth_vehicle_deg,range_rate_over_ground_mps,rcs_dbsm,object_distance_m,"
         "object_track\n";
}

void write_csv(const Explained& row, std::ostream& out) {
  char text[320];
  std::snprintf(text, sizeof text, "%llu,%.4f,%u,%s,%u,%u,%u,%s,%d,%d,%.4f,%.2f,%.2f,%.2f,%.2f,%.2f,%.1f,%.2f,%s\n",
                static_cast<unsigned long long>(row.seed), row.t_s, row.radar, name_of(row.truth.provenance).data(),
                row.truth.object_id, row.truth.bounces, row.truth.mirror_body, name_of(row.label).data(),
                row.rejected ? 1 : 0, row.found_moving ? 1 : 0, row.ghost_probability, row.x_vehicle_m, row.y_vehicle_m,
                row.range_m, row.azimuth_vehicle_rad * 180.0 / std::numbers::pi, row.range_rate_over_ground_mps,
                row.rcs_dbsm, row.object_distance_m, name_of(row.object_track));
  out << text;
}

const std::vector<Explained>& Explainer::explain(const Observed& observed) {
  const ClassifiedScan& scan = observed.scan;
  rows_.clear();
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    const simulator::DetectionTruth& truth = (*observed.event.truth)[i];
    const Eigen::Vector2d place(scan.x_vehicle_m[i], scan.y_vehicle_m[i]);
    const auto tracked = tracked_.find(truth.object_id);
    rows_.push_back({.seed = seed_,
                     .t_s = observed.event.t_s,
                     .radar = scan.header.source_id,
                     .truth = truth,
                     .label = scan.provenance[i],
                     .rejected = (scan.detection_flags[i] & corrected_flag::kRejected) != 0,
                     .found_moving = (scan.detection_flags[i] & corrected_flag::kMoving) != 0,
                     .ghost_probability = scan.ghost_probability(i),
                     .x_vehicle_m = place.x(),
                     .y_vehicle_m = place.y(),
                     .range_m = scan.range_m[i],
                     .azimuth_vehicle_rad = scan.azimuth_vehicle_rad[i],
                     .range_rate_over_ground_mps = scan.range_rate_over_ground_mps[i],
                     .rcs_dbsm = scan.rcs_dbsm[i],
                     .object_distance_m = distance_from_object(observed.objects, truth.object_id, place),
                     .object_track = tracked == tracked_.end() ? ObjectTrack::kNone : tracked->second});
  }
  tracked_.clear();
  const Matching matching = match(observed.tracks, observed.tracks.number_of_tracks, observed.objects);
  for (std::size_t o = 0; o < observed.objects.size(); ++o) {
    if (matching.track_of_object[o] == kNone) continue;
    const Track& track = observed.tracks.tracks[matching.track_of_object[o]];
    tracked_[observed.objects[o].id] =
        track.status == TrackStatus::kConfirmed ? ObjectTrack::kConfirmed : ObjectTrack::kTentative;
  }
  return rows_;
}

void Summary::add(const Explained& row) {
  if (row.rejected) return;
  const auto bin = static_cast<std::size_t>(
      std::lower_bound(kDistances_m.begin(), kDistances_m.end(), row.object_distance_m) - kDistances_m.begin());
  const bool is_tracked = row.object_track == ObjectTrack::kConfirmed;
  ++counts_.try_emplace({row.truth.provenance, row.label, is_tracked}).first->second[bin];
}

void Summary::print(std::ostream& out) const {
  char cell[64];
  std::snprintf(cell, sizeof cell, "%-11s %-11s %-8s %9s", "truth", "label", "tracked", "all");
  out << cell;
  for (const double limit_m : kDistances_m) {
    std::snprintf(cell, sizeof cell, "   <=%4.1f m", limit_m);
    out << cell;
  }
  out << "    farther\n";
  for (const auto& [key, bins] : counts_) {
    const auto& [truth, label, is_tracked] = key;
    std::snprintf(cell, sizeof cell, "%-11s %-11s %-8s %9llu", boresight::name_of(truth).data(),
                  boresight::name_of(label).data(), is_tracked ? "yes" : "no",
                  static_cast<unsigned long long>(std::accumulate(bins.begin(), bins.end(), std::uint64_t{0})));
    out << cell;
    for (const std::uint64_t count : bins) {
      std::snprintf(cell, sizeof cell, " %10llu", static_cast<unsigned long long>(count));
      out << cell;
    }
    out << '\n';
  }
}

}  // namespace boresight::bench
