#include "tests/benchmarks/ghosts/common/findings.hpp"

#include <cmath>
#include <fstream>
#include <iostream>
#include <stdexcept>

namespace boresight::bench {

namespace {

void write_file(const std::string& path, const Report& report, void (Report::*writer)(std::ostream&) const) {
  if (path.empty()) return;
  std::ofstream out(path);
  (report.*writer)(out);
  out.flush();
  if (!out) throw std::runtime_error("cannot write " + path);
}

/// Up to four significant digits, since published percentages have them.
std::string limit_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

std::string text_of(const Limits& limits) {
  if (std::isinf(limits.low) && std::isinf(limits.high)) return "—";
  if (std::isinf(limits.low)) return "≤ " + limit_number(limits.high);
  if (std::isinf(limits.high)) return "≥ " + limit_number(limits.low);
  return limit_number(limits.low) + "–" + limit_number(limits.high);
}

std::string Findings::judge(const Interval& figure, const Limits& limits) {
  if (std::isinf(limits.low) && std::isinf(limits.high)) return "—";
  if (std::isnan(figure.low) || std::isnan(figure.high)) {
    ++without_data_;
    return "no data";
  }
  const bool is_met = figure.low <= limits.high && figure.high >= limits.low;
  ++(is_met ? met_ : missed_);
  return is_met ? "met" : "missed";
}

void Findings::add(Table table) {
  print_table(table, std::cout);
  std::cout.flush();
  report_.add(std::move(table));
}

void Findings::finish(const std::string& json, const std::string& markdown) const {
  std::cout << '\n' << met_ << " bars met, " << missed_ << " missed, " << without_data_ << " without data\n";
  write_file(json, report_, &Report::write_json);
  write_file(markdown, report_, &Report::write_markdown);
}

}  // namespace boresight::bench
