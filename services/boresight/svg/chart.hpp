// Charts as SVG text: axes, lines, bands, bars and symbols. The only writer of SVG in the product.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "services/boresight/svg/style.hpp"

namespace boresight::svg {

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

/// Symbols that readers can distinguish without colours.
enum class Shape { kCircle, kSquare, kTriangle, kDiamond, kCross, kDash, kBox };

/// One chart. It is clipped to the plot area. Points that are not finite are skipped.
class Chart {
 public:
  Chart(double width_px, double height_px, Axis x, Axis y);

  void band(const std::vector<Point>& lower, const std::vector<Point>& upper, const Style& style);
  void line(const std::vector<Point>& points, const Style& style);
  void horizontal(double y, const Style& style);
  /// The label has the colour of the line.
  void vertical(double x, const Style& style, const std::string& label);
  void rectangle(Point from, Point to, const Style& style, const std::string& tooltip = {});
  void dot(Point at, double radius_px, const Style& style, const std::string& tooltip = {});
  /// A closed outline.
  void polygon(const std::vector<Point>& corners, const Style& style, const std::string& tooltip = {});
  void symbol(Point at, Shape shape, double radius_px, const Style& style, const std::string& tooltip = {});
  void text(Point at, const std::string& text);
  [[nodiscard]] double width_px() const { return width_; }
  [[nodiscard]] double height_px() const { return height_; }
  /// As a part of a page, as wide as the page allows.
  [[nodiscard]] std::string finish() const;
  /// As a part of a larger picture, with its corner at (x, y).
  [[nodiscard]] std::string finish_at(double x, double y) const;

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

/// Samples for a legend: elements in a box of 24 × 10 px.
[[nodiscard]] std::string line_sample(const Style& style);
[[nodiscard]] std::string area_sample(const Style& style);
[[nodiscard]] std::string symbol_sample(Shape shape, const Style& style);
/// A sample as a picture of its own, for a legend in the running text of a page.
[[nodiscard]] std::string page_key(const std::string& sample);

/// The attributes of a style, each after a blank.
[[nodiscard]] std::string attributes(const Style& style);
/// Text made safe for HTML and attributes.
[[nodiscard]] std::string escape(const std::string& text);

}  // namespace boresight::svg
