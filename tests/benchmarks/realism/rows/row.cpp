#include "tests/benchmarks/realism/rows/row.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench::realism {

namespace {

constexpr double kTolerance = 0.25;     // of the measured value
constexpr double kTolerance_db = 0.97;  // 10·log10(1.25)

}  // namespace

double Row::rounding() const {
  return 0.5 * std::pow(10.0, -digits);
}

Measured Row::required(Source source) const {
  if (judged == Judged::kNo || source == Source::kNone) return {};
  const Measured& own = source == Source::kRadarScenes ? radar_scenes : nuscenes;
  const Measured& other = source == Source::kRadarScenes ? nuscenes : radar_scenes;
  return own.exists() || judged == Judged::kOwn ? own : other;
}

Verdict judge(const Row& row, Source source, const Spread& figure) {
  const Measured required = row.required(source);
  if (!required.exists()) return {};
  if (std::isnan(figure.median)) return {Outcome::kNoData, 0.0};
  const bool is_level = row.scale == Scale::kLevel_db;
  const auto tolerance = [&](double measured) {
    return (is_level ? kTolerance_db : kTolerance * std::abs(measured)) + row.rounding();
  };
  const double low = required.low - tolerance(required.low), high = required.high + tolerance(required.high);
  const double nearest = std::clamp(figure.median, required.low, required.high);
  const double distance = figure.median - nearest;
  // The part beyond a measured zero cannot be a share of it.
  const double off = is_level ? distance : nearest == 0.0 ? kNoFigure : distance / std::abs(nearest);
  if (figure.median >= low && figure.median <= high) return {Outcome::kMet, off};
  return {figure.high >= low && figure.low <= high ? Outcome::kMetByInterval : Outcome::kMissed, off};
}

std::string Verdict::text(Scale scale) const {
  switch (outcome) {
    case Outcome::kNotJudged:
      return "";
    case Outcome::kMet:
      return "within";
    case Outcome::kMetByInterval:
      return "interval within";
    case Outcome::kNoData:
      return "no data";
    case Outcome::kMissed:
      break;
  }
  if (std::isnan(off)) return "off: not 0";
  const std::string sign = off < 0.0 ? "−" : "+";
  return scale == Scale::kLevel_db ? "off by " + sign + fixed(std::abs(off), 1) + " dB"
                                   : "off by " + sign + fixed(kPercent * std::abs(off), 0) + " %";
}

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  add_count_rows(rows);
  add_place_rows(rows);
  add_deviation_rows(rows);
  add_strength_rows(rows);
  add_stationary_rows(rows);
  add_false_mover_rows(rows);
  return rows;
}

const char* section_title(int section) {
  constexpr std::array<const char*, 6> kTitles{"1. Detections of an object in one scan of one radar",
                                               "2. Where on the body",
                                               "3. Range rate against the rigid body",
                                               "4. Strength: RCS as the sensor states it",
                                               "5. The stationary world",
                                               "6. False movers"};
  return section >= 1 && section <= 6 ? kTitles[static_cast<std::size_t>(section - 1)] : "";
}

}  // namespace boresight::bench::realism
