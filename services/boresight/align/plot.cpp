#include "services/boresight/align/plot.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "services/boresight/align/json.hpp"
#include "services/boresight/svg/document.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::align {

namespace {

using svg::Axis;
using svg::Chart;
using svg::Point;
constexpr double kWidth = 390.0, kHeight = 215.0, kTitle = 20.0, kHead = 60.0, kNoteLine = 17.0;
constexpr double kMargin = svg::Document::kMargin_px;
constexpr std::size_t kColumns = 5;

constexpr svg::Style kNotObservable = svg::line_of(svg::kGrey, 1.6, "2 3");
constexpr svg::Style kStepChange = svg::line_of(svg::kOrange, 1.2, "4 3");
constexpr svg::Style kBefore = svg::line_of(svg::kGrey, 1.6);
constexpr svg::Style kAfter = {.fill = svg::kBlue, .fill_opacity = 0.2, .stroke = svg::kBlue, .stroke_width_px = 1.2};

/// Content of one chart of a parameter, in the unit of its axis.
struct Curve {
  std::string title, unit, axis;  // the label of the axis is the unit, unless it is given
  double smallest_span = 0.01;
  std::vector<Point> truth;  // (start, value) of each true value; the last holds at the end
  std::function<double(const Sample&)> value, std;
  std::function<bool(const Sample&)> observable;
};

class Picture {
 public:
  explicit Picture(const Result& result) : result_(result) {
    for (const Sample& sample : result.series) x_max_ = std::max(x_max_, x(sample));
    notes_ = notes_of(result);
  }

  std::string draw() {
    shared();
    for (std::size_t i = 0; i < result_.radars.size(); ++i) radar(i);
    head();
    return document_.finish();
  }

 private:
  [[nodiscard]] double x(const Sample& sample) const {
    return result_.x_is_iteration ? sample.x / 1000.0 : sample.x - result_.start_s;
  }
  [[nodiscard]] Axis x_axis() const {
    return {0.0, std::max(x_max_, 1.0), result_.x_is_iteration ? "thousand iterations" : "time since the first scan, s",
            false};
  }

  void head() {
    document_.title(fmt::format("Alignment of vehicle {}, method {}: rotations about the vehicle's axes",
                                result_.vehicle, result_.method));
    document_.legend_at(kMargin, 38.0);
    document_.legend_entry(svg::area_sample(svg::kUncertainty) + svg::line_sample(svg::kEstimate), "estimate ± 2 σ");
    document_.legend_entry(svg::line_sample(kNotObservable), "not observable");
    const bool has_truth = std::any_of(result_.radars.begin(), result_.radars.end(),
                                       [](const RadarResult& r) { return r.truth.has_value(); });
    if (has_truth) document_.legend_entry(svg::line_sample(svg::kTruth), "truth");
    const bool has_step_change = std::any_of(result_.radars.begin(), result_.radars.end(),
                                             [](const RadarResult& r) { return !r.step_changes.empty(); });
    if (has_step_change) document_.legend_entry(svg::line_sample(kStepChange), "sudden misalignment");
    document_.legend_entry(svg::line_sample(kBefore), "residuals with the nominal mounting");
    document_.legend_entry(svg::area_sample(kAfter), "residuals with the estimate");
    for (std::size_t i = 0; i < notes_.size(); ++i) {
      document_.text(kMargin, kHead + kNoteLine * (static_cast<double>(i) + 0.5), notes_[i]);
    }
  }

  /// Reasons, wrong inputs, drifts and changes of the vehicle, a line each.
  static std::vector<std::string> notes_of(const Result& result) {
    std::vector<std::string> notes;
    for (const RadarResult& radar : result.radars) {
      const std::string drift = alignment_words::drift_sentence(radar.message.drift);
      for (const std::string& text : {radar.reason, drift}) {
        if (!text.empty()) {
          notes.push_back(fmt::format("{} {}, {}: {}", radar.id, radar.name, name_of(radar.message.state), text));
        }
      }
    }
    const auto add = [&](const VehicleChangeEvent& change, const std::string& sentence) {
      notes.push_back(fmt::format("{:.1f} s: {}", change.time_s - result.start_s, sentence));
    };
    for (const VehicleChangeEvent& change : result.load_changes) {
      add(change, alignment_words::load_change_sentence({1, static_cast<float>(change.size), 1}));
    }
    for (const VehicleChangeEvent& change : result.speed_changes) {
      add(change, alignment_words::speed_change_sentence({1, static_cast<float>(change.size), 1}));
    }
    return notes;
  }

  void shared() {
    curve({.title = "speed scale k_v",
           .unit = "",
           .axis = " ",  // no room beside so many digits; the title states it
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
             .smallest_span = 0.01,
             .truth = constant(result_.true_yaw_rate_bias_radps, kDegreesPerRadian),
             .value = [](const Sample& s) { return s.yaw_rate_bias_radps * kDegreesPerRadian; },
             .std = [](const Sample& s) { return s.yaw_rate_bias_std_radps * kDegreesPerRadian; },
             .observable = [](const Sample& s) { return any(s, alignment_axis::kYawRateBias); }},
            {});
    }
    if (is_estimated(&Sample::slip_coefficient_std_radps2pm)) {
      curve({.title = "rear-axle slip",
             .unit = "mrad/(m/s²)",
             .axis = "",
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
             .smallest_span = 0.02,
             .truth = mountings(radar, i),
             .value = [index, i](const Sample& s) { return s.radars[index].values.at(i) * kDegreesPerRadian; },
             .std = [index, i](const Sample& s) { return s.radars[index].stds.at(i) * kDegreesPerRadian; },
             .observable = [index,
                            bit = kBits.at(i)](const Sample& s) { return (s.radars[index].observable & bit) != 0; }},
            radar.step_changes);
    }
    histogram(name, radar.residuals);
    azimuth_curve(name, radar.message.nuisance);
    end_row();
  }

  /// Azimuth error over azimuth, with the radar's other parameters as its title.
  void azimuth_curve(const std::string& name, const AlignmentNuisance& n) {
    if (!(n.azimuth_curve_step_rad > 0.0F)) return;
    const auto degrees = [](float angle_rad) { return static_cast<double>(angle_rad) * kDegreesPerRadian; };
    std::vector<Point> lower, upper, middle;
    double most = 0.05;  // degrees: smallest span of the axis
    for (std::size_t k = 0; k < kAzimuthCurveKnots; ++k) {
      const double x = degrees(n.azimuth_curve_first_rad + static_cast<float>(k) * n.azimuth_curve_step_rad);
      const double y = degrees(n.azimuth_curve_rad.at(k)), std = degrees(n.azimuth_curve_std_rad.at(k));
      middle.push_back({x, y});
      lower.push_back({x, y - 2.0 * std});
      upper.push_back({x, y + 2.0 * std});
      most = std::max(most, std::abs(y) + 2.0 * std);
    }
    Chart chart(kWidth, kHeight, {middle.front().x, middle.back().x, "azimuth, °", false},
                {-1.08 * most, 1.08 * most, "error, °", false});
    chart.band(lower, upper, svg::kUncertainty);
    chart.line(middle, svg::kEstimate);
    constexpr double kPercent = 1e2, kMilliseconds = 1e3;
    const auto value = [](const AlignmentValue& v, double factor, const char* unit) {
      return text::with_std(factor * static_cast<double>(v.value), factor * static_cast<double>(v.std), unit,
                            text::Sign::kAlways);
    };
    place(chart, name + ", azimuth; scale " + value(n.range_rate_scale, kPercent, " %") + ", stamp " +
                     value(n.time_offset_s, kMilliseconds, " ms"));
  }

  static std::vector<Point> constant(const std::optional<double>& value, double factor) {
    return value ? std::vector<Point>{{0.0, *value * factor}} : std::vector<Point>{};
  }
  [[nodiscard]] std::vector<Point> mountings(const RadarResult& radar, std::size_t parameter) const {
    std::vector<Point> points;
    if (!radar.truth) return points;
    for (const TruthComparison::Mounting& mounting : radar.truth->mountings) {
      const double from_s = std::max(0.0, mounting.from_s - result_.start_s);
      points.push_back({result_.x_is_iteration ? 0.0 : from_s, mounting.values.at(parameter) * kDegreesPerRadian});
    }
    return points;
  }
  static bool any(const Sample& sample, std::uint32_t bit) {
    return std::any_of(sample.radars.begin(), sample.radars.end(),
                       [bit](const Sample::Radar& r) { return (r.observable & bit) != 0; });
  }

  /// The axis covers the values after the first tenth of the drive, so that it shows how the estimate settles.
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
    const std::string unit = (curve.unit.empty() || curve.unit == "°" ? "" : " ") + curve.unit;
    const text::Sign sign = curve.unit.empty() ? text::Sign::kMinusOnly : text::Sign::kAlways;
    double std = 0.0;
    if (!result_.series.empty()) {
      const Sample& last = result_.series.back();
      std = curve.std(last);
      title += curve.observable(last) ? ": " + text::with_std(curve.value(last), std, unit, sign) : ": not observable";
      if (!curve.observable(last)) std = 0.0;
    }
    if (!curve.truth.empty()) title += " (true " + text::rounded(curve.truth.back().y, std, unit, sign) + ")";
    Chart chart(kWidth, kHeight, x_axis(), y_axis(curve));
    std::vector<Point> lower, upper, known, unknown;
    for (const Sample& sample : result_.series) {
      const double value = curve.value(sample), std = curve.std(sample);
      const bool observable = curve.observable(sample);
      lower.push_back({x(sample), observable ? value - 2.0 * std : kNaN});
      upper.push_back({x(sample), observable ? value + 2.0 * std : kNaN});
      (observable ? known : unknown).push_back({x(sample), value});
    }
    chart.band(lower, upper, svg::kUncertainty);
    chart.line(unknown, kNotObservable);
    chart.line(known, svg::kEstimate);
    std::vector<Point> truth;
    for (std::size_t i = 0; i < curve.truth.size(); ++i) {
      truth.push_back(curve.truth[i]);
      truth.push_back({i + 1 < curve.truth.size() ? curve.truth[i + 1].x : std::max(x_max_, 1.0), curve.truth[i].y});
    }
    chart.line(truth, svg::kTruth);
    for (const StepChangeEvent& step_change : step_changes)
      chart.vertical(step_change.time_s - result_.start_s, kStepChange, "");
    place(chart, title);
  }

  void histogram(const std::string& name, const ResidualSummary& residuals) {
    const Histogram& h = residuals.histogram;
    std::uint64_t most = 1;
    for (std::size_t i = 0; i < Histogram::kBins; ++i) most = std::max({most, h.before.at(i), h.after.at(i)});
    const std::uint64_t per = most >= 10'000 ? 1000 : 1;
    const auto scaled = [per](std::uint64_t count) { return static_cast<double>(count) / static_cast<double>(per); };
    Chart chart(kWidth, kHeight, {-h.limit_mps, h.limit_mps, "residual of the range rate, m/s", false},
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
    chart.band({{-h.limit_mps, 0.0}, {h.limit_mps, 0.0}}, outline(h.after), kAfter);
    chart.line(outline(h.before), kBefore);
    std::string title = name + ", residuals";
    if (std::isfinite(residuals.after.rmse_mps)) {
      title += fmt::format(": RMSE {:.3f} → {:.3f} m/s, {:.0f} % inliers", residuals.before.rmse_mps,
                           residuals.after.rmse_mps, 100.0 * residuals.inlier_ratio);
    }
    place(chart, title);
  }

  void place(const Chart& chart, const std::string& title) {
    const double left = kMargin + static_cast<double>(column_) * (kWidth + kMargin);
    const double top =
        kHead + kNoteLine * static_cast<double>(notes_.size()) + static_cast<double>(row_) * (kTitle + kHeight);
    document_.text(left + 14.0, top + 16.0, title);
    document_.place(chart, left, top + kTitle);
    if (++column_ == kColumns) end_row();
  }
  void end_row() {
    if (column_ == 0) return;
    column_ = 0;
    ++row_;
  }

  const Result& result_;
  double x_max_ = 0.0;
  std::vector<std::string> notes_;
  std::size_t column_ = 0, row_ = 0;
  svg::Document document_;
};

}  // namespace

std::string to_svg(const Result& result) {
  return Picture(result).draw();
}

}  // namespace boresight::align
