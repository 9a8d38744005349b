#include "services/boresight/score/report_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"
#include "services/simulator/judge/scored_scene.hpp"
#include "services/simulator/judge/truth_files.hpp"

namespace boresight::score {

namespace {

using judge::FigureList;

/// Rows of cells in columns: the first to the left, the others to the right.
class Grid {
 public:
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  [[nodiscard]] std::string text() const {
    std::vector<std::size_t> widths;
    for (const auto& cells : rows_) {
      widths.resize(std::max(widths.size(), cells.size()));
      for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], text::columns(cells[i]));
    }
    std::string text;
    for (const auto& cells : rows_) {
      std::string line = "  ";
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::string blanks(widths[i] - text::columns(cells[i]), ' ');
        line += i == 0 ? cells[i] + blanks : "  " + blanks + cells[i];
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
    return text;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string percent(double share) {
  return text::fixed(100.0 * share, 1, " %");
}

std::string count(double value) {
  return std::isfinite(value) ? text::grouped(static_cast<std::uint64_t>(std::max(0.0, value)))
                              : std::string(text::kUnknown);
}

/// The names of the origins, with blanks.
std::string spaced(std::string_view word) {
  std::string name(word);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// By range band; all ranges last.
constexpr std::array<const char*, judge::kBands + 1> kShownBands = {"0-30 m", "30-60 m", "60-100 m", "all ranges"};

/// The bands in the order of the report: all ranges first.
constexpr std::array<std::size_t, judge::kBands + 1> kBandOrder = {judge::kAllBands, 0, 1, 2};

std::string detections_text(const FigureList& f) {
  constexpr std::array kShownOrigins = {Provenance::kMoving,     Provenance::kStationary, Provenance::kGhostType1,
                                        Provenance::kGhostType2, Provenance::kClutter,    Provenance::kAmbiguity,
                                        Provenance::kUnknown};
  std::string text = fmt::format("\nDetections: {} scans judged, {} without truth\n",
                                 count(f.value("detections.scans")), count(f.value("detections.scans_without_truth")));
  if (!(f.value("detections.scans") > 0.0)) return text;
  Grid confusion;
  std::vector<std::string> head = {"truth"};
  for (const Provenance label : kShownOrigins) head.push_back(spaced(judge::table_word(label)));
  head.insert(head.end(), {"rejected", "number"});
  confusion.row(head);
  for (const Provenance truth : kShownOrigins) {
    const std::string name = "detections.confusion." + std::string(judge::table_word(truth)) + ".";
    double all = f.value(name + "rejected");
    for (const Provenance label : kShownOrigins) all += f.value(name + std::string(judge::table_word(label)));
    if (!(all > 0.0)) continue;
    std::vector<std::string> cells = {spaced(judge::table_word(truth))};
    for (const Provenance label : kShownOrigins) {
      cells.push_back(percent(f.value(name + std::string(judge::table_word(label))) / all));
    }
    cells.push_back(percent(f.value(name + "rejected") / all));
    cells.push_back(count(all));
    confusion.row(cells);
  }
  text += confusion.text();
  Grid causes;
  causes.row({"cause", "number", "classified as moving"});
  bool has_causes = false;
  for (const judge::Figure& figure : f.all()) {
    constexpr std::string_view kCause = "detections.cause.", kCount = ".count";
    if (!figure.name.starts_with(kCause) || !figure.name.ends_with(kCount)) continue;
    const std::string cause = figure.name.substr(kCause.size(), figure.name.size() - kCause.size() - kCount.size());
    const double moving = f.value(std::string(kCause) + cause + ".moving");
    causes.row({spaced(cause), count(figure.value), percent(judge::share_of(moving, figure.value))});
    has_causes = true;
  }
  if (has_causes) text += "  by cause, of those not rejected:\n" + causes.text();
  text += fmt::format(
      "  {} of the detections classified as moving are moving objects; {} of the moving objects' detections are lost "
      "({} "
      "rejected)\n  false moving detections a scan: {} (90 % of the scans have at most {})\n",
      percent(f.value("detections.moving_that_is_moving_share")), percent(f.value("detections.moving_lost_share")),
      percent(f.value("detections.moving_rejected_share")), text::fixed(f.value("detections.false_moving_per_scan"), 2),
      count(f.value("detections.false_moving_per_scan_p90")));
  text +=
      fmt::format("  Brier score of p(moving) {}, of the base rate {}; mean calibration error {}\n",
                  text::fixed(f.value("detections.brier"), 4), text::fixed(f.value("detections.brier_of_base_rate"), 4),
                  text::fixed(f.value("detections.calibration_error"), 4));
  Grid reliability;
  reliability.row({"p(moving)", "number", "mean p", "moving"});
  for (const judge::Figure& figure : f.all()) {
    constexpr std::string_view kBin = "detections.reliability.", kCount = ".count";
    if (!figure.name.starts_with(kBin) || !figure.name.ends_with(kCount) || !(figure.value > 0.0)) continue;
    const std::string bin = figure.name.substr(0, figure.name.size() - kCount.size());
    std::string edges = bin.substr(kBin.size());
    std::replace(edges.begin(), edges.end(), '_', '-');
    reliability.row({edges, count(figure.value), text::fixed(f.value(bin + ".mean_probability"), 3),
                     text::fixed(f.value(bin + ".moving_share"), 3)});
  }
  return text + reliability.text();
}

std::string tracks_text(const FigureList& f) {
  std::string text =
      fmt::format("\nTracks: {} lists judged, {} without truth; {} pairs of track and object not considered\n",
                  count(f.value("tracks.lists")), count(f.value("tracks.lists_without_truth")),
                  count(f.value("tracks.pairs_not_considered")));
  if (!(f.value("tracks.lists") > 0.0)) return text;
  Grid objects;
  objects.row({"objects", "number", "found", "tracked", "delay s", "p90", "along m", "across m", "speed m/s",
               "heading °", "length m", "width m", "switches", "fragments", "in 95 %"});
  constexpr std::array<std::string_view, 5> kShownClasses = {"all", "car", "truck", "two_wheeler", "pedestrian"};
  for (const std::string_view object_class : kShownClasses) {
    for (const std::size_t band : kBandOrder) {
      const std::string name = fmt::format("tracks.{}.{}.", object_class, judge::kBandNames.at(band));
      if (!(f.value(name + "objects") > 0.0) && band != judge::kAllBands) continue;
      const auto figure = [&](const char* what, int decimals) { return text::fixed(f.value(name + what), decimals); };
      objects.row({spaced(object_class) + ", " + kShownBands.at(band), count(f.value(name + "objects")),
                   count(f.value(name + "objects_found")), percent(f.value(name + "tracked_share")),
                   figure("delay_median_s", 2), figure("delay_p90_s", 2), figure("along_rms_m", 2),
                   figure("across_rms_m", 2), figure("speed_rms_mps", 2), figure("heading_rms_deg", 1),
                   figure("length_rms_m", 2), figure("width_rms_m", 2), count(f.value(name + "identity_switches")),
                   count(f.value(name + "fragmentations")), percent(f.value(name + "inside_95_share"))});
    }
  }
  text += objects.text();
  Grid false_tracks;
  false_tracks.row({"false confirmed tracks", "≥ 0.5 s", "≥ 2 s", "at a time"});
  for (const std::size_t band : kBandOrder) {
    const std::string name = fmt::format("tracks.false.{}.", judge::kBandNames.at(band));
    false_tracks.row({kShownBands.at(band), count(f.value(name + "at_least_0.5_s")),
                      count(f.value(name + "at_least_2_s")), text::fixed(f.value(name + "mean_at_a_time"), 2)});
  }
  text += false_tracks.text();
  Grid gospa;
  gospa.row({"GOSPA a list, p 1, c 20, α 2", "total", "localisation", "missed", "false"});
  for (const auto& [name, shown] : {std::pair("squared", "squared distance"), std::pair("root", "distance")}) {
    const auto part = [&, prefix = fmt::format("tracks.gospa.{}.", name)](const char* what) {
      return text::fixed(f.value(prefix + what), 2);
    };
    gospa.row({shown, part("total"), part("localisation"), part("missed"), part("false")});
  }
  return text + gospa.text();
}

/// The numbers of the radars of which figures of this kind exist, in the order of the figures.
std::vector<std::string> radars_of(const FigureList& f, std::string_view kind, std::string_view figure_name) {
  std::vector<std::string> radars;
  const std::string prefix = std::string(kind) + ".radar_";
  for (const judge::Figure& figure : f.all()) {
    if (!figure.name.starts_with(prefix) || !figure.name.ends_with(figure_name)) continue;
    radars.push_back(figure.name.substr(prefix.size(), figure.name.find('.', prefix.size()) - prefix.size()));
  }
  return radars;
}

std::string alignment_text(const FigureList& f) {
  std::string text =
      "\nAlignment: error at the end, rms after the first 60 s, NEES at the end, about the vehicle's axes\n";
  const std::vector<std::string> radars = radars_of(f, "alignment", ".speed_scale.error");
  if (radars.empty()) return "\nAlignment: –\n";
  Grid grid;
  grid.row({"radar", "speed scale", "rms", "NEES", "x °", "rms", "NEES", "y °", "rms", "NEES", "z °", "rms", "NEES",
            "changes", "false", "missed"});
  for (const std::string& radar : radars) {
    const std::string name = "alignment.radar_" + radar + ".";
    std::vector<std::string> cells = {radar};
    for (const char* const parameter : {"speed_scale", "rotation_x", "rotation_y", "rotation_z"}) {
      const bool is_scale = std::string_view(parameter) == "speed_scale";
      const std::string suffix = is_scale ? "" : "_deg";
      const int decimals = is_scale ? 6 : 4;
      cells.push_back(text::fixed(f.value(name + parameter + ".error" + suffix), decimals, "", text::Sign::kAlways));
      cells.push_back(text::fixed(f.value(name + parameter + ".rms" + suffix), decimals));
      cells.push_back(text::fixed(f.value(name + parameter + ".nees"), 2));
    }
    for (const char* const changes : {"step_changes", "false_step_changes", "missed_step_changes"}) {
      cells.push_back(count(f.value(name + changes)));
    }
    grid.row(cells);
  }
  text += grid.text();
  for (const std::string& radar : radars) {
    const std::string name = "alignment.radar_" + radar + ".load_pitch";
    const double error_deg = f.value(name + ".error_deg");
    if (!std::isfinite(error_deg)) continue;
    text += fmt::format("  radar {}: pitch by load {}, NEES {}\n", radar,
                        text::fixed(error_deg, 4, "°", text::Sign::kAlways), text::fixed(f.value(name + ".nees"), 2));
  }
  return text + fmt::format("  false step changes an hour: {}\n",
                            text::fixed(f.value("alignment.false_step_changes_per_hour"), 1));
}

std::string health_text(const FigureList& f) {
  std::string text = "\nHealth: seconds with a wrong verdict\n";
  const std::vector<std::string> radars = radars_of(f, "health", ".judged_s");
  if (radars.empty()) return "\nHealth: –\n";
  Grid grid;
  grid.row({"radar", "judged s", "MISALIGNED though within tolerance", "not MISALIGNED though beyond",
            "tolerance yaw, pitch, roll °"});
  for (const std::string& radar : radars) {
    const std::string name = "health.radar_" + radar + ".";
    grid.row({radar, text::fixed(f.value(name + "judged_s"), 1),
              text::fixed(f.value(name + "misaligned_though_within_tolerance_s"), 1),
              text::fixed(f.value(name + "not_misaligned_though_beyond_tolerance_s"), 1),
              fmt::format("{}, {}, {}", text::fixed(f.value(name + "tolerance_yaw_deg"), 1),
                          text::fixed(f.value(name + "tolerance_pitch_deg"), 1),
                          text::fixed(f.value(name + "tolerance_roll_deg"), 1))});
  }
  grid.row({"all", text::fixed(f.value("health.judged_s"), 1),
            text::fixed(f.value("health.misaligned_though_within_tolerance_s"), 1),
            text::fixed(f.value("health.not_misaligned_though_beyond_tolerance_s"), 1)});
  return text + grid.text();
}

std::string timing_text(const FigureList& f) {
  Grid grid;
  bool has_timing = false;
  constexpr std::string_view kTiming = "timing.";
  for (const judge::Figure& figure : f.all()) {
    if (!figure.name.starts_with(kTiming)) continue;
    grid.row({figure.name.substr(kTiming.size()), fmt::format("{:.6g}", figure.value)});
    has_timing = true;
  }
  return has_timing ? "\nTime, from run.json\n" + grid.text() : "\nTime: –\n";
}

std::string notes_text(const Score& score) {
  std::string text;
  for (const std::string& note : score.notes) text += "  " + note + "\n";
  return text.empty() ? "" : "\nNotes\n" + text;
}

std::string xml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return escaped;
}

}  // namespace

Limit limit_of(const std::string& text) {
  const std::size_t sign = text.rfind('=');
  Limit limit;
  if (sign != std::string::npos) {
    limit.figure = text.substr(0, sign);
    const char* const begin = text.data() + sign + 1;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, limit.most);
    if (!limit.figure.empty() && error == std::errc{} && stop == end && std::isfinite(limit.most)) return limit;
  }
  throw std::invalid_argument("--limit: read \"" + text +
                              "\", allowed is NAME=MAX with the name of a figure and a number");
}

bool is_kept(const Limit& limit, const Score& score) {
  return score.figures.value(limit.figure) <= limit.most;
}

std::string to_text(const NamedScore& score) {
  const FigureList& f = score.score.figures;
  return fmt::format("{}: {} scans, {} s\n", score.run, count(f.value("run.scans")),
                     text::fixed(f.value("run.seconds"), 1)) +
         detections_text(f) + tracks_text(f) + alignment_text(f) + health_text(f) + timing_text(f) +
         notes_text(score.score);
}

std::string to_comparison(const std::vector<NamedScore>& scores) {
  struct Row {
    const char* name;
    const char* shown;
    int decimals;
    bool is_share;
  };
  constexpr std::array<Row, 27> kRows = {{
      {"tracks.all.all_ranges.objects", "objects in view", 0, false},
      {"tracks.all.all_ranges.found_share", "found", 1, true},
      {"tracks.all.all_ranges.tracked_share", "tracked share of the time", 1, true},
      {"tracks.car.all_ranges.tracked_share", "cars", 1, true},
      {"tracks.truck.all_ranges.tracked_share", "trucks", 1, true},
      {"tracks.two_wheeler.all_ranges.tracked_share", "two-wheelers", 1, true},
      {"tracks.pedestrian.all_ranges.tracked_share", "pedestrians", 1, true},
      {"tracks.all.0_30m.tracked_share", "0-30 m", 1, true},
      {"tracks.all.30_60m.tracked_share", "30-60 m", 1, true},
      {"tracks.all.60_100m.tracked_share", "60-100 m", 1, true},
      {"tracks.all.all_ranges.delay_median_s", "delay of the first confirmed track, median s", 2, false},
      {"tracks.false.all_ranges.at_least_0.5_s", "false confirmed tracks of at least 0.5 s", 0, false},
      {"tracks.false.all_ranges.at_least_2_s", "of at least 2 s", 0, false},
      {"tracks.false.all_ranges.mean_at_a_time", "at a time", 2, false},
      {"tracks.duplicates.mean_at_a_time", "duplicate tracks at a time", 2, false},
      {"tracks.all.all_ranges.along_rms_m", "error along m", 2, false},
      {"tracks.all.all_ranges.across_rms_m", "error across m", 2, false},
      {"tracks.all.all_ranges.speed_rms_mps", "error of speed m/s", 2, false},
      {"tracks.all.all_ranges.heading_rms_deg", "error of heading °", 1, false},
      {"tracks.all.all_ranges.length_rms_m", "error of length m", 2, false},
      {"tracks.all.all_ranges.width_rms_m", "error of width m", 2, false},
      {"tracks.all.all_ranges.identity_switches", "identity switches", 0, false},
      {"tracks.all.all_ranges.fragmentations", "fragmentations", 0, false},
      {"tracks.all.all_ranges.inside_95_share", "errors inside the 95 % ellipse", 1, true},
      {"tracks.gospa.squared.total", "GOSPA, squared distance", 2, false},
      {"tracks.gospa.root.total", "GOSPA, distance", 2, false},
      {"detections.false_moving_per_scan", "false moving detections a scan", 2, false},
  }};
  Grid grid;
  std::vector<std::string> head = {""};
  for (const NamedScore& each : scores) head.push_back(each.run);
  grid.row(head);
  for (const Row& row : kRows) {
    std::vector<std::string> cells = {row.shown};
    for (const NamedScore& each : scores) {
      const double value = each.score.figures.value(row.name);
      cells.push_back(row.is_share ? percent(value) : text::fixed(value, row.decimals));
    }
    grid.row(cells);
  }
  std::string text = grid.text();
  for (const NamedScore& each : scores) {
    for (const std::string& note : each.score.notes) text += "  " + each.run + ": " + note + "\n";
  }
  return text;
}

std::string to_junit(const std::vector<NamedScore>& scores, const std::vector<Limit>& limits) {
  std::size_t failures = 0;
  std::string cases;
  for (const NamedScore& each : scores) {
    for (const Limit& limit : limits) {
      const double value = each.score.figures.value(limit.figure);
      const std::string shown = std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(text::kUnknown);
      cases +=
          fmt::format("  <testcase classname=\"{}\" name=\"{} ≤ {:g}\">", xml(each.run), xml(limit.figure), limit.most);
      if (!is_kept(limit, each.score)) {
        ++failures;
        cases += fmt::format("<failure message=\"{} is {}, allowed is at most {:g}\"/>", xml(limit.figure), shown,
                             limit.most);
      } else {
        cases += fmt::format("<system-out>{}</system-out>", shown);
      }
      cases += "</testcase>\n";
    }
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"boresight score\" tests=\"{}\" "
      "failures=\"{}\">\n{}"
      "</testsuite>\n",
      scores.size() * limits.size(), failures, cases);
}

}  // namespace boresight::score
