// One row of the tables: a figure beside its measured values, and the rule of its verdict.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/benchmarks/realism/common/measuring_vehicle.hpp"
#include "tests/benchmarks/realism/rows/spread.hpp"
#include "tests/benchmarks/realism/statistics/statistics.hpp"

namespace boresight::bench::realism {

/// A measured value, or the span of the two measured drives. NaN: not measured.
struct Measured {
  double low, high;
  Measured() : Measured(kNoFigure) {}
  Measured(double value) : low(value), high(value) {}  // NOLINT(google-explicit-constructor): tables of plain numbers
  Measured(double from, double to) : low(from), high(to) {}
  [[nodiscard]] bool exists() const { return low <= high; }
};

enum class Scale : std::uint8_t {
  kRatio,     ///< within 25 % of the measured value
  kLevel_db,  ///< a level in dB: 25 % of the power are 1 dB
};

/// Whether a figure is compared with its measured value.
enum class Judged : std::uint8_t {
  kNo,
  kOwn,     ///< with the value of the profile's own radar
  kShared,  ///< a parameter for every radar: with the value of the other radar, too, if its own has none
};

struct Row {
  int section = 0;
  std::string name;
  std::string unit;
  int digits = 0;  ///< of the measured value as published; half of the last digit is its uncertainty
  Measured radar_scenes, nuscenes;
  Judged judged = Judged::kNo;
  std::function<double(const Statistics&)> figure;
  Scale scale = Scale::kRatio;

  [[nodiscard]] double rounding() const;
  /// The value to compare with; does not exist for a row without verdict.
  [[nodiscard]] Measured required(Source source) const;
};

enum class Outcome : std::uint8_t {
  kNotJudged,
  kMet,            ///< the median over the seeds is within the tolerance
  kMetByInterval,  ///< the median is not, but the interval reaches into the tolerance
  kMissed,
  kNoData,
};

struct Verdict {
  Outcome outcome = Outcome::kNotJudged;
  double off = 0.0;  ///< median beyond the measured value: a share of it, or in dB; NaN beside a measured zero
  [[nodiscard]] std::string text(Scale scale) const;
};

/// Compares a figure of a profile with the measured value of its radar.
[[nodiscard]] Verdict judge(const Row& row, Source source, const Spread& figure);

/// Rows of the sections 1 … 6, in the order of the tables.
[[nodiscard]] std::vector<Row> all_rows();
void add_count_rows(std::vector<Row>& rows);
void add_place_rows(std::vector<Row>& rows);
void add_deviation_rows(std::vector<Row>& rows);
void add_strength_rows(std::vector<Row>& rows);
void add_stationary_rows(std::vector<Row>& rows);
void add_false_mover_rows(std::vector<Row>& rows);

/// Titles of the sections; index 0 is section 1.
[[nodiscard]] const char* section_title(int section);

}  // namespace boresight::bench::realism
