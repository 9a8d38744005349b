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

void judge_tracks(const std::string& group, const std::vector<Outcome>& outcomes, bool judged, const std::string& how,
                  Report& report) {
  std::size_t ghosts = 0, longest = 0, seconds = 0, lost = 0;
  for (const Outcome& o : outcomes) {
    ghosts += o.long_ghost_tracks;
    longest = std::max(longest, o.longest_ghost_track_scans);
    seconds += o.object_seconds;
    lost += o.lost_object_seconds;
  }
  const std::string ghost_how = how + "; sum of all drives, the longest has " + std::to_string(longest) + " scans";
  const std::string lost_how = how + "; sum of all drives, of " + std::to_string(seconds);
  if (judged) {
    report.at_most(group, "ghost tracks of over five scans", static_cast<double>(ghosts), 0.0, "", ghost_how);
    report.at_most(group, "seconds of objects lost to the filter", static_cast<double>(lost), 0.0, "", lost_how);
  } else {
    report.beside(group, "ghost tracks of over five scans", static_cast<double>(ghosts), "", ghost_how);
    report.beside(group, "seconds of objects lost to the filter", static_cast<double>(lost), "", lost_how);
  }
}

}  // namespace boresight::bench
