#include "tests/benchmarks/common/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <ostream>

namespace boresight::bench {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

std::string formatted(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A JSON string; the benchmarks' texts have no control characters.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string json_number(double value) {
  return std::isfinite(value) ? formatted("%.6g", value) : "null";
}

std::string json_strings(const std::vector<std::string>& texts) {
  std::string out = "[";
  for (const std::string& text : texts) out += (out.size() > 1 ? "," : "") + quoted(text);
  return out + "]";
}

/// Number of characters, not bytes: the texts are UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

void print_table(const Table& table, std::ostream& out) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : table.header) widths.push_back(width(cell));
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size() && i < widths.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  const auto line = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      out << row[i];
      if (i + 1 < row.size()) out << std::string(widths[i] - width(row[i]) + 2, ' ');
    }
    out << '\n';
  };
  out << '\n' << table.caption << '\n';
  line(table.header);
  for (const auto& row : table.rows) line(row);
}

std::string number(double value) {
  if (std::isnan(value)) return "—";
  if (std::isinf(value)) return "never";
  // As a whole number: 1.81e+03 is hard to read.
  if (std::abs(value) >= 999.5 && std::abs(value) < 1e7) return fixed(value, 0);
  return formatted("%.3g", value);
}

std::string fixed(double value, int digits) {
  if (std::isnan(value)) return "—";
  if (std::isinf(value)) return "never";
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string Bar::limit() const {
  if (!is_judged()) return "—";
  if (std::isinf(low)) return "≤ " + number(high);
  if (std::isinf(high)) return "≥ " + number(low);
  return number(low) + "–" + number(high);
}

const char* Bar::verdict() const {
  if (!is_judged()) return "—";
  return passes() ? "PASS" : "FAIL";
}

void Report::add_bar(Bar bar) {
  if (!judged_) {
    bar.low = -kNone;
    bar.high = kNone;
  }
  bars_.push_back(std::move(bar));
}

void Report::at_most(std::string group, std::string what, double figure, double bar, std::string unit,
                     std::string how) {
  add_bar({std::move(group), std::move(what), figure, -kNone, bar, std::move(unit), std::move(how)});
}

void Report::at_least(std::string group, std::string what, double figure, double bar, std::string unit,
                      std::string how) {
  add_bar({std::move(group), std::move(what), figure, bar, kNone, std::move(unit), std::move(how)});
}

void Report::within(std::string group, std::string what, double figure, double low, double high, std::string unit,
                    std::string how) {
  add_bar({std::move(group), std::move(what), figure, low, high, std::move(unit), std::move(how)});
}

void Report::beside(std::string group, std::string what, double figure, std::string unit, std::string how) {
  add_bar({std::move(group), std::move(what), figure, -kNone, kNone, std::move(unit), std::move(how)});
}

Table Report::bars_table() const {
  Table table{"bars", "bars", {"group", "figure", "measured", "required", "result", "conditions"}, {}};
  std::string group;
  for (const Bar& bar : bars_) {
    const std::string unit = bar.unit.empty() ? "" : " " + bar.unit;
    table.rows.push_back({bar.group == group ? "" : bar.group, bar.what, number(bar.figure) + unit,
                          bar.is_judged() ? bar.limit() + unit : bar.limit(), bar.verdict(), bar.how});
    group = bar.group;
  }
  return table;
}

void Report::print(std::ostream& out) const {
  for (const Table& table : tables_) print_table(table, out);
  if (!bars_.empty()) print_table(bars_table(), out);
  const auto judged = std::count_if(bars_.begin(), bars_.end(), [](const Bar& bar) { return bar.is_judged(); });
  const auto failed =
      std::count_if(bars_.begin(), bars_.end(), [](const Bar& bar) { return bar.is_judged() && !bar.passes(); });
  out << '\n' << judged << " bars, " << failed << " failed\n";
}

void Report::write_markdown(std::ostream& out) const {
  std::vector<Table> all = tables_;
  if (!bars_.empty()) all.push_back(bars_table());
  const auto line = [&](const std::vector<std::string>& row) {
    out << '|';
    for (const std::string& cell : row) {
      out << ' ';
      for (const char c : cell) out << (c == '|' ? "\\|" : std::string(1, c));
      out << " |";
    }
    out << '\n';
  };
  for (const Table& table : all) {
    out << "<!-- begin: " << table.name << " -->\n";
    if (table.name != "bars") out << '*' << table.caption << "*\n\n";
    line(table.header);
    out << '|';
    for (std::size_t i = 0; i < table.header.size(); ++i) out << "---|";
    out << '\n';
    for (const auto& row : table.rows) line(row);
    out << "<!-- end: " << table.name << " -->\n\n";
  }
}

void Report::write_json(std::ostream& out) const {
  out << "{\"profile\":" << quoted(profile_) << ",\"bars\":[";
  for (std::size_t i = 0; i < bars_.size(); ++i) {
    const Bar& bar = bars_[i];
    out << (i > 0 ? ",\n" : "\n") << "{\"group\":" << quoted(bar.group) << ",\"what\":" << quoted(bar.what)
        << ",\"figure\":" << json_number(bar.figure) << ",\"low\":" << json_number(bar.low)
        << ",\"high\":" << json_number(bar.high) << ",\"unit\":" << quoted(bar.unit) << ",\"pass\":"
        << (!bar.is_judged() ? "null"
            : bar.passes()   ? "true"
                             : "false")
        << ",\"how\":" << quoted(bar.how) << '}';
  }
  out << "],\n\"tables\":[";
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const Table& table = tables_[i];
    out << (i > 0 ? ",\n" : "\n") << "{\"name\":" << quoted(table.name) << ",\"caption\":" << quoted(table.caption)
        << ",\"header\":" << json_strings(table.header) << ",\"rows\":[";
    for (std::size_t r = 0; r < table.rows.size(); ++r) out << (r > 0 ? "," : "") << json_strings(table.rows[r]);
    out << "]}";
  }
  out << "],\n\"curves\":[";
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const Curve& curve = curves_[i];
    out << (i > 0 ? ",\n" : "\n") << "{\"figure\":" << quoted(curve.figure) << ",\"panel\":" << quoted(curve.panel)
        << ",\"label\":" << quoted(curve.label) << ",\"points\":[";
    for (std::size_t p = 0; p < curve.points.size(); ++p) {
      out << (p > 0 ? "," : "") << '[' << json_number(curve.points[p].first) << ','
          << json_number(curve.points[p].second) << ']';
    }
    out << "]}";
  }
  out << "]}\n";
}

}  // namespace boresight::bench
