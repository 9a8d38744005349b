// Just enough of a plotting library for the report: axes, lines, bands, bars, as SVG text that follows the page's
// theme.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace boresight::report {

struct Point {
  double x;
  double y;
};

struct Axis {
  double min = 0.0;
  double max = 1.0;
  std::string label;
  bool logarithmic = false;  ///< decimal; min > 0
};

/// One chart. Everything drawn is clipped to the plot area; points that are not finite are left out. `css_class`
/// refers to the classes of the report's style sheet.
class SvgChart {
 public:
  SvgChart(double width, double height, Axis x, Axis y);

  void band(const std::vector<Point>& lower, const std::vector<Point>& upper, const std::string& css_class);
  void line(const std::vector<Point>& points, const std::string& css_class);
  void horizontal(double y, const std::string& css_class);
  void vertical(double x, const std::string& css_class, const std::string& label);
  void rectangle(Point from, Point to, const std::string& css_class, const std::string& tooltip = {});
  void dot(Point at, double radius_px, const std::string& css_class, const std::string& tooltip = {});
  /// A closed outline.
  void polygon(const std::vector<Point>& corners, const std::string& css_class, const std::string& tooltip = {});
  /// In a shape of its own for each kind, so that colour is not needed to tell them apart.
  enum class Shape { kCircle, kSquare, kTriangle, kDiamond, kCross, kDash, kBox };
  void symbol(Point at, Shape shape, double radius_px, const std::string& css_class, const std::string& tooltip = {});
  void text(Point at, const std::string& text, const std::string& css_class);
  [[nodiscard]] std::string finish() const;
  /// As a part of a larger picture, with its corner at (x, y).
  [[nodiscard]] std::string finish_at(double x, double y) const;

  /// A symbol as a picture of its own, for a legend in running text.
  [[nodiscard]] static std::string key(Shape shape, const std::string& css_class);
  /// Round numbers that divide [min, max] in about `count` steps.
  [[nodiscard]] static std::vector<double> ticks(double min, double max, int count);

 private:
  [[nodiscard]] double px(double x) const;
  [[nodiscard]] double py(double y) const;
  [[nodiscard]] std::string axes() const;
  [[nodiscard]] std::string render(const std::string& placement) const;

  double width_;
  double height_;
  Axis x_;
  Axis y_;
  std::string body_;
};

/// Text made safe for HTML and attributes.
[[nodiscard]] std::string escape(const std::string& text);

}  // namespace boresight::report
