#include "services/boresight/calibrate/plate_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "services/boresight/calibrate/seed_json.hpp"
#include "services/boresight/report/svg_chart.hpp"

namespace boresight::calibrate {

namespace plate = alignment::plate;

namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

const char* name_of(plate::FitMethod method) {
  return method == plate::FitMethod::kRobust ? "robust" : "published";
}

bool was_fitted(const plate::PlateResult& result) {
  return result.tilts_used > 0;
}

/// Whether the fit has a maximum, and so a pitch, even if the run failed for another reason.
bool has_pitch(const plate::PlateResult& result) {
  return was_fitted(result) && result.failure != plate::Failure::kNoMaximum;
}

double fitted_db(const plate::PlateResult& result, double tilt_rad) {
  const auto& [b1, b2, b3] = result.parabola;
  return (b1 * tilt_rad + b2) * tilt_rad + b3;
}

constexpr std::string_view kStyle = R"(<style>
svg { --paper: #ffffff; --ink: #1c232d; --faint: #5d6a7a; --line: #dfe4ea; --blue: #2563b8; --band: #2563b833;
  --warn: #b87400; --idle: #8d97a5; font-family: system-ui, sans-serif; }
@media (prefers-color-scheme: dark) { svg { --paper: #14181e; --ink: #e4e8ee; --faint: #9aa5b4; --line: #323a46;
  --blue: #6ea8ff; --band: #6ea8ff40; --warn: #e5a63a; --idle: #7f8a99; } }
.paper { fill: var(--paper); } .head { fill: var(--ink); font-size: 17px; font-weight: 600; }
.verdict { fill: var(--ink); font-size: 13px; } .legend { fill: var(--faint); font-size: 12px; }
.chart text { fill: var(--faint); font-size: 11px; }
.grid { stroke: var(--line); stroke-width: 1; } .frame { fill: none; stroke: var(--line); }
.scan { fill: var(--idle); opacity: 0.45; } .used { fill: var(--blue); }
.unused { fill: var(--paper); stroke: var(--warn); stroke-width: 2; }
.fit { stroke: var(--blue); stroke-width: 1.8; } .sigma { fill: var(--band); stroke: none; }
.maximum { stroke: var(--blue); stroke-width: 1.2; stroke-dasharray: 5 4; }
.limit { stroke: var(--warn); stroke-width: 1.2; stroke-dasharray: 2 3; }
</style>
)";

}  // namespace

std::string to_table(const PlateRun& run) {
  const plate::PlateResult& result = run.result;
  std::string text =
      fmt::format("plate: {} fit of {} tilts\n", name_of(result.method), run.measurements.number_of_tilts);
  text += fmt::format("{:>10} {:>6} {:>9} {:>9} {:>10} {:>9} {:>12} {:>8}\n", "tilt/deg", "scans", "mean/dB", "std/dB",
                      "taken/dB", "fit/dB", "azimuth/deg", "std/deg");
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) {
    const plate::TiltMeasurement& measured = run.measurements.tilts[i];
    text += fmt::format("{:10.3f} {:6d} {:9.3f} {:9.3f}", measured.tilt_rad * kDegrees, measured.scans,
                        measured.amplitude.mean(), std::sqrt(measured.amplitude.variance()));
    if (was_fitted(result)) {
      text += fmt::format(" {:10.3f} {:9.3f}", result.tilts[i].taken_db, result.tilts[i].fitted_db);
    } else {
      text += fmt::format(" {:>10} {:>9}", "", "");
    }
    text += fmt::format(" {:12.3f} {:8.3f}", measured.azimuth.mean() * kDegrees,
                        std::sqrt(measured.azimuth.variance()) * kDegrees);
    if (was_fitted(result) && !result.tilts[i].used) text += "  left out";
    text += '\n';
  }
  if (was_fitted(result)) {
    text += fmt::format("A = {:.4f} dB/deg2 tilt^2 {:+.4f} dB/deg tilt {:+.3f} dB, {} of {} tilts\n",
                        result.parabola[0] / (kDegrees * kDegrees), result.parabola[1] / kDegrees, result.parabola[2],
                        result.tilts_used, result.number_of_tilts);
  }
  if (has_pitch(result)) {
    text += fmt::format("pitch {:+.3f} ± {:.3f} deg (positive looks up), maximum {:.2f} dB\n",
                        result.pitch_rad * kDegrees, result.pitch_std_rad * kDegrees, result.maximum_db);
    text += fmt::format("yaw   {:+.3f} ± {:.3f} deg (positive looks left), {:.1f} % of the scans believed\n",
                        result.yaw_rad * kDegrees, result.yaw_std_rad * kDegrees, 100.0 * result.azimuth_inlier_ratio);
    text +=
        fmt::format("{:.0f} % of the triples agree within {:g} deg; their median {:+.3f} deg, spread {:.3f} deg\n",
                    100.0 * result.self_consistency, std::round(run.config.consistency_rad * kDegrees * 100.0) / 100.0,
                    result.triples_median_rad * kDegrees, result.triples_std_rad * kDegrees);
  }
  if (result.ok()) return text + "the run is good\n";
  return text + fmt::format("FAILED: {} ({})\n", plate::explain(result.failure), plate::name_of(result.failure));
}

std::string to_json(const PlateRun& run) {
  const plate::PlateResult& result = run.result;
  const auto known = [&](double value) { return has_pitch(result) ? value : kNaN; };
  align::JsonWriter json;
  json.begin_object().field("tool", "boresight calibrate plate").field("version", run.tool_version);
  json.field("source", run.source).field("method", name_of(result.method));
  json.field("ok", result.ok()).field("failure", plate::name_of(result.failure));
  json.field("pitch_deg", known(result.pitch_rad * kDegrees));
  json.field("pitch_std_deg", known(result.pitch_std_rad * kDegrees));
  json.field("yaw_deg", known(result.yaw_rad * kDegrees)).field("yaw_std_deg", known(result.yaw_std_rad * kDegrees));
  json.field("maximum_db", known(result.maximum_db)).field("min_amplitude_db", run.config.min_amplitude_db);
  json.field("self_consistency", known(result.self_consistency));
  json.field("triples_median_deg", known(result.triples_median_rad * kDegrees));
  json.field("triples_std_deg", known(result.triples_std_rad * kDegrees));
  json.field("azimuth_inlier_ratio", known(result.azimuth_inlier_ratio));
  json.field("tilts_used", std::uint64_t{result.tilts_used});
  json.key("parabola").begin_object();
  const bool fitted = was_fitted(result);
  json.field("b1_db_per_deg2", fitted ? result.parabola[0] / (kDegrees * kDegrees) : kNaN);
  json.field("b2_db_per_deg", fitted ? result.parabola[1] / kDegrees : kNaN);
  json.field("b3_db", fitted ? result.parabola[2] : kNaN).end_object();
  json.key("tilts").begin_array();
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) {
    const plate::TiltMeasurement& measured = run.measurements.tilts[i];
    json.begin_object().field("tilt_deg", measured.tilt_rad * kDegrees).field("scans", std::uint64_t{measured.scans});
    json.field("mean_db", measured.amplitude.mean()).field("std_db", std::sqrt(measured.amplitude.variance()));
    json.field("median_db", fitted ? result.tilts[i].median_db : kNaN);
    json.field("taken_db", fitted ? result.tilts[i].taken_db : kNaN);
    json.field("fitted_db", fitted ? result.tilts[i].fitted_db : kNaN);
    json.field("mean_azimuth_deg", measured.azimuth.mean() * kDegrees);
    json.field("azimuth_std_deg", std::sqrt(measured.azimuth.variance()) * kDegrees);
    json.field("used", fitted && result.tilts[i].used).end_object();
  }
  json.end_array();
  if (run.seed) write_seed(json, *run.seed);
  return json.end_object().text() + "\n";
}

std::string to_svg(const PlateRun& run) {
  using report::Point;
  const plate::PlateResult& result = run.result;
  double first = HUGE_VAL, last = -HUGE_VAL, low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) {
    const plate::TiltMeasurement& tilt = run.measurements.tilts[i];
    first = std::min(first, tilt.tilt_rad * kDegrees);
    last = std::max(last, tilt.tilt_rad * kDegrees);
    for (std::size_t k = 0; k < tilt.scans; ++k) {
      low = std::min(low, tilt.amplitude_db[k]);
      high = std::max(high, tilt.amplitude_db[k]);
    }
  }
  if (!(first <= last)) first = last = low = high = 0.0;
  const double side = 0.06 * (last - first) + 0.1, room = 0.06 * (high - low) + 0.5;
  constexpr double kWidth = 760.0, kHeight = 420.0, kHead = 86.0;
  const report::Axis x{first - side, last + side, "tilt, degrees (positive: toward the ground)", false};
  const report::Axis y{low - room, high + room, "amplitude, dB", false};
  report::SvgChart chart(kWidth, kHeight, x, y);
  const double best_deg = -result.pitch_rad * kDegrees, std_deg = result.pitch_std_rad * kDegrees;
  if (has_pitch(result)) {
    chart.band({{best_deg - 2.0 * std_deg, y.min}, {best_deg + 2.0 * std_deg, y.min}},
               {{best_deg - 2.0 * std_deg, y.max}, {best_deg + 2.0 * std_deg, y.max}}, "sigma");
  }
  if (run.config.min_amplitude_db > y.min) chart.horizontal(run.config.min_amplitude_db, "limit");
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) {
    const plate::TiltMeasurement& tilt = run.measurements.tilts[i];
    for (std::size_t k = 0; k < tilt.scans; ++k) {
      chart.dot({tilt.tilt_rad * kDegrees, tilt.amplitude_db[k]}, 1.8, "scan");
    }
  }
  if (was_fitted(result)) {
    std::vector<Point> curve;
    constexpr int kPoints = 100;
    for (int i = 0; i <= kPoints; ++i) {
      const double tilt_deg = x.min + (x.max - x.min) * i / kPoints;
      curve.push_back({tilt_deg, fitted_db(result, tilt_deg / kDegrees)});
    }
    chart.line(curve, "fit");
    for (std::size_t i = 0; i < result.number_of_tilts; ++i) {
      const plate::TiltSummary& tilt = result.tilts[i];
      chart.dot(
          {tilt.tilt_rad * kDegrees, tilt.taken_db}, 4.5, tilt.used ? "used" : "unused",
          fmt::format("{:.2f} deg: {:.2f} dB, fit {:.2f} dB", tilt.tilt_rad * kDegrees, tilt.taken_db, tilt.fitted_db));
    }
  }
  if (has_pitch(result)) chart.line({{best_deg, y.min}, {best_deg, result.maximum_db}}, "maximum");

  const std::string verdict =
      result.ok() ? fmt::format("pitch {:+.3f} ± {:.3f}°, yaw {:+.3f} ± {:.3f}°", result.pitch_rad * kDegrees, std_deg,
                                result.yaw_rad * kDegrees, result.yaw_std_rad * kDegrees)
                  : fmt::format("failed: {}", plate::explain(result.failure));
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n"
      "{2}<rect class=\"paper\" width=\"{0:.0f}\" height=\"{1:.0f}\"/>\n"
      "<text class=\"head\" x=\"14\" y=\"24\">Tilting plate, {3} fit</text>\n"
      "<text class=\"verdict\" x=\"14\" y=\"45\">{4}</text>\n",
      kWidth + 28.0, kHead + kHeight + 14.0, kStyle, name_of(result.method), report::escape(verdict));
  double at = 14.0;
  const auto entry = [&](const std::string& sample, const char* meaning, double width) {
    text += fmt::format(
        "<g transform=\"translate({:.0f},63)\">{}</g><text class=\"legend\" x=\"{:.0f}\" y=\"72\">{}</text>\n", at,
        sample, at + 30.0, meaning);
    at += width;
  };
  entry(R"(<circle class="scan" cx="12" cy="5" r="1.8"/>)", "scan", 75.0);
  entry(R"(<circle class="used" cx="12" cy="5" r="4.5"/>)", "tilt", 75.0);
  entry(R"(<circle class="unused" cx="12" cy="5" r="4.5"/>)", "tilt left out", 125.0);
  entry(R"(<path class="fit" d="M0,5H24"/>)", "parabola", 105.0);
  entry(R"(<rect class="sigma" width="24" height="10"/><path class="maximum" d="M12,0V10"/>)", "maximum ± 2 σ", 135.0);
  if (run.config.min_amplitude_db > y.min) entry(R"(<path class="limit" d="M0,5H24"/>)", "limit of the maximum", 150.0);
  return text + chart.finish_at(14.0, kHead) + "</svg>\n";
}

}  // namespace boresight::calibrate
