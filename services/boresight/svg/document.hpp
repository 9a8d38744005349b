// A picture of several charts as a file of its own.
#pragma once

#include <string>

#include "services/boresight/svg/chart.hpp"

namespace boresight::svg {

/// On a white background; as large as its charts need.
class Document {
 public:
  static constexpr double kMargin_px = 14.0;

  void title(const std::string& text);
  /// A line of text with its baseline at (x, y).
  void text(double x, double y, const std::string& text, double size_px = 12.0);
  /// Where the entries of the legend begin: the top left corner of the first sample.
  void legend_at(double x, double y);
  /// Beside the entry before.
  void legend_entry(const std::string& sample, const std::string& meaning);
  /// With its corner at (x, y).
  void place(const Chart& chart, double x, double y);
  [[nodiscard]] std::string finish() const;

 private:
  double right_ = 0.0, bottom_ = 0.0;
  double legend_x_ = kMargin_px, legend_y_ = 0.0;
  std::string body_;
};

}  // namespace boresight::svg
