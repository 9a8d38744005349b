#include "services/boresight/align/plot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "services/boresight/report/svg_chart.hpp"

namespace boresight::align {

namespace {

using report::Axis;
using report::Point;
using report::SvgChart;

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kWidth = 390.0, kHeight = 215.0, kTitle = 20.0, kMargin = 14.0, kHead = 54.0;
constexpr std::size_t kColumns = 4;

constexpr std::string_view kStyle = R"(<style>
svg { --paper: #ffffff; --ink: #1c232d; --faint: #5d6a7a; --line: #dfe4ea; --blue: #2563b8; --band: #2563b833;
  --truth: #8a3fb0; --warn: #b87400; --idle: #8d97a5; font-family: system-ui, sans-serif; }
@media (prefers-color-scheme: dark) { svg { --paper: #14181e; --ink: #e4e8ee; --faint: #9aa5b4; --line: #323a46;
  --blue: #6ea8ff; --band: #6ea8ff40; --truth: #d08cf2; --warn: #e5a63a; --idle: #7f8a99; } }
.paper { fill: var(--paper); } .head { fill: var(--ink); font-size: 17px; font-weight: 600; }
.title { fill: var(--ink); font-size: 12px; } .legend { fill: var(--faint); font-size: 12px; }
.chart text { fill: var(--faint); font-size: 11px; }
.grid { stroke: var(--line); stroke-width: 1; } .frame { fill: none; stroke: var(--line); }
.estimate { stroke: var(--blue); stroke-width: 1.6; } .sigma { fill: var(--band); stroke: none; }
.unknown { stroke: var(--idle); stroke-width: 1.6; stroke-dasharray: 2 3; }
.truth { stroke: var(--truth); stroke-width: 1.5; stroke-dasharray: 6 4; }
.knock { stroke: var(--warn); stroke-width: 1.2; stroke-dasharray: 4 3; } .chart .note { fill: var(--warn); }
.before { stroke: var(--idle); stroke-width: 1.6; } .after { fill: var(--band); stroke: var(--blue); stroke-width: 1.2; }
</style>
)";

/// What one chart of a parameter shows, in the unit of its axis.
struct Curve {
  std::string title, unit, axis;  // the axis is called by its unit, unless it has a name of its own
  int decimals = 3;
  double smallest_span = 0.01;
  std::vector<Point> truth;  // (from when on, value); the last is true at the end
  std::function<double(const Sample&)> value, std;
  std::function<bool(const Sample&)> observable;
};

std::string number(double value, int decimals, const std::string& unit, bool with_sign) {
  const std::string text =
      with_sign ? fmt::format("{:+.{}f}", value, decimals) : fmt::format("{:.{}f}", value, decimals);
  return text + (unit.empty() || unit.front() == "°"[0] ? "" : " ") + unit;
}

class Picture {
 public:
  explicit Picture(const Result& result) : result_(result) {
    for (const Sample& sample : result.series) x_max_ = std::max(x_max_, x(sample));
  }

  std::string draw() {
    shared();
    for (std::size_t i = 0; i < result_.radars.size(); ++i) radar(i);
    const double width = kMargin + kColumns * (kWidth + kMargin);
    const double height = kHead + static_cast<double>(row_ + (column_ > 0 ? 1 : 0)) * (kTitle + kHeight) + kMargin;
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\">\n{2}<rect class=\"paper\" width=\"{0:.0f}\" height=\"{1:.0f}\"/>\n{3}{4}</svg>\n",
        width, height, kStyle, head(), body_);
  }

 private:
  [[nodiscard]] double x(const Sample& sample) const {
    return result_.x_is_iteration ? sample.x / 1000.0 : sample.x - result_.start_s;
  }
  [[nodiscard]] Axis x_axis() const {
    return {0.0, std::max(x_max_, 1.0), result_.x_is_iteration ? "thousand iterations" : "time since the first scan, s",
            false};
  }

  [[nodiscard]] std::string head() const {
    std::string text = fmt::format("<text class=\"head\" x=\"{}\" y=\"24\">Alignment of {} by {}</text>\n", kMargin,
                                   report::escape(result_.vehicle), report::escape(result_.method));
    double at = kMargin;
    const auto entry = [&](const std::string& sample, const std::string& meaning, double room) {
      text +=
          fmt::format("<g transform=\"translate({},36)\">{}</g><text class=\"legend\" x=\"{}\" y=\"44\">{}</text>\n",
                      at, sample, at + 30.0, meaning);
      at += room;
    };
    const auto line = [](const char* css_class) {
      return fmt::format("<path class=\"{}\" d=\"M0,4H24\"/>", css_class);
    };
    entry(R"(<rect class="sigma" width="24" height="9"/>)" + line("estimate"), "estimate ± 2 σ", 140.0);
    entry(line("unknown"), "not observable", 140.0);
    const bool has_truth = std::any_of(result_.radars.begin(), result_.radars.end(),
                                       [](const RadarResult& r) { return r.truth.has_value(); });
    if (has_truth) entry(line("truth"), "truth", 80.0);
    entry(line("step_change"), "step_change", 85.0);
    entry(line("before"), "residuals with the nominal mounting", 275.0);
    entry(R"(<rect class="after" width="24" height="9"/>)", "with the estimate", 150.0);
    return text + "<text class=\"legend\" text-anchor=\"end\" x=\"" +
           fmt::format("{:.0f}", kColumns * (kWidth + kMargin)) +
           "\" y=\"24\">angles about the vehicle's axes</text>\n";
  }

  void shared() {
    curve({.title = "k_v",
           .unit = "",
           .axis = " ",  // no room beside so many digits, and the title says it
           .decimals = 6,
           .smallest_span = 1e-4,
           .truth = constant(result_.true_speed_scale, 1.0),
           .value = [](const Sample& s) { return s.speed_scale; },
           .std = [](const Sample& s) { return s.speed_scale_std; },
           .observable = [](const Sample& s) { return any(s, alignment_axis::kSpeedScale); }},
          {});
    const auto is_estimated = [&](double Sample::*std) {
      return std::any_of(result_.series.begin(), result_.series.end(), [std](const Sample& s) { return s.*std > 0.0; });
    };
    if (is_estimated(&Sample::yaw_rate_bias_std_radps)) {
      curve({.title = "yaw-rate bias",
             .unit = "°/s",
             .axis = "",
             .decimals = 4,
             .smallest_span = 0.01,
             .truth = constant(result_.true_yaw_rate_bias_radps, kDegrees),
             .value = [](const Sample& s) { return s.yaw_rate_bias_radps * kDegrees; },
             .std = [](const Sample& s) { return s.yaw_rate_bias_std_radps * kDegrees; },
             .observable = [](const Sample& s) { return any(s, alignment_axis::kYawRateBias); }},
            {});
    }
    if (is_estimated(&Sample::slip_coefficient_std_radps2pm)) {
      curve({.title = "rear-axle slip",
             .unit = "mrad/(m/s²)",
             .axis = "",
             .decimals = 3,
             .smallest_span = 0.1,
             .truth = constant(result_.true_slip_coefficient_radps2pm, 1e3),
             .value = [](const Sample& s) { return s.slip_coefficient_radps2pm * 1e3; },
             .std = [](const Sample& s) { return s.slip_coefficient_std_radps2pm * 1e3; },
             .observable = [](const Sample& s) { return any(s, alignment_axis::kSlip); }},
            {});
    }
    end_row();
  }

  void radar(std::size_t index) {
    const RadarResult& radar = result_.radars[index];
    const std::string name = fmt::format("{} {}", radar.id, radar.name);
    constexpr std::array<const char*, kParameters> kNames = {"k_v", "yaw", "pitch", "roll"};
    constexpr std::array<std::uint32_t, kParameters> kBits = {alignment_axis::kSpeedScale, alignment_axis::kVehicleYaw,
                                                              alignment_axis::kVehiclePitch,
                                                              alignment_axis::kVehicleRoll};
    for (std::size_t i = 1; i < kParameters; ++i) {
      curve({.title = name + ", " + kNames.at(i),
             .unit = "°",
             .axis = "degrees",
             .decimals = 3,
             .smallest_span = 0.02,
             .truth = mountings(radar, i),
             .value = [index, i](const Sample& s) { return s.radars[index].values.at(i) * kDegrees; },
             .std = [index, i](const Sample& s) { return s.radars[index].stds.at(i) * kDegrees; },
             .observable = [index,
                            bit = kBits.at(i)](const Sample& s) { return (s.radars[index].observable & bit) != 0; }},
            radar.step_changes);
    }
    histogram(name, radar.residuals);
    end_row();
  }

  static std::vector<Point> constant(const std::optional<double>& value, double factor) {
    return value ? std::vector<Point>{{0.0, *value * factor}} : std::vector<Point>{};
  }
  [[nodiscard]] std::vector<Point> mountings(const RadarResult& radar, std::size_t parameter) const {
    std::vector<Point> points;
    if (!radar.truth) return points;
    for (const TruthComparison::Mounting& mounting : radar.truth->mountings) {
      const double from_s = std::max(0.0, mounting.from_s - result_.start_s);
      points.push_back({result_.x_is_iteration ? 0.0 : from_s, mounting.values.at(parameter) * kDegrees});
    }
    return points;
  }
  static bool any(const Sample& sample, std::uint32_t bit) {
    return std::any_of(sample.radars.begin(), sample.radars.end(),
                       [bit](const Sample::Radar& r) { return (r.observable & bit) != 0; });
  }

  /// The axis shows how the estimate settles: what the first tenth of the drive has beyond that is cut off.
  [[nodiscard]] Axis y_axis(const Curve& curve) const {
    constexpr double kStartShare = 0.1, kRoom = 0.08;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto include = [&](double value) {
      if (!std::isfinite(value)) return;
      low = std::min(low, value);
      high = std::max(high, value);
    };
    const bool ends_observable = !result_.series.empty() && curve.observable(result_.series.back());
    for (const Sample& sample : result_.series) {
      if (x(sample) < kStartShare * x_max_) continue;
      if (ends_observable && !curve.observable(sample)) continue;
      include(curve.value(sample));
      include(curve.value(sample) - 2.0 * curve.std(sample));
      include(curve.value(sample) + 2.0 * curve.std(sample));
    }
    for (const Point& point : curve.truth) include(point.y);
    if (!(low <= high)) low = high = 0.0;
    const double middle = 0.5 * (low + high);
    const double half = std::max(0.5 * curve.smallest_span, (0.5 + kRoom) * (high - low));
    return {middle - half, middle + half, curve.axis.empty() ? curve.unit : curve.axis, false};
  }

  void curve(const Curve& curve, const std::vector<StepChangeEvent>& step_changes) {
    std::string title = curve.title;
    if (!result_.series.empty()) {
      const Sample& last = result_.series.back();
      title += curve.observable(last) ? ": " + number(curve.value(last), curve.decimals, "", !curve.unit.empty()) +
                                            " ± " + number(curve.std(last), curve.decimals, curve.unit, false)
                                      : ": not observable";
    }
    if (!curve.truth.empty()) {
      title += " (true " + number(curve.truth.back().y, curve.decimals, curve.unit, !curve.unit.empty()) + ")";
    }
    SvgChart chart(kWidth, kHeight, x_axis(), y_axis(curve));
    std::vector<Point> lower, upper, known, unknown;
    for (const Sample& sample : result_.series) {
      const double value = curve.value(sample), std = curve.std(sample);
      const bool observable = curve.observable(sample);
      lower.push_back({x(sample), observable ? value - 2.0 * std : kNaN});
      upper.push_back({x(sample), observable ? value + 2.0 * std : kNaN});
      (observable ? known : unknown).push_back({x(sample), value});
    }
    chart.band(lower, upper, "sigma");
    chart.line(unknown, "unknown");
    chart.line(known, "estimate");
    std::vector<Point> truth;
    for (std::size_t i = 0; i < curve.truth.size(); ++i) {
      truth.push_back(curve.truth[i]);
      truth.push_back({i + 1 < curve.truth.size() ? curve.truth[i + 1].x : std::max(x_max_, 1.0), curve.truth[i].y});
    }
    chart.line(truth, "truth");
    for (const StepChangeEvent& step_change : step_changes)
      chart.vertical(step_change.time_s - result_.start_s, "step_change", "step_change");
    place(chart, title);
  }

  void histogram(const std::string& name, const ResidualSummary& residuals) {
    const Histogram& h = residuals.histogram;
    std::uint64_t most = 1;
    for (std::size_t i = 0; i < Histogram::kBins; ++i) most = std::max({most, h.before.at(i), h.after.at(i)});
    const std::uint64_t per = most >= 10'000 ? 1000 : 1;
    const auto scaled = [per](std::uint64_t count) { return static_cast<double>(count) / static_cast<double>(per); };
    SvgChart chart(kWidth, kHeight, {-h.limit_mps, h.limit_mps, "residual of the range rate, m/s", false},
                   {0.0, 1.08 * scaled(most), per == 1 ? "detections" : "1000 detections", false});
    const auto outline = [&](const std::array<std::uint64_t, Histogram::kBins>& counts) {
      std::vector<Point> points;
      for (std::size_t i = 0; i < Histogram::kBins; ++i) {
        const double width = 2.0 * h.limit_mps / static_cast<double>(Histogram::kBins);
        const double left = -h.limit_mps + static_cast<double>(i) * width;
        points.push_back({left, scaled(counts.at(i))});
        points.push_back({left + width, scaled(counts.at(i))});
      }
      return points;
    };
    chart.band({{-h.limit_mps, 0.0}, {h.limit_mps, 0.0}}, outline(h.after), "after");
    chart.line(outline(h.before), "before");
    std::string title = name + ", residuals";
    if (std::isfinite(residuals.after.rmse_mps)) {
      title += fmt::format(": RMSE {:.3f} → {:.3f} m/s, {:.0f} % inliers", residuals.before.rmse_mps,
                           residuals.after.rmse_mps, 100.0 * residuals.inlier_ratio);
    }
    place(chart, title);
  }

  void place(const SvgChart& chart, const std::string& title) {
    const double left = kMargin + static_cast<double>(column_) * (kWidth + kMargin);
    const double top = kHead + static_cast<double>(row_) * (kTitle + kHeight);
    body_ += fmt::format("<text class=\"title\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n", left + 14.0, top + 16.0,
                         report::escape(title));
    body_ += chart.finish_at(left, top + kTitle);
    if (++column_ == kColumns) end_row();
  }
  void end_row() {
    if (column_ == 0) return;
    column_ = 0;
    ++row_;
  }

  const Result& result_;
  double x_max_ = 0.0;
  std::size_t column_ = 0, row_ = 0;
  std::string body_;
};

}  // namespace

std::string to_svg(const Result& result) {
  return Picture(result).draw();
}

}  // namespace boresight::align
