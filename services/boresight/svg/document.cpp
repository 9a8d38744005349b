#include "services/boresight/svg/document.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace boresight::svg {

namespace {

constexpr double kSampleWidth_px = 30.0;    // with the gap to its meaning
constexpr double kCharacterWidth_px = 6.8;  // on average, at 12 px
constexpr double kGapBetweenEntries_px = 20.0;

/// Characters, not bytes: legends contain ± and σ.
double number_of_characters(const std::string& text) {
  return static_cast<double>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

void Document::title(const std::string& text) {
  body_ += fmt::format("<text fill=\"{}\" font-size=\"17\" font-weight=\"600\" x=\"{:.0f}\" y=\"24\">{}</text>\n", kInk,
                       kMargin_px, escape(text));
}

void Document::text(double x, double y, const std::string& text, double size_px) {
  body_ += fmt::format("<text fill=\"{}\" font-size=\"{:g}\" x=\"{:.0f}\" y=\"{:.0f}\">{}</text>\n", kInk, size_px, x,
                       y, escape(text));
}

void Document::legend_at(double x, double y) {
  legend_x_ = x;
  legend_y_ = y;
}

void Document::legend_entry(const std::string& sample, const std::string& meaning) {
  body_ += fmt::format("<g transform=\"translate({:.0f},{:.0f})\">{}</g>", legend_x_, legend_y_, sample);
  text(legend_x_ + kSampleWidth_px, legend_y_ + 9.0, meaning);
  legend_x_ += kSampleWidth_px + kCharacterWidth_px * number_of_characters(meaning) + kGapBetweenEntries_px;
}

void Document::place(const Chart& chart, double x, double y) {
  body_ += chart.finish_at(x, y);
  right_ = std::max(right_, x + chart.width_px());
  bottom_ = std::max(bottom_, y + chart.height_px());
}

std::string Document::finish() const {
  const double width = std::max(right_, legend_x_) + kMargin_px;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "font-family=\"{2}\">\n<rect fill=\"{3}\" width=\"{0:.0f}\" height=\"{1:.0f}\"/>\n{4}</svg>\n",
      width, bottom_ + kMargin_px, kFonts, kPaper, body_);
}

}  // namespace boresight::svg
