#include "services/boresight/track/filter_figure.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "services/boresight/svg/document.hpp"
#include "services/boresight/track/filter_errors.hpp"

namespace boresight::track {

namespace {

using svg::Axis;
using svg::Chart;
using svg::Point;

constexpr double kWidth_px = 520.0, kHeight_px = 230.0, kTitle_px = 20.0, kHead_px = 60.0;
constexpr double kMarker_px = 1.4;
constexpr svg::Style kMeasured = svg::area_of(svg::kGrey, 0.9);

/// Curves of one quantity.
struct Curves {
  std::vector<Point> measured, filtered, truth;
  std::vector<Point> measured_error, filtered_error, lower, upper;
};

Curves curves_of(Eigen::Index quantity, const RadarMeasurements& measurements, const FilterRun& run, double step_s) {
  const double factor = kQuantities[static_cast<std::size_t>(quantity)].factor;
  const bool has_truth = !measurements.truth.empty();
  Curves curves;
  for (std::size_t i = 0; i < measurements.rows.size(); ++i) {
    const double time_s = static_cast<double>(measurements.rows[i].step - measurements.rows.front().step) * step_s;
    const auto add = [&](std::vector<Point>& points, double value) { points.push_back({time_s, factor * value}); };
    const Eigen::Vector3d measured = value_of(measurements.rows[i]);
    add(curves.measured, measured(quantity));
    const Eigen::Vector3d truth = has_truth ? seen_from_origin(measurements.truth[i]) : Eigen::Vector3d::Zero();
    if (has_truth) {
      add(curves.truth, truth(quantity));
      add(curves.measured_error, difference_of_values(measured, truth)(quantity));
    }
    if (i == 0 || i > run.estimates.size()) continue;
    const auto& estimate = run.estimates[i - 1];
    const Eigen::Vector3d filtered = seen_from_origin(estimate.mean);
    add(curves.filtered, filtered(quantity));
    if (!has_truth) continue;
    const double error = difference_of_values(filtered, truth)(quantity),
                 std = std_seen_from_origin(estimate)(quantity);
    add(curves.filtered_error, error);
    add(curves.lower, -2.0 * std);
    add(curves.upper, 2.0 * std);
  }
  return curves;
}

Axis axis_around(std::initializer_list<const std::vector<Point>*> curves, const std::string& label) {
  constexpr double kRoom = 0.06;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::vector<Point>* curve : curves) {
    for (const Point& point : *curve) {
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
  }
  const double room = kRoom * (high - low);
  return {low - room, high + room, label, false};
}

void draw_points(Chart& chart, const std::vector<Point>& points) {
  for (const Point& point : points) chart.dot(point, kMarker_px, kMeasured);
}

}  // namespace

std::string filter_svg(std::string_view filter, const RadarMeasurements& measurements, const FilterRun& run,
                       double step_s) {
  const bool has_truth = !measurements.truth.empty();
  const auto steps = static_cast<double>(measurements.rows.back().step - measurements.rows.front().step);
  const Axis time{0.0, steps * step_s, "time since the first measurement, s", false};
  svg::Document document;
  document.title(fmt::format("Filter {}: one object, measured by one radar", filter));
  document.legend_at(svg::Document::kMargin_px, 38.0);
  document.legend_entry(svg::symbol_sample(svg::Shape::kCircle, kMeasured), "measured");
  document.legend_entry(svg::line_sample(svg::kEstimate), "filtered");
  if (has_truth) {
    document.legend_entry(svg::line_sample(svg::kTruth), "true");
    document.legend_entry(svg::area_sample(svg::kUncertainty), "± 2 σ of the filter");
  }
  for (std::size_t i = 0; i < kQuantities.size(); ++i) {
    const Quantity& quantity = kQuantities[i];
    const Curves curves = curves_of(static_cast<Eigen::Index>(i), measurements, run, step_s);
    const double top_px = kHead_px + static_cast<double>(i) * (kTitle_px + kHeight_px);
    Chart values(kWidth_px, kHeight_px, time, axis_around({&curves.measured, &curves.filtered}, quantity.unit));
    draw_points(values, curves.measured);
    values.line(curves.filtered, svg::kEstimate);
    values.line(curves.truth, svg::kTruth);
    document.text(svg::Document::kMargin_px, top_px + 14.0, quantity.name);
    document.place(values, svg::Document::kMargin_px, top_px + kTitle_px);
    if (!has_truth) continue;
    const double left_px = 2.0 * svg::Document::kMargin_px + kWidth_px;
    Chart errors(kWidth_px, kHeight_px, time, axis_around({&curves.measured_error}, quantity.unit));
    errors.band(curves.lower, curves.upper, svg::kUncertainty);
    draw_points(errors, curves.measured_error);
    errors.line(curves.filtered_error, svg::kEstimate);
    errors.horizontal(0.0, svg::kTruth);
    document.text(left_px, top_px + 14.0, fmt::format("error of the {}", quantity.name));
    document.place(errors, left_px, top_px + kTitle_px);
  }
  return document.finish();
}

}  // namespace boresight::track
