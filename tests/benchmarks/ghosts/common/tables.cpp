#include "tests/benchmarks/ghosts/common/tables.hpp"

#include <algorithm>

#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

Table confusion_table(const std::string& name, const std::string& caption, const std::vector<Outcome>& outcomes) {
  Table table{name, caption, {"truth (count)"}, {}};
  for (const Provenance label : kTruths) table.header.emplace_back(name_of(label));
  table.header.emplace_back("not told");
  table.header.emplace_back("ghost");
  table.header.emplace_back("left out");
  for (const Provenance truth : kTruths) {
    std::vector<std::string> row = {name_of(truth) + (" (" + fixed(median_count(outcomes, truth), 0) + ")")};
    for (const Provenance label : kTruths) row.push_back(fixed(median_percent(outcomes, truth, label), 2));
    row.push_back(fixed(median_percent(outcomes, truth, Provenance::kUnknown), 2));
    row.push_back(fixed(median_percent_ghost(outcomes, truth), 2));
    std::vector<double> rejected;
    for (const Outcome& o : outcomes) rejected.push_back(static_cast<double>(o.confusion.rejected(truth)));
    row.push_back(fixed(median(rejected), 0));
    table.rows.push_back(std::move(row));
  }
  return table;
}

TrackFaults track_faults(const std::vector<Outcome>& outcomes) {
  TrackFaults sum;
  for (const Outcome& o : outcomes) {
    sum.ghost_tracks += o.long_ghost_tracks;
    sum.longest_ghost_track_scans = std::max(sum.longest_ghost_track_scans, o.longest_ghost_track_scans);
    sum.object_seconds += o.object_seconds;
    sum.lost_object_seconds += o.lost_object_seconds;
  }
  return sum;
}

void judge_tracks(const std::string& group, const std::vector<Outcome>& outcomes, bool judged, const std::string& how,
                  Report& report) {
  const TrackFaults faults = track_faults(outcomes);
  const std::string what_tracks = "ghost tracks of over five scans",
                    what_lost = "seconds of objects lost to the filter";
  const std::string how_tracks =
      how + "; sum of all drives, the longest has " + std::to_string(faults.longest_ghost_track_scans) + " scans";
  const std::string how_lost = how + "; sum of all drives, of " + std::to_string(faults.object_seconds);
  const auto tracks = static_cast<double>(faults.ghost_tracks), lost = static_cast<double>(faults.lost_object_seconds);
  if (judged) {
    report.at_most(group, what_tracks, tracks, 0.0, "", how_tracks);
    report.at_most(group, what_lost, lost, 0.0, "", how_lost);
  } else {
    report.beside(group, what_tracks, tracks, "", how_tracks);
    report.beside(group, what_lost, lost, "", how_lost);
  }
}

}  // namespace boresight::bench
