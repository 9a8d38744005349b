// Labels beside the truth, and tracks that followed ghosts.
#include <fmt/format.h>

#include "services/boresight/report/sections/label_style.hpp"
#include "services/boresight/report/sections/sections.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::report {

namespace {

std::string render_matrix(const judge::Confusion& confusion) {
  std::string text = "<div class=\"wide\"><table><tr><th>truth</th><th class=n>detections</th>";
  for (const LabelStyle& style : kLabelStyles)
    text += fmt::format("<th class=n>{}{}</th>", style.label == Provenance::kUnknown ? "" : "as ", style.words);
  text += "<th class=n>as a ghost of any type</th><th class=n>rejected before</th></tr>\n";
  for (const Provenance truth : kOrigins) {
    const std::uint64_t count = confusion.count(truth);
    // The truth of a simulated drive names no ambiguities.
    if (truth == Provenance::kAmbiguity && count + confusion.rejected(truth) == 0) continue;
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
                        text::fixed(confusion.percent_ghost(truth), 2, " %"), confusion.rejected(truth));
  }
  return text + "</table></div>\n";
}

std::string render_ghost_tracks(const GhostFindings& ghosts, const TimeBase& time) {
  std::string text = fmt::format(
      "<h3>Tracks that followed ghosts</h3>\n<p class=\"faint\">Tracks and true objects are matched as nearest pairs, "
      "at most 3 m apart; a track inside a true box is only matched to that object. A confirmed track without an "
      "object "
      "follows a ghost in a scan if most detections around it are ghosts in truth. Counted for this are the detections "
      "within {:.0f} m of its box that were classified as moving. The table lists tracks that followed a ghost for "
      "more "
      "than {} scans in total, among {} track lists.</p>\n",
      judge::FalseTracks::kEvidenceDistance_m, judge::FalseTracks::kMaxTolerated_scans, ghosts.scans);
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
  return text +
         fmt::format(" Other false tracks, of clutter or of stationary objects: {}.</p>\n", ghosts.other_false_tracks);
}

}  // namespace

std::string render_confusion(const ReportInput& input, const TimeBase& time) {
  const GhostFindings& ghosts = input.ghosts;
  std::string text = "<h2>Ghost filter: comparison with the truth</h2>\n";
  if (!ghosts.problem.empty()) {
    text += fmt::format(
        "<p><span class=\"bad\">The tables of scans could not be read to their end</span>; the rest is missing in this "
        "section and in the views: <code>{}</code></p>\n",
        escape(ghosts.problem));
    if (ghosts.scans == 0) return text + "<p>No scan could be read.</p>\n";
  }
  if (ghosts.scans == 0) {
    return text +
           "<p>This run has no table of its scans, so there is no comparison and no view of them. <code>boresight "
           "monitor --record</code> records them.</p>\n";
  }
  if (!ghosts.confusion) {
    return text +
           "<p>The true provenance of this drive's detections is not known, so the labels above cannot be "
           "checked.</p>\n";
  }
  text += fmt::format(
      "<p class=\"faint\">Rows: true provenance. Columns: label of the ghost filter, in percent of the row. Detections "
      "that the corrector rejected are counted in the last column only. {} published scans were matched to the truth "
      "by "
      "measurement time and number of detections; {} could not be matched.</p>\n",
      text::grouped(ghosts.compared_scans), text::grouped(ghosts.unknown_scans));
  return text + render_matrix(*ghosts.confusion) + render_ghost_tracks(ghosts, time);
}

}  // namespace boresight::report
