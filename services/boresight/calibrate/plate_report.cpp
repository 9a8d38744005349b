#include "services/boresight/calibrate/plate_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "services/boresight/calibrate/seed_json.hpp"
#include "services/boresight/svg/document.hpp"
#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::calibrate {

namespace plate = alignment::plate;

namespace {

const char* name_of(plate::FitMethod method) {
  return method == plate::FitMethod::kRobust ? "robust" : "published";
}

bool was_fitted(const plate::PlateResult& result) {
  return result.tilts_used > 0;
}

std::string degrees_with_std(double value_rad, double std_rad) {
  return text::with_std(value_rad * kDegreesPerRadian, std_rad * kDegreesPerRadian, " deg", text::Sign::kAlways);
}

/// Whether the fit has a maximum, and so a pitch, even if the run failed for another reason.
bool has_pitch(const plate::PlateResult& result) {
  return was_fitted(result) && result.failure != plate::Failure::kNoMaximum;
}

double fitted_db(const plate::PlateResult& result, double tilt_rad) {
  const auto& [b1, b2, b3] = result.parabola;
  return (b1 * tilt_rad + b2) * tilt_rad + b3;
}

json::Value parabola_of(const plate::PlateResult& result) {
  const auto fitted = [&](double value) { return was_fitted(result) ? json::significant(value) : kNaN; };
  json::Value object;
  object["b1_db_per_deg2"] = fitted(result.parabola[0] / (kDegreesPerRadian * kDegreesPerRadian));
  object["b2_db_per_deg"] = fitted(result.parabola[1] / kDegreesPerRadian);
  object["b3_db"] = fitted(result.parabola[2]);
  return object;
}

json::Value tilt_of(const PlateRun& run, std::size_t index) {
  const plate::TiltMeasurement& measured = run.measurements.tilts[index];
  const plate::TiltSummary& summary = run.result.tilts[index];
  const bool is_fitted = was_fitted(run.result);
  const auto fitted = [&](double value) { return is_fitted ? json::significant(value) : kNaN; };
  json::Value object;
  object["tilt_deg"] = json::significant(measured.tilt_rad * kDegreesPerRadian);
  object["scans"] = measured.scans;
  object["mean_db"] = json::significant(measured.amplitude.mean());
  object["std_db"] = json::significant(std::sqrt(measured.amplitude.variance()));
  object["median_db"] = fitted(summary.median_db);
  object["taken_db"] = fitted(summary.taken_db);
  object["fitted_db"] = fitted(summary.fitted_db);
  object["mean_azimuth_deg"] = json::significant(measured.azimuth.mean() * kDegreesPerRadian);
  object["azimuth_std_deg"] = json::significant(std::sqrt(measured.azimuth.variance()) * kDegreesPerRadian);
  object["used"] = is_fitted && summary.used;
  return object;
}

constexpr svg::Style kScan = svg::area_of(svg::kGrey, 0.45);
constexpr svg::Style kUsedTilt = svg::area_of(svg::kBlue);
constexpr svg::Style kRejectedTilt = {.fill = svg::kPaper, .stroke = svg::kOrange, .stroke_width_px = 2.0};
constexpr svg::Style kMaximum = svg::line_of(svg::kBlue, 1.2, "5 4");
constexpr svg::Style kMinimumAmplitude = svg::line_of(svg::kRed, 1.2, "2 3");

}  // namespace

std::string to_table(const PlateRun& run) {
  const plate::PlateResult& result = run.result;
  std::string text =
      fmt::format("plate: {} fit of {} tilts\n", name_of(result.method), run.measurements.number_of_tilts);
  text += fmt::format("{:>10} {:>6} {:>9} {:>9} {:>10} {:>9} {:>12} {:>8}\n", "tilt/deg", "scans", "mean/dB", "std/dB",
                      "taken/dB", "fit/dB", "azimuth/deg", "std/deg");
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) {
    const plate::TiltMeasurement& measured = run.measurements.tilts[i];
    text += fmt::format("{:10.3f} {:6d} {:9.3f} {:9.3f}", measured.tilt_rad * kDegreesPerRadian, measured.scans,
                        measured.amplitude.mean(), std::sqrt(measured.amplitude.variance()));
    if (was_fitted(result)) {
      text += fmt::format(" {:10.3f} {:9.3f}", result.tilts[i].taken_db, result.tilts[i].fitted_db);
    } else {
      text += fmt::format(" {:>10} {:>9}", "", "");
    }
    text += fmt::format(" {:>12} {:8.3f}", text::fixed(measured.azimuth.mean() * kDegreesPerRadian, 3),
                        std::sqrt(measured.azimuth.variance()) * kDegreesPerRadian);
    if (was_fitted(result) && !result.tilts[i].used) text += "  not used";
    text += '\n';
  }
  if (was_fitted(result)) {
    text += fmt::format("A = {:.4f} dB/deg2 tilt^2 {:+.4f} dB/deg tilt {:+.3f} dB, {} of {} tilts\n",
                        result.parabola[0] / (kDegreesPerRadian * kDegreesPerRadian),
                        result.parabola[1] / kDegreesPerRadian, result.parabola[2], result.tilts_used,
                        result.number_of_tilts);
  }
  if (has_pitch(result)) {
    text += fmt::format("pitch {} (positive: looks up), maximum {:.2f} dB\n",
                        degrees_with_std(result.pitch_rad, result.pitch_std_rad), result.maximum_db);
    text += fmt::format("yaw   {} (positive: looks left), {:.1f} % of the scans are inliers\n",
                        degrees_with_std(result.yaw_rad, result.yaw_std_rad), 100.0 * result.azimuth_inlier_ratio);
    text += fmt::format("{:.0f} % of the triples agree within {:g} deg; their median {}, spread {:.3f} deg\n",
                        100.0 * result.self_consistency,
                        std::round(run.config.consistency_rad * kDegreesPerRadian * 100.0) / 100.0,
                        text::fixed(result.triples_median_rad * kDegreesPerRadian, 3, " deg", text::Sign::kAlways),
                        result.triples_std_rad * kDegreesPerRadian);
  }
  if (result.ok()) return text + "the run is good\n";
  return text + fmt::format("FAILED: {} ({})\n", plate::explain(result.failure), plate::name_of(result.failure));
}

std::string to_json(const PlateRun& run) {
  const plate::PlateResult& result = run.result;
  const auto known = [&](double value) { return has_pitch(result) ? json::significant(value) : kNaN; };
  json::Value object;
  object["tool"] = "boresight calibrate plate";
  object["version"] = run.tool_version;
  object["source"] = run.source;
  object["method"] = name_of(result.method);
  object["ok"] = result.ok();
  object["failure"] = plate::name_of(result.failure);
  object["pitch_deg"] = known(result.pitch_rad * kDegreesPerRadian);
  object["pitch_std_deg"] = known(result.pitch_std_rad * kDegreesPerRadian);
  object["yaw_deg"] = known(result.yaw_rad * kDegreesPerRadian);
  object["yaw_std_deg"] = known(result.yaw_std_rad * kDegreesPerRadian);
  object["maximum_db"] = known(result.maximum_db);
  object["min_amplitude_db"] = json::significant(run.config.min_amplitude_db);
  object["self_consistency"] = known(result.self_consistency);
  object["triples_median_deg"] = known(result.triples_median_rad * kDegreesPerRadian);
  object["triples_std_deg"] = known(result.triples_std_rad * kDegreesPerRadian);
  object["azimuth_inlier_ratio"] = known(result.azimuth_inlier_ratio);
  object["tilts_used"] = result.tilts_used;
  object["parabola"] = parabola_of(result);
  json::Value& tilts = object["tilts"] = json::Value::array();
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) tilts.push_back(tilt_of(run, i));
  if (run.seed) object["seed"] = object_of(*run.seed);
  return json::line(object);
}

std::string to_svg(const PlateRun& run) {
  using svg::Point;
  const plate::PlateResult& result = run.result;
  double first = HUGE_VAL, last = -HUGE_VAL, low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) {
    const plate::TiltMeasurement& tilt = run.measurements.tilts[i];
    first = std::min(first, tilt.tilt_rad * kDegreesPerRadian);
    last = std::max(last, tilt.tilt_rad * kDegreesPerRadian);
    for (std::size_t k = 0; k < tilt.scans; ++k) {
      low = std::min(low, tilt.amplitude_db[k]);
      high = std::max(high, tilt.amplitude_db[k]);
    }
  }
  if (!(first <= last)) first = last = low = high = 0.0;
  const double side = 0.06 * (last - first) + 0.1, room = 0.06 * (high - low) + 0.5;
  constexpr double kWidth = 760.0, kHeight = 420.0, kHead = 86.0;
  const svg::Axis x{first - side, last + side, "tilt, degrees (positive: toward the ground)", false};
  const svg::Axis y{low - room, high + room, "amplitude, dB", false};
  svg::Chart chart(kWidth, kHeight, x, y);
  const double best_deg = -result.pitch_rad * kDegreesPerRadian, std_deg = result.pitch_std_rad * kDegreesPerRadian;
  if (has_pitch(result)) {
    chart.band({{best_deg - 2.0 * std_deg, y.min}, {best_deg + 2.0 * std_deg, y.min}},
               {{best_deg - 2.0 * std_deg, y.max}, {best_deg + 2.0 * std_deg, y.max}}, svg::kUncertainty);
  }
  if (run.config.min_amplitude_db > y.min) chart.horizontal(run.config.min_amplitude_db, kMinimumAmplitude);
  for (std::size_t i = 0; i < run.measurements.number_of_tilts; ++i) {
    const plate::TiltMeasurement& tilt = run.measurements.tilts[i];
    for (std::size_t k = 0; k < tilt.scans; ++k) {
      chart.dot({tilt.tilt_rad * kDegreesPerRadian, tilt.amplitude_db[k]}, 1.8, kScan);
    }
  }
  if (was_fitted(result)) {
    std::vector<Point> curve;
    constexpr int kPoints = 100;
    for (int i = 0; i <= kPoints; ++i) {
      const double tilt_deg = x.min + (x.max - x.min) * i / kPoints;
      curve.push_back({tilt_deg, fitted_db(result, tilt_deg / kDegreesPerRadian)});
    }
    chart.line(curve, svg::kEstimate);
    for (std::size_t i = 0; i < result.number_of_tilts; ++i) {
      const plate::TiltSummary& tilt = result.tilts[i];
      chart.dot({tilt.tilt_rad * kDegreesPerRadian, tilt.taken_db}, 4.5, tilt.used ? kUsedTilt : kRejectedTilt,
                fmt::format("{:.2f} deg: {:.2f} dB, fit {:.2f} dB", tilt.tilt_rad * kDegreesPerRadian, tilt.taken_db,
                            tilt.fitted_db));
    }
  }
  if (has_pitch(result)) chart.line({{best_deg, y.min}, {best_deg, result.maximum_db}}, kMaximum);

  const std::string verdict =
      result.ok() ? "pitch " + text::with_std(result.pitch_rad * kDegreesPerRadian, std_deg, "°", text::Sign::kAlways) +
                        ", yaw " +
                        text::with_std(result.yaw_rad * kDegreesPerRadian, result.yaw_std_rad * kDegreesPerRadian, "°",
                                       text::Sign::kAlways)
                  : fmt::format("failed: {}", plate::explain(result.failure));
  svg::Document document;
  document.title(fmt::format("Tilting plate, {} fit", name_of(result.method)));
  document.text(svg::Document::kMargin_px, 45.0, verdict, 13.0);
  document.legend_at(svg::Document::kMargin_px, 63.0);
  document.legend_entry(svg::symbol_sample(svg::Shape::kCircle, kScan), "scan");
  document.legend_entry(svg::symbol_sample(svg::Shape::kCircle, kUsedTilt), "tilt");
  document.legend_entry(svg::symbol_sample(svg::Shape::kCircle, kRejectedTilt), "tilt rejected by the fit");
  document.legend_entry(svg::line_sample(svg::kEstimate), "parabola");
  document.legend_entry(svg::area_sample(svg::kUncertainty) + svg::line_sample(kMaximum), "maximum ± 2 σ");
  if (run.config.min_amplitude_db > y.min) {
    document.legend_entry(svg::line_sample(kMinimumAmplitude), "minimum amplitude");
  }
  document.place(chart, svg::Document::kMargin_px, kHead);
  return document.finish();
}

}  // namespace boresight::calibrate
