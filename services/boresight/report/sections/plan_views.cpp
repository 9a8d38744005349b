// Scans seen from above, as they were published.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/report/sections/label_style.hpp"
#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

namespace {

constexpr double kSymbol_px = 3.2;
constexpr svg::Style kRejected = svg::line_of(svg::kGrey, 1.0);
constexpr svg::Style kWrong = svg::line_of(svg::kInk, 1.3);
constexpr svg::Style kReflector = svg::line_of(svg::kGrey, 2.5);
constexpr svg::Style kTrackBox = svg::line_of(svg::kInk, 1.4);
constexpr svg::Style kTrueBox = {
    .fill = svg::kBlue, .fill_opacity = 0.15, .stroke = svg::kViolet, .stroke_width_px = 1.2, .dashes = "4 3"};
constexpr svg::Style kSensor = {.fill = svg::kRed, .stroke = svg::kPaper};

std::vector<Point> corners(double x, double y, double heading_rad, double length_m, double width_m) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  std::vector<Point> points;
  for (const auto& [along, across] : {Point{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}}) {
    points.push_back(
        {x + c * along * length_m - s * across * width_m, y + s * along * length_m + c * across * width_m});
  }
  return points;
}

/// The part that is shown: everything that is not stationary, with its surroundings.
struct Extent {
  double back_m = -25.0, ahead_m = 35.0, right_m = -12.0, left_m = 12.0;
  [[nodiscard]] bool shows(double x, double y) const {
    return x >= back_m && x <= ahead_m && y >= right_m && y <= left_m;
  }
  void take(double x, double y) {
    constexpr double kAlong_m = 200.0, kAcross_m = 45.0, kMargin_m = 4.0;  // anything farther is cut off
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    ahead_m = std::max(ahead_m, std::min(x + kMargin_m, kAlong_m));
    back_m = std::min(back_m, std::max(x - kMargin_m, -kAlong_m));
    left_m = std::max(left_m, std::min(y + kMargin_m, kAcross_m));
    right_m = std::min(right_m, std::max(y - kMargin_m, -kAcross_m));
  }
};

std::string tooltip(const PlanView::Detection& d) {
  std::string text =
      fmt::format("radar {}: {}", d.radar, d.rejected ? "rejected by the corrector" : style_of(d.label).words);
  if (d.truth) text += fmt::format(", truth: {}", style_of(*d.truth).words);
  return text + fmt::format("; {:.1f} m ahead, {:.1f} m left, {:+.1f} m/s over ground, ghost probability {:.2f}", d.x_m,
                            d.y_m, d.range_rate_over_ground_mps, d.ghost_probability);
}

/// Drawn large, and the view covers it; the rest is drawn small.
bool stands_out(const PlanView::Detection& d) {
  return !d.rejected && d.label != Provenance::kStationary;
}

Extent extent_of(const PlanView& view) {
  Extent extent;
  for (const PlanView::Detection& d : view.detections) {
    if (stands_out(d)) extent.take(d.x_m, d.y_m);
  }
  for (const PlanView::Box& box : view.tracks) extent.take(box.x_m, box.y_m);
  return extent;
}

std::string draw(const PlanView& view, const Extent& extent) {
  // The same scale along both axes; the margins of the chart are 64 px across and 46 px down.
  const double px_per_m = (1080.0 - 64.0) / (extent.ahead_m - extent.back_m);
  Chart chart(1080, 46.0 + (extent.left_m - extent.right_m) * px_per_m,
              {.min = extent.back_m, .max = extent.ahead_m, .label = "ahead, m"},
              {.min = extent.right_m, .max = extent.left_m, .label = "left, m"});
  for (const judge::Object& o : view.objects) {
    chart.polygon(corners(o.position_m.x(), o.position_m.y(), o.heading_rad, o.length_m, o.width_m), kTrueBox,
                  fmt::format("true object {}", o.id));
  }
  for (const ReflectorSegment& s : view.segments) {
    chart.line({{s.start_vehicle_m[0], s.start_vehicle_m[1]}, {s.end_vehicle_m[0], s.end_vehicle_m[1]}}, kReflector);
  }
  chart.rectangle({-1.0, -0.9}, {3.7, 0.9}, svg::area_of(svg::kInk), "the vehicle");
  // Stationary and rejected detections first, so that they do not hide the others.
  for (const bool still : {true, false}) {
    for (const PlanView::Detection& d : view.detections) {
      if (stands_out(d) == still) continue;
      const LabelStyle& style = style_of(d.label);
      const auto shape = d.rejected ? svg::Shape::kSquare : style.shape;
      chart.symbol({d.x_m, d.y_m}, shape, still ? 2.0 : kSymbol_px, d.rejected ? kRejected : style.symbol(),
                   tooltip(d));
      if (!d.rejected && d.truth && *d.truth != d.label) {
        chart.symbol({d.x_m, d.y_m}, svg::Shape::kCircle, 2.2 * kSymbol_px, kWrong, tooltip(d));
      }
    }
  }
  for (const PlanView::Box& box : view.tracks) {
    chart.polygon(corners(box.x_m, box.y_m, box.heading_rad, box.length_m, box.width_m), kTrackBox,
                  fmt::format("track #{}", box.tracking_id));
  }
  for (const PlanView::Sensor& sensor : view.sensors) {
    chart.symbol(
        {sensor.x_m, sensor.y_m}, svg::Shape::kTriangle, 4.5, kSensor,
        fmt::format("radar {}; its scan is {:.0f} ms older than the latest", sensor.radar, 1e3 * sensor.age_s));
  }
  return chart.finish();
}

std::string render(const std::string& what, const PlanView& view, const TimeBase& time) {
  const Extent extent = extent_of(view);
  std::size_t wrong = 0, ghosts = 0, compared = 0, outside = 0;
  double oldest_s = 0.0;
  for (const PlanView::Detection& d : view.detections) {
    if (d.rejected) continue;
    ghosts += d.label == Provenance::kGhostType1 || d.label == Provenance::kGhostType2 ? 1 : 0;
    outside += stands_out(d) && !extent.shows(d.x_m, d.y_m) ? 1 : 0;
    if (d.truth) ++compared;
    if (d.truth && *d.truth != d.label) ++wrong;
  }
  for (const PlanView::Sensor& sensor : view.sensors) oldest_s = std::max(oldest_s, sensor.age_s);
  std::string text = fmt::format(
      "<h3>{}: at {:.2f} s</h3>\n<p class=\"faint\">Scans: {}, up to {:.0f} ms apart; detections: {}, {} of them "
      "classified as ghosts",
      what, time.seconds(view.time_ns), view.sensors.size(), 1e3 * oldest_s, view.detections.size(), ghosts);
  if (compared > 0) text += fmt::format("; {} of {} labels differ from the truth", wrong, compared);
  if (outside > 0) text += fmt::format("; {} detections that are not stationary lie outside the view", outside);
  return text +
         fmt::format(". Confirmed tracks: {}, {:.0f} ms older than the latest scan.</p>\n", view.tracks.size(),
                     1e3 * view.tracks_age_s) +
         draw(view, extent);
}

}  // namespace

std::string render_plan_views(const ReportInput& input, const TimeBase& time) {
  const GhostFindings& ghosts = input.ghosts;
  if (ghosts.scans == 0) return {};  // the section before states the reason
  std::string text =
      "<h2>Ghost filter: scans from above</h2>\n<p class=\"faint\">The latest scan of each radar as published, each in "
      "the vehicle frame at its own measurement time. Hover over a symbol for its values.</p>\n<p class=\"legend\">";
  for (const LabelStyle& style : kLabelStyles) text += key_of(style);
  const auto key = [](svg::Shape shape, const svg::Style& style) {
    return svg::page_key(svg::symbol_sample(shape, style));
  };
  text += key(svg::Shape::kSquare, kRejected) + "rejected by the corrector" + key(svg::Shape::kDash, kReflector) +
          "reflector" + key(svg::Shape::kBox, kTrackBox) + "confirmed track" + key(svg::Shape::kTriangle, kSensor) +
          "radar";
  if (ghosts.confusion) {
    text += key(svg::Shape::kCircle, kWrong) + "label differs from the truth" + key(svg::Shape::kBox, kTrueBox) +
            "true object";
  }
  text += "</p>\n";
  if (ghosts.most_ghosts.detections.empty()) return text + "<p>No detection was classified as a ghost.</p>\n";
  text += render("Most detections classified as ghosts", ghosts.most_ghosts, time);
  if (!ghosts.most_mistakes.detections.empty())
    text += render(fmt::format("Most wrong labels after the first {:.0f} s", GhostFindings::kFirstMoments_s),
                   ghosts.most_mistakes, time);
  return text;
}

}  // namespace boresight::report
