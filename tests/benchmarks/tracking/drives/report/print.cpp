#include <algorithm>
#include <cmath>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "tests/benchmarks/tracking/drives/report/findings.hpp"

namespace boresight::bench::tracking {

namespace {

bool is_wanted(const std::string& group, const std::string& only) {
  return only.empty() || only == group;
}

}  // namespace

void print(const Findings& findings, const std::string& only, std::ostream& out) {
  for (const GroupTable& each : findings.tables) {
    if (is_wanted(each.group, only)) print_table(each.table, out);
  }
  out << '\n';
  std::size_t count = 0, missed = 0;
  for (const BarLine& bar : findings.bars) {
    if (!is_wanted(bar.group, only)) continue;
    ++count;
    missed += bar.met ? 0 : 1;
    out << fmt::format("bar [{}] {}: {}: {}; required {}: {}\n", bar.scope, bar.tracker, bar.what, bar.shown, bar.limit,
                       bar.met ? "met" : "missed");
  }
  out << fmt::format("\n{} bars, {} missed\n", count, missed);
}

void write_json(const Findings& findings, const std::string& only, const std::vector<std::string>& drives,
                std::ostream& out) {
  json::Value value;
  value["drives"] = drives;
  json::Value& bars = value["bars"] = json::Value::array();
  for (const BarLine& bar : findings.bars) {
    if (!is_wanted(bar.group, only)) continue;
    json::Value each;
    each["group"] = bar.group;
    each["scope"] = bar.scope;
    each["tracker"] = bar.tracker;
    each["what"] = bar.what;
    each["figure"] = std::isfinite(bar.figure) ? json::Value(bar.figure) : json::Value();
    each["shown"] = bar.shown;
    each["limit"] = bar.limit;
    each["met"] = bar.met;
    bars.push_back(each);
  }
  json::Value& tables = value["tables"] = json::Value::array();
  for (const GroupTable& of : findings.tables) {
    if (!is_wanted(of.group, only)) continue;
    json::Value each;
    each["group"] = of.group;
    each["name"] = of.table.name;
    each["caption"] = of.table.caption;
    each["header"] = of.table.header;
    each["rows"] = of.table.rows;
    tables.push_back(each);
  }
  out << json::document(value);
}

}  // namespace boresight::bench::tracking
