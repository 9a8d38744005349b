// Labels beside the truth, and tracks that lived on ghosts.
#include <fmt/format.h>

#include "services/boresight/report/sections/label_style.hpp"
#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

namespace {

std::string render_matrix(const judge::Confusion& confusion) {
  std::string text = "<div class=\"wide\"><table><tr><th>in truth</th><th class=n>detections</th>";
  for (const LabelStyle& style : kLabelStyles)
    text += fmt::format("<th class=n>{}{}</th>", style.label == Provenance::kUnknown ? "" : "told ", style.words);
  text += "<th class=n>ghost, either</th><th class=n>left out before</th></tr>\n";
  for (const Provenance truth : judge::kTruths) {
    const std::uint64_t count = confusion.count(truth);
    text += fmt::format("<tr><td>{}</td><td class=n>{}</td>", style_of(truth).words, count);
    for (const LabelStyle& style : kLabelStyles) {
      if (count == 0) {
        text += "<td class=n>–</td>";
        continue;
      }
      const double percent = confusion.percent(truth, style.label);
      text += fmt::format("<td class=\"n heat {}\" style=\"--share:{:.3f}\" title=\"{}\">{:.2f} %</td>",
                          style.label == truth ? "right" : "wrong", 0.01 * percent, confusion.count(truth, style.label),
                          percent);
    }
    text += fmt::format("<td class=n>{}</td><td class=n>{}</td></tr>\n",
                        known_number(confusion.percent_ghost(truth), " %", 2), confusion.rejected(truth));
  }
  return text + "</table></div>\n";
}

std::string render_ghost_tracks(const GhostFindings& ghosts, const TimeBase& time) {
  std::string text = fmt::format(
      "<h3>Tracks of ghosts</h3>\n<p class=\"faint\">A confirmed track lives on ghosts in a scan if it is no object's "
      "(nearest pairs within 3 m of a true box; what lies in a box is that object's or nobody's) and most of what was "
      "told to be moving within {:.0f} m of its box is a ghost in truth. Counted are those that did so in more than {} "
      "scans, of {} track lists.</p>\n",
      judge::FalseTracks::kEvidence_m, judge::FalseTracks::kLong_scans, ghosts.track_lists);
  if (ghosts.track_lists == 0) return text + "<p>No track list is in the record.</p>\n";
  if (ghosts.ghost_tracks.empty()) {
    text += "<p>None.";
  } else {
    text +=
        "<table><tr><th>track</th><th class=n>scans on ghosts</th><th class=n>from, s</th><th class=n>until, s</th>"
        "<th class=n>last ahead, m</th><th class=n>left, m</th></tr>\n";
    for (const judge::GhostTrack& track : ghosts.ghost_tracks) {
      const auto seconds = [&time](double t_s) { return time.seconds(static_cast<std::int64_t>(t_s * 1e9)); };
      text += fmt::format(
          "<tr><td>#{}</td><td class=n>{}</td><td class=n>{:.1f}</td><td class=n>{:.1f}</td><td class=n>{:.1f}</td>"
          "<td class=n>{:.1f}</td></tr>\n",
          track.tracking_id, track.scans, seconds(track.since_s), seconds(track.until_s), track.x_vehicle_m,
          track.y_vehicle_m);
    }
    text += "</table>\n<p>";
  }
  return text + fmt::format(" False tracks of another kind, of clutter or of what stands still: {}.</p>\n",
                            ghosts.other_false_tracks);
}

}  // namespace

std::string render_confusion(const ReportInput& input, const TimeBase& time) {
  const GhostFindings& ghosts = input.ghosts;
  std::string text = "<h2>Ghost filter: against the truth</h2>\n";
  if (ghosts.damaged.count > 0) {
    const bool one = ghosts.damaged.count == 1;
    text += fmt::format(
        "<p><span class=\"bad\">{} of the record of scans could not be read</span>; what {} held is missing here and "
        "in "
        "the views. {}: <code>{}</code></p>\n",
        one ? "A line" : fmt::format("{} lines", ghosts.damaged.count), one ? "it" : "they",
        one ? "It is" : "The first", escape(ghosts.damaged.first));
    if (ghosts.scans == 0) return text + "<p>No other line holds a scan.</p>\n";
  }
  if (ghosts.scans == 0) {
    return text +
           "<p>Scans were not recorded, so there is nothing to compare, and no view of them. <code>boresight monitor "
           "--record-scans</code> records them.</p>\n";
  }
  if (!ghosts.confusion) {
    return text +
           "<p>No truth is known of this drive's detections: nothing tells whether the labels above are right.</p>\n";
  }
  text += fmt::format(
      "<p class=\"faint\">Every detection of the {} scans that the running ghost filter published and that could be "
      "found in the drive's truth, by time of measurement and number of detections ({} scans could not). A row is what "
      "detections are, its columns are what they were told to be, as shares of the row; those that the corrector left "
      "out are counted apart.</p>\n",
      ghosts.compared_scans, ghosts.unknown_scans);
  return text + render_matrix(*ghosts.confusion) + render_ghost_tracks(ghosts, time);
}

}  // namespace boresight::report
