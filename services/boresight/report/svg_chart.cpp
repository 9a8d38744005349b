#include "services/boresight/report/svg_chart.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace boresight::report {

namespace {

constexpr double kLeft = 52.0;
constexpr double kRight = 12.0;
constexpr double kTop = 10.0;
constexpr double kBottom = 36.0;
constexpr double kHalfDigit = 3.3;

bool is_finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

std::string tick_text(double value) {
  if (value != 0.0 && std::abs(value) < 1e-9) value = 0.0;
  return fmt::format("{:.6g}", value);
}

/// With as many decimals as tell neighbouring ticks apart.
std::string tick_text(double value, const std::vector<double>& ticks) {
  if (ticks.size() < 2) return tick_text(value);
  const double step = ticks[1] - ticks[0];
  const double largest = std::max(std::abs(ticks.front()), std::abs(ticks.back()));
  constexpr double kTooSmall = 1e-5, kTooLarge = 1e6;
  if (step < kTooSmall || largest >= kTooLarge) return tick_text(value);
  return fmt::format("{:.{}f}", value, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
}

std::string path_of(SvgChart::Shape shape, double x, double y, double r) {
  switch (shape) {
    case SvgChart::Shape::kCircle:
      return fmt::format("M{:.1f},{:.1f}a{r:.1f},{r:.1f} 0 1 0 {d:.1f},0a{r:.1f},{r:.1f} 0 1 0 -{d:.1f},0Z", x - r, y,
                         fmt::arg("r", r), fmt::arg("d", 2.0 * r));
    case SvgChart::Shape::kSquare:
      return fmt::format("M{:.1f},{:.1f}h{d:.1f}v{d:.1f}h-{d:.1f}Z", x - r, y - r, fmt::arg("d", 2.0 * r));
    case SvgChart::Shape::kTriangle:
      return fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}H{:.1f}Z", x, y - 1.2 * r, x + 1.1 * r, y + 0.9 * r, x - 1.1 * r);
    case SvgChart::Shape::kDiamond:
      return fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}Z", x, y - 1.3 * r, x + 1.3 * r, y, x,
                         y + 1.3 * r, x - 1.3 * r, y);
    case SvgChart::Shape::kCross:
      return fmt::format("M{0:.1f},{1:.1f}L{2:.1f},{3:.1f}M{0:.1f},{3:.1f}L{2:.1f},{1:.1f}", x - r, y - r, x + r,
                         y + r);
    case SvgChart::Shape::kBox:
      return fmt::format("M{:.1f},{:.1f}h{:.1f}v{:.1f}h-{:.1f}Z", x - 1.5 * r, y - 0.8 * r, 3.0 * r, 1.6 * r, 3.0 * r);
    case SvgChart::Shape::kDash:
      return fmt::format("M{:.1f},{:.1f}h{:.1f}", x - r, y, 2.0 * r);
  }
  return {};
}

}  // namespace

std::string escape(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

SvgChart::SvgChart(double width, double height, Axis x, Axis y)
    : width_(width), height_(height), x_(std::move(x)), y_(std::move(y)) {
  if (!(x_.max > x_.min)) x_.max = x_.min + 1.0;
  if (!(y_.max > y_.min)) y_.max = y_.min + 1.0;
}

double SvgChart::px(double x) const {
  const double share =
      x_.logarithmic ? std::log(x / x_.min) / std::log(x_.max / x_.min) : (x - x_.min) / (x_.max - x_.min);
  return kLeft + std::clamp(share, -1.0, 2.0) * (width_ - kLeft - kRight);
}

double SvgChart::py(double y) const {
  const double share = (y - y_.min) / (y_.max - y_.min);
  return height_ - kBottom - std::clamp(share, -1.0, 2.0) * (height_ - kTop - kBottom);
}

void SvgChart::band(const std::vector<Point>& lower, const std::vector<Point>& upper, const std::string& css_class) {
  std::string path;
  for (const Point& p : upper) {
    if (is_finite(p)) path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : "L", px(p.x), py(p.y));
  }
  for (auto p = lower.rbegin(); p != lower.rend(); ++p) {
    if (is_finite(*p) && !path.empty()) path += fmt::format("L{:.1f},{:.1f}", px(p->x), py(p->y));
  }
  if (!path.empty()) body_ += fmt::format("<path class=\"{}\" d=\"{}Z\"/>\n", css_class, path);
}

void SvgChart::line(const std::vector<Point>& points, const std::string& css_class) {
  std::string path;
  for (const Point& p : points) {
    if (is_finite(p)) path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : "L", px(p.x), py(p.y));
  }
  if (!path.empty()) body_ += fmt::format("<path class=\"{}\" fill=\"none\" d=\"{}\"/>\n", css_class, path);
}

void SvgChart::horizontal(double y, const std::string& css_class) {
  line({{x_.min, y}, {x_.max, y}}, css_class);
}

void SvgChart::vertical(double x, const std::string& css_class, const std::string& label) {
  line({{x, y_.min}, {x, y_.max}}, css_class);
  body_ += fmt::format("<text class=\"note\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", px(x) + 4.0, kTop + 11.0,
                       escape(label));
}

void SvgChart::rectangle(Point from, Point to, const std::string& css_class, const std::string& tooltip) {
  const double left = std::min(px(from.x), px(to.x));
  const double top = std::min(py(from.y), py(to.y));
  body_ += fmt::format(
      "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"><title>{}</title></rect>\n",
      css_class, left, top, std::abs(px(to.x) - px(from.x)), std::abs(py(to.y) - py(from.y)), escape(tooltip));
}

void SvgChart::dot(Point at, double radius_px, const std::string& css_class, const std::string& tooltip) {
  if (!is_finite(at)) return;
  body_ += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"><title>{}</title></circle>\n",
                       css_class, px(at.x), py(at.y), radius_px, escape(tooltip));
}

void SvgChart::polygon(const std::vector<Point>& corners, const std::string& css_class, const std::string& tooltip) {
  std::string path;
  for (const Point& p : corners) {
    if (!is_finite(p)) return;
    path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : "L", px(p.x), py(p.y));
  }
  body_ += fmt::format("<path class=\"{}\" d=\"{}Z\"><title>{}</title></path>\n", css_class, path, escape(tooltip));
}

void SvgChart::symbol(Point at, Shape shape, double radius_px, const std::string& css_class,
                      const std::string& tooltip) {
  if (!is_finite(at)) return;
  body_ += fmt::format("<path class=\"{}\" d=\"{}\">", css_class, path_of(shape, px(at.x), py(at.y), radius_px));
  body_ += (tooltip.empty() ? "" : "<title>" + escape(tooltip) + "</title>") + "</path>\n";
}

std::string SvgChart::key(Shape shape, const std::string& css_class) {
  return fmt::format(
      "<svg class=\"chart key\" viewBox=\"0 0 14 14\" aria-hidden=\"true\"><path class=\"{}\" d=\"{}\"/></svg>",
      css_class, path_of(shape, 7.0, 7.0, 4.0));
}

void SvgChart::text(Point at, const std::string& text, const std::string& css_class) {
  body_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", css_class, px(at.x), py(at.y),
                       escape(text));
}

std::vector<double> SvgChart::ticks(double min, double max, int count) {
  std::vector<double> result;
  const double raw = (max - min) / std::max(1, count);
  if (!(raw > 0.0) || !std::isfinite(raw)) return result;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  double step = decade;
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    step = decade * factor;
    if (step >= raw) break;
  }
  for (double value = std::ceil(min / step) * step; value <= max + step * 1e-6; value += step) {
    result.push_back(std::abs(value) < step * 1e-6 ? 0.0 : value);
  }
  return result;
}

std::string SvgChart::axes() const {
  std::string text;
  const double bottom = height_ - kBottom;
  std::vector<double> x_ticks = ticks(x_.min, x_.max, 8);
  if (x_.logarithmic) {
    x_ticks.clear();
    for (double value = std::pow(10.0, std::ceil(std::log10(x_.min) - 1e-9)); value <= x_.max * 1.001; value *= 10.0) {
      x_ticks.push_back(value);
    }
  }
  for (const double value : x_ticks) {
    text += fmt::format("<path class=\"grid\" d=\"M{0:.1f},{1:.1f}V{2:.1f}\"/>", px(value), kTop, bottom);
    // In the middle of its tick a long number at the edge would end outside of the picture.
    const std::string number = x_.logarithmic ? tick_text(value) : tick_text(value, x_ticks);
    const bool fits = px(value) + kHalfDigit * static_cast<double>(number.size()) < width_;
    text += fmt::format("<text class=\"tick\" text-anchor=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                        fits ? "middle" : "end", px(value), bottom + 14.0, number);
  }
  const int rows = std::max(2, static_cast<int>((height_ - kTop - kBottom) / 32.0));
  const std::vector<double> y_ticks = y_.label.empty() ? std::vector<double>{} : ticks(y_.min, y_.max, rows);
  for (const double value : y_ticks) {
    text += fmt::format("<path class=\"grid\" d=\"M{:.1f},{:.1f}H{:.1f}\"/>", kLeft, py(value), width_ - kRight);
    text += fmt::format("<text class=\"tick\" text-anchor=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kLeft - 6.0,
                        py(value) + 3.5, tick_text(value, y_ticks));
  }
  text += fmt::format("<text class=\"label\" text-anchor=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                      width_ - kRight, height_ - 6.0, escape(x_.label));
  text += fmt::format(
      "<text class=\"label\" text-anchor=\"middle\" transform=\"translate(13,{:.1f}) rotate(-90)\">{}</text>\n",
      (kTop + bottom) / 2.0, escape(y_.label));
  return text;
}

std::string SvgChart::finish() const {
  return render("");
}

std::string SvgChart::finish_at(double x, double y) const {
  return render(fmt::format(" x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\"", x, y, width_, height_));
}

std::string SvgChart::render(const std::string& placement) const {
  // Clip paths need names that are unique in the page; the nested <svg> clips without one.
  return fmt::format(
      "<svg class=\"chart\"{8} viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\">\n{2}"
      "<svg x=\"{3}\" y=\"{4}\" width=\"{5:.1f}\" height=\"{6:.1f}\" viewBox=\"{3} {4} {5:.1f} {6:.1f}\">\n{7}</svg>\n"
      "<rect class=\"frame\" x=\"{3}\" y=\"{4}\" width=\"{5:.1f}\" height=\"{6:.1f}\"/>\n</svg>\n",
      width_, height_, axes(), kLeft, kTop, width_ - kLeft - kRight, height_ - kTop - kBottom, body_, placement);
}

}  // namespace boresight::report
