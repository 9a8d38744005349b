#include "services/boresight/svg/chart.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace boresight::svg {

namespace {

constexpr double kLeft = 52.0;
constexpr double kRight = 12.0;
constexpr double kTop = 10.0;
constexpr double kBottom = 36.0;
constexpr double kHalfDigit = 3.3;
constexpr Style kGrid = line_of(kGridLine, 1.0);

bool is_finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

std::string tick_text(double value) {
  if (value != 0.0 && std::abs(value) < 1e-9) value = 0.0;
  return fmt::format("{:.6g}", value);
}

/// With as many decimals as neighbouring ticks need to differ.
std::string tick_text(double value, const std::vector<double>& ticks) {
  if (ticks.size() < 2) return tick_text(value);
  const double step = ticks[1] - ticks[0];
  const double largest = std::max(std::abs(ticks.front()), std::abs(ticks.back()));
  constexpr double kTooSmall = 1e-5, kTooLarge = 1e6;
  if (step < kTooSmall || largest >= kTooLarge) return tick_text(value);
  return fmt::format("{:.{}f}", value, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
}

std::string text_element(double x, double y, std::string_view colour, const char* anchor, const std::string& text,
                         double size_px = 11.0) {
  return fmt::format("<text fill=\"{}\" font-size=\"{:g}\" text-anchor=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                     colour, size_px, anchor, x, y, escape(text));
}

std::string title_of(const std::string& tooltip) {
  return tooltip.empty() ? std::string() : "<title>" + escape(tooltip) + "</title>";
}

std::string path_of(Shape shape, double x, double y, double r) {
  switch (shape) {
    case Shape::kCircle:
      return fmt::format("M{:.1f},{:.1f}a{r:.1f},{r:.1f} 0 1 0 {d:.1f},0a{r:.1f},{r:.1f} 0 1 0 -{d:.1f},0Z", x - r, y,
                         fmt::arg("r", r), fmt::arg("d", 2.0 * r));
    case Shape::kSquare:
      return fmt::format("M{:.1f},{:.1f}h{d:.1f}v{d:.1f}h-{d:.1f}Z", x - r, y - r, fmt::arg("d", 2.0 * r));
    case Shape::kTriangle:
      return fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}H{:.1f}Z", x, y - 1.2 * r, x + 1.1 * r, y + 0.9 * r, x - 1.1 * r);
    case Shape::kDiamond:
      return fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}Z", x, y - 1.3 * r, x + 1.3 * r, y, x,
                         y + 1.3 * r, x - 1.3 * r, y);
    case Shape::kCross:
      return fmt::format("M{0:.1f},{1:.1f}L{2:.1f},{3:.1f}M{0:.1f},{3:.1f}L{2:.1f},{1:.1f}", x - r, y - r, x + r,
                         y + r);
    case Shape::kBox:
      return fmt::format("M{:.1f},{:.1f}h{:.1f}v{:.1f}h-{:.1f}Z", x - 1.5 * r, y - 0.8 * r, 3.0 * r, 1.6 * r, 3.0 * r);
    case Shape::kDash:
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

Chart::Chart(double width, double height, Axis x, Axis y)
    : width_(width), height_(height), x_(std::move(x)), y_(std::move(y)) {
  if (!(x_.max > x_.min)) x_.max = x_.min + 1.0;
  if (!(y_.max > y_.min)) y_.max = y_.min + 1.0;
}

double Chart::px(double x) const {
  const double share =
      x_.logarithmic ? std::log(x / x_.min) / std::log(x_.max / x_.min) : (x - x_.min) / (x_.max - x_.min);
  return kLeft + std::clamp(share, -1.0, 2.0) * (width_ - kLeft - kRight);
}

double Chart::py(double y) const {
  const double share = (y - y_.min) / (y_.max - y_.min);
  return height_ - kBottom - std::clamp(share, -1.0, 2.0) * (height_ - kTop - kBottom);
}

void Chart::band(const std::vector<Point>& lower, const std::vector<Point>& upper, const Style& style) {
  std::string path;
  for (const Point& p : upper) {
    if (is_finite(p)) path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : "L", px(p.x), py(p.y));
  }
  for (auto p = lower.rbegin(); p != lower.rend(); ++p) {
    if (is_finite(*p) && !path.empty()) path += fmt::format("L{:.1f},{:.1f}", px(p->x), py(p->y));
  }
  if (!path.empty()) body_ += fmt::format("<path{} d=\"{}Z\"/>\n", attributes(style), path);
}

void Chart::line(const std::vector<Point>& points, const Style& style) {
  std::string path;
  for (const Point& p : points) {
    if (is_finite(p)) path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : "L", px(p.x), py(p.y));
  }
  if (!path.empty()) body_ += fmt::format("<path{} d=\"{}\"/>\n", attributes(style), path);
}

void Chart::horizontal(double y, const Style& style) {
  line({{x_.min, y}, {x_.max, y}}, style);
}

void Chart::vertical(double x, const Style& style, const std::string& label) {
  line({{x, y_.min}, {x, y_.max}}, style);
  body_ += text_element(px(x) + 4.0, kTop + 11.0, style.stroke, "start", label);
}

void Chart::rectangle(Point from, Point to, const Style& style, const std::string& tooltip) {
  const double left = std::min(px(from.x), px(to.x));
  const double top = std::min(py(from.y), py(to.y));
  body_ +=
      fmt::format("<rect{} x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">{}</rect>\n", attributes(style),
                  left, top, std::abs(px(to.x) - px(from.x)), std::abs(py(to.y) - py(from.y)), title_of(tooltip));
}

void Chart::dot(Point at, double radius_px, const Style& style, const std::string& tooltip) {
  if (!is_finite(at)) return;
  body_ += fmt::format("<circle{} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\">{}</circle>\n", attributes(style), px(at.x),
                       py(at.y), radius_px, title_of(tooltip));
}

void Chart::polygon(const std::vector<Point>& corners, const Style& style, const std::string& tooltip) {
  std::string path;
  for (const Point& p : corners) {
    if (!is_finite(p)) return;
    path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "M" : "L", px(p.x), py(p.y));
  }
  body_ += fmt::format("<path{} d=\"{}Z\">{}</path>\n", attributes(style), path, title_of(tooltip));
}

void Chart::symbol(Point at, Shape shape, double radius_px, const Style& style, const std::string& tooltip) {
  if (!is_finite(at)) return;
  body_ += fmt::format("<path{} d=\"{}\">{}</path>\n", attributes(style), path_of(shape, px(at.x), py(at.y), radius_px),
                       title_of(tooltip));
}

void Chart::text(Point at, const std::string& text) {
  body_ += text_element(px(at.x), py(at.y), kInk, "start", text, 12.0);
}

std::vector<double> Chart::ticks(double min, double max, int count) {
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

std::string Chart::axes() const {
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
    text += fmt::format("<path{3} d=\"M{0:.1f},{1:.1f}V{2:.1f}\"/>", px(value), kTop, bottom, attributes(kGrid));
    // A long number at the edge would end outside of the picture if it were centred on its tick.
    const std::string number = x_.logarithmic ? tick_text(value) : tick_text(value, x_ticks);
    const bool fits = px(value) + kHalfDigit * static_cast<double>(number.size()) < width_;
    text += text_element(px(value), bottom + 14.0, kFaint, fits ? "middle" : "end", number);
  }
  const int rows = std::max(2, static_cast<int>((height_ - kTop - kBottom) / 32.0));
  const std::vector<double> y_ticks = y_.label.empty() ? std::vector<double>{} : ticks(y_.min, y_.max, rows);
  for (const double value : y_ticks) {
    text += fmt::format("<path{} d=\"M{:.1f},{:.1f}H{:.1f}\"/>", attributes(kGrid), kLeft, py(value), width_ - kRight);
    text += text_element(kLeft - 6.0, py(value) + 3.5, kFaint, "end", tick_text(value, y_ticks));
  }
  text += text_element(width_ - kRight, height_ - 6.0, kFaint, "end", x_.label);
  text += fmt::format("<g transform=\"translate(13,{:.1f}) rotate(-90)\">{}</g>\n", (kTop + bottom) / 2.0,
                      text_element(0.0, 0.0, kFaint, "middle", y_.label));
  return text;
}

std::string Chart::finish() const {
  return render(" class=\"chart\"");
}

std::string Chart::finish_at(double x, double y) const {
  return render(fmt::format(" x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\"", x, y, width_, height_));
}

std::string Chart::render(const std::string& placement) const {
  // Clip paths need names that are unique in the page; the nested <svg> clips without one.
  return fmt::format(
      "<svg{8} viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"{9}\" role=\"img\">\n{2}"
      "<svg x=\"{3}\" y=\"{4}\" width=\"{5:.1f}\" height=\"{6:.1f}\" viewBox=\"{3} {4} {5:.1f} {6:.1f}\">\n{7}</svg>\n"
      "<rect{10} x=\"{3}\" y=\"{4}\" width=\"{5:.1f}\" height=\"{6:.1f}\"/>\n</svg>\n",
      width_, height_, axes(), kLeft, kTop, width_ - kLeft - kRight, height_ - kTop - kBottom, body_, placement, kFonts,
      attributes(kGrid));
}

std::string attributes(const Style& style) {
  std::string text = fmt::format(" fill=\"{}\"", style.fill);
  if (style.fill_opacity < 1.0) text += fmt::format(" fill-opacity=\"{:g}\"", style.fill_opacity);
  if (style.stroke == "none") return text;
  text += fmt::format(" stroke=\"{}\" stroke-width=\"{:g}\"", style.stroke, style.stroke_width_px);
  if (!style.dashes.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", style.dashes);
  return text;
}

std::string line_sample(const Style& style) {
  return fmt::format("<path{} d=\"M0,5H24\"/>", attributes(style));
}

std::string area_sample(const Style& style) {
  return fmt::format("<rect{} width=\"24\" height=\"10\"/>", attributes(style));
}

std::string symbol_sample(Shape shape, const Style& style) {
  return fmt::format("<path{} d=\"{}\"/>", attributes(style), path_of(shape, 12.0, 5.0, 4.0));
}

std::string page_key(const std::string& sample) {
  return "<svg class=\"key\" viewBox=\"0 0 24 10\" aria-hidden=\"true\">" + sample + "</svg>";
}

}  // namespace boresight::svg
