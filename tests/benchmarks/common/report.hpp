// Result of a benchmark: bars (required values) with PASS or FAIL, tables, and curves for the figures; written as text,
// Markdown and JSON.
#pragma once

#include <cmath>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace boresight::bench {

struct Bar {
  std::string group;
  std::string what;
  double figure = 0.0;
  double low = 0.0;  ///< passes in low…high; infinite: no such limit; both infinite: no bar
  double high = 0.0;
  std::string unit;
  std::string how;  ///< drives, seeds, statistic

  /// False for a figure without a bar, reported for comparison.
  [[nodiscard]] bool is_judged() const { return std::isfinite(low) || std::isfinite(high); }
  [[nodiscard]] bool passes() const { return figure >= low && figure <= high; }
  [[nodiscard]] const char* verdict() const;
  [[nodiscard]] std::string limit() const;
};

struct Table {
  std::string name;
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// As text, columns aligned.
void print_table(const Table& table, std::ostream& out);

/// One curve of one panel of a figure.
struct Curve {
  std::string figure;
  std::string panel;
  std::string label;
  std::vector<std::pair<double, double>> points;
};

class Report {
 public:
  Report() = default;
  /// Not `judged`: every figure is reported without a bar.
  Report(std::string profile, bool judged) : profile_(std::move(profile)), judged_(judged) {}

  void at_most(std::string group, std::string what, double figure, double bar, std::string unit, std::string how);
  void at_least(std::string group, std::string what, double figure, double bar, std::string unit, std::string how);
  void within(std::string group, std::string what, double figure, double low, double high, std::string unit,
              std::string how);
  /// Adds a figure without a bar for comparison.
  void beside(std::string group, std::string what, double figure, std::string unit, std::string how);
  void add(Table table) { tables_.push_back(std::move(table)); }
  void add(Curve curve) { curves_.push_back(std::move(curve)); }

  [[nodiscard]] const std::vector<Bar>& bars() const { return bars_; }
  void print(std::ostream& out) const;
  /// Each table between the marks of the document, <!-- begin: NAME --> and <!-- end: NAME -->.
  void write_markdown(std::ostream& out) const;
  void write_json(std::ostream& out) const;

 private:
  [[nodiscard]] Table bars_table() const;
  void add_bar(Bar bar);
  std::string profile_;  // of the drives: Options::drives()
  bool judged_ = true;
  std::vector<Bar> bars_;
  std::vector<Table> tables_;
  std::vector<Curve> curves_;
};

/// Three significant digits; "—" if not a number, "never" if infinite.
[[nodiscard]] std::string number(double value);
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace boresight::bench
