#include "tests/benchmarks/ghosts/common/tables.hpp"

namespace boresight::bench {

Table confusion_table(const std::string& name, const std::string& caption, const std::vector<Outcome>& outcomes) {
  Table table{name, caption, {"truth (count)"}, {}};
  for (const Provenance label : kOrigins) table.header.emplace_back(name_of(label));
  table.header.insert(table.header.end(), {"unclassified", "ghost, either type", "rejected"});
  for (const Provenance truth : kOrigins) {
    // The truth of a simulated drive names no ambiguities.
    if (truth == Provenance::kAmbiguity) continue;
    std::vector<std::string> row = {std::string(name_of(truth)) +
                                    (" (" + fixed(median_count(outcomes, truth), 0) + ")")};
    for (const Provenance label : kOrigins) row.push_back(fixed(percent_classified(outcomes, truth, label).median, 2));
    row.push_back(fixed(percent_classified(outcomes, truth, Provenance::kUnknown).median, 2));
    row.push_back(fixed(percent_classified_ghost(outcomes, truth).median, 2));
    row.push_back(fixed(percent_rejected(outcomes, truth).median, 1));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void judge_percent(const std::string& group, const std::string& what, Percent percent, double bar,
                   const std::string& how, Report& report) {
  report.at_least(group, what, percent.median, bar, "%", how + "; worst seed " + fixed(percent.worst, 1));
}

void judge_tracks(const std::string& group, const std::vector<Outcome>& outcomes, bool judged, const std::string& how,
                  Report& report) {
  const TrackFaults faults = track_faults(outcomes);
  const std::string what_tracks = "ghost tracks of more than five scans", what_objects = "objects lost",
                    what_seconds = "object seconds lost";
  const std::string how_tracks = "sum over " + how +
                                 "; lasting at least 0.5 s: " + std::to_string(faults.lasting_ghost_tracks) +
                                 "; longest: " + std::to_string(faults.longest_ghost_track_scans) + " scans";
  const std::string how_objects = "sum over " + how + "; of " + std::to_string(faults.objects) +
                                  "; lost in over half of the seconds in which perfect labels hold a track";
  const std::string how_seconds = "sum over " + how + "; of " + std::to_string(faults.object_seconds) +
                                  "; of these with ≥ 90 % of the object's detections classified correctly: " +
                                  std::to_string(faults.lost_though_correct_seconds) +
                                  "; gained: " + std::to_string(faults.gained_seconds) +
                                  "; lost with 3 % random errors: " + std::to_string(faults.lost_by_chance.least()) +
                                  " to " + std::to_string(faults.lost_by_chance.most());
  const auto tracks = static_cast<double>(faults.ghost_tracks), objects = static_cast<double>(faults.lost_objects),
             seconds = static_cast<double>(faults.lost_seconds);
  if (judged) {
    report.at_most(group, what_tracks, tracks, 0.0, "", how_tracks);
    report.at_most(group, what_objects, objects, 0.0, "", how_objects);
    report.at_most(group, what_seconds, seconds, 0.0, "", how_seconds);
  } else {
    report.beside(group, what_tracks, tracks, "", how_tracks);
    report.beside(group, what_objects, objects, "", how_objects);
    report.beside(group, what_seconds, seconds, "", how_seconds);
  }
}

}  // namespace boresight::bench
