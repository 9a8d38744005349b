// What the benchmark reports of an evaluation: tables, and bars with "met" or "missed".
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tests/benchmarks/common/report.hpp"
#include "tests/benchmarks/tracking/drives/judge/estimates.hpp"

namespace boresight::bench::tracking {

/// Groups of --only.
inline constexpr const char* kTracked = "tracked";
inline constexpr const char* kFalse = "false";
inline constexpr const char* kExistence = "existence";
inline constexpr const char* kEllipse = "ellipse";
inline constexpr const char* kCars = "cars";
inline constexpr const char* kTime = "time";

struct GroupTable {
  std::string group;
  Table table;
};

struct BarLine {
  std::string group, scope, tracker;  ///< scope: profile, or "pooled"
  std::string what;
  double figure = 0.0;  ///< that is compared with the limit
  std::string shown;    ///< the figure with interval and unit
  std::string limit;
  bool met = false;
};

struct Findings {
  std::vector<GroupTable> tables;
  std::vector<BarLine> bars;
};

void add_tables(const Evaluation& evaluation, Findings& findings);
void add_bars(const Evaluation& evaluation, Findings& findings);

void print(const Findings& findings, const std::string& only, std::ostream& out);
/// `drives`: their names, with seeds.
void write_json(const Findings& findings, const std::string& only, const std::vector<std::string>& drives,
                std::ostream& out);

}  // namespace boresight::bench::tracking
