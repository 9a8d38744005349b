#include "services/boresight/track/scenario_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "services/common/recording/byte_source.hpp"
#include "services/common/recording/line_reader.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/text/near_names.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::track {

namespace {

constexpr std::size_t kLongestLine = 8192;

/// A key with the shape of its matrix and the allowed values of every element.
struct Key {
  std::string_view name;
  std::size_t rows, columns;  ///< columns 0: one or more
  double min, max;
  bool required = true;
};

constexpr double kLarge = 1e6;
constexpr std::array kKeys = {
    Key{"Ps", 1, 1, 0.0, 1.0},
    Key{"Ts", 1, 1, 1e-3, 3600.0},
    Key{"q", 1, 1, 0.0, kLarge},
    Key{"eta", 1, 1, 1.0, 100.0},
    Key{"tau", 1, 1, 1e-3, 1e9},
    Key{"birth_w", 1, 1, 1e-9, 1e3},
    Key{"birth_xr", 4, 0, -kLarge, kLarge},
    Key{"birth_std", 1, 4, 1e-6, kLarge},
    Key{"birth_V", 2, 2, -kLarge, kLarge},
    Key{"birth_v", 1, 1, 7.0, kLarge},
    Key{"birth_alpha", 1, 1, 1e-3, kLarge},
    Key{"birth_beta", 1, 1, 1e-3, kLarge},
    Key{"Ch", 1, 1, 1e-6, 100.0},
    Key{"Cv", 1, 1, 0.0, kLarge},
    Key{"Pd", 1, 1, 1e-3, 1.0},
    Key{"range_x", 1, 2, -kLarge, kLarge},
    Key{"range_y", 1, 2, -kLarge, kLarge},
    Key{"c_lambda", 1, 1, 1e-6, kLarge},
    Key{"T", 1, 1, 1.0, kLarge},
    Key{"range_rate_std", 1, 1, 1e-3, 100.0, false},
    Key{"range_rate_span", 1, 1, 1e-3, 1e3, false},
};
/// Of the simulation, or of a tracker with partitions and pruning.
constexpr std::array<std::string_view, 7> kIgnoredKeys = {"seed",      "db_max",   "db_min", "db_grid",
                                                          "mb_approx", "mb_merge", "maxn"};

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string quoted_value(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  return "\"" + text::printable(text.substr(0, kLongest)) + (text.size() > kLongest ? "…\"" : "\"");
}

using Rows = std::vector<std::vector<double>>;

std::optional<std::vector<double>> row_of(std::string_view text) {
  std::vector<double> row;
  for (std::string_view rest = trimmed(text); !rest.empty(); rest = trimmed(rest)) {
    const std::size_t end = std::min(rest.find_first_of(" \t,"), rest.size());
    double value = 0.0;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + end, value);
    if (error != std::errc{} || stop != rest.data() + end) return std::nullopt;
    row.push_back(value);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return row;
}

/// "3", or "[1 2;3 4]" with rows between semicolons.
std::optional<Rows> rows_of(std::string_view text) {
  if (text.starts_with('[') != text.ends_with(']')) return std::nullopt;
  if (text.starts_with('[')) text = text.substr(1, text.size() - 2);
  Rows rows;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    std::optional<std::vector<double>> row = row_of(text.substr(begin, end - begin));
    if (!row) return std::nullopt;
    rows.push_back(std::move(*row));
    begin = end + 1;
  }
  return rows;
}

bool has_allowed_shape(const Rows& rows, const Key& key) {
  const std::size_t columns = key.columns != 0 ? key.columns : std::max<std::size_t>(rows.front().size(), 1);
  return rows.size() == key.rows &&
         std::all_of(rows.begin(), rows.end(), [&](const auto& row) { return row.size() == columns; });
}

bool is_in_range(const Rows& rows, const Key& key) {
  for (const std::vector<double>& row : rows) {
    // Written so that NaN is not allowed.
    if (!std::all_of(row.begin(), row.end(), [&](double v) { return v >= key.min && v <= key.max; })) return false;
  }
  return true;
}

std::string allowed(const Key& key) {
  const std::string range = fmt::format("{:g} … {:g}", key.min, key.max);
  if (key.rows == 1 && key.columns == 1) return "a number " + range;
  const std::string columns = key.columns == 0 ? "any number of" : std::to_string(key.columns);
  return fmt::format("a matrix of {} rows and {} columns, each number {}", key.rows, columns, range);
}

class Reading {
 public:
  explicit Reading(const std::filesystem::path& file) : source_(file), lines_(source_, kLongestLine) {}

  ScenarioFile read() {
    for (std::string_view line; lines_.next(line);) {
      ++line_number_;
      take(trimmed(line));
    }
    if (lines_.error() != 0) {
      throw std::runtime_error(fmt::format("{}: cannot be read after line {}: {}", source_.name(), line_number_,
                                           std::strerror(lines_.error())));
    }
    for (const Key& key : kKeys) {
      if (key.required && !line_of_.contains(key.name)) {
        problems_.push_back(fmt::format("{}: {}: is missing; allowed is {}", source_.name(), key.name, allowed(key)));
      }
    }
    finish();
    check();
    finish();
    return scenario();
  }

 private:
  void take(std::string_view line) {
    if (line.empty() || line.front() == '#') return;
    const std::size_t equals = line.find('=');
    const std::string_view name = trimmed(line.substr(0, std::min(equals, line.size())));
    if (equals == std::string_view::npos) {
      problems_.push_back(fmt::format("{}:{}: read {}, allowed is KEY = VALUE, or a comment after '#'", source_.name(),
                                      line_number_, quoted_value(line)));
      return;
    }
    const std::string_view value = trimmed(line.substr(equals + 1));
    const auto key = std::find_if(kKeys.begin(), kKeys.end(), [&](const Key& k) { return k.name == name; });
    const auto ignored = std::find(kIgnoredKeys.begin(), kIgnoredKeys.end(), name);
    if (key == kKeys.end() && ignored == kIgnoredKeys.end()) return unknown(name);
    const std::string_view known_name = key != kKeys.end() ? key->name : *ignored;
    if (const auto [before, is_new] = line_of_.emplace(known_name, line_number_); !is_new) {
      problems_.push_back(fmt::format("{}:{}: {}: is given twice, first on line {}", source_.name(), line_number_,
                                      known_name, before->second));
      return;
    }
    if (key == kKeys.end()) return;
    const std::optional<Rows> rows = rows_of(value);
    if (!rows || !has_allowed_shape(*rows, *key) || !is_in_range(*rows, *key)) {
      return refuse(key->name, fmt::format("read {}, allowed is {}", quoted_value(value), allowed(*key)));
    }
    values_[known_name] = *rows;
  }

  void unknown(std::string_view name) {
    std::vector<std::string> known;
    for (const Key& key : kKeys) known.emplace_back(key.name);
    const std::vector<std::string> near = near_names(name, known);
    const std::string help = near.empty() ? fmt::format("known keys: {}, and without effect: {}",
                                                        fmt::join(known, ", "), fmt::join(kIgnoredKeys, ", "))
                                          : fmt::format("did you mean '{}'?", near.front());
    problems_.push_back(
        fmt::format("{}:{}: unknown key {}; {}", source_.name(), line_number_, quoted_value(name), help));
  }

  void refuse(std::string_view key, const std::string& problem) {
    problems_.push_back(fmt::format("{}:{}: {}: {}", source_.name(), line_of_.at(key), key, problem));
  }

  /// What holds between several numbers.
  void check() {
    for (const std::string_view key : {"range_x", "range_y"}) {
      if (!(element(key, 0, 0) < element(key, 0, 1))) {
        refuse(key, fmt::format("read [{:g} {:g}], allowed is the smaller limit first", element(key, 0, 0),
                                element(key, 0, 1)));
      }
    }
    const double xx = element("birth_V", 0, 0), xy = element("birth_V", 0, 1), yy = element("birth_V", 1, 1);
    if (xy != element("birth_V", 1, 0) || !(xx > 0.0) || !(xx * yy > xy * xy)) {
      refuse("birth_V", "allowed is a symmetric positive definite matrix");
    }
    if (const double scans = number("T"); scans != static_cast<double>(static_cast<std::size_t>(scans))) {
      refuse("T", fmt::format("read {:g}, allowed is a whole number", scans));
    }
    if (line_of_.contains("range_rate_std") != line_of_.contains("range_rate_span")) {
      const std::string_view given = line_of_.contains("range_rate_std") ? "range_rate_std" : "range_rate_span";
      refuse(given, "range_rate_std and range_rate_span (of clutter) belong together: give both or neither");
    }
  }

  ScenarioFile scenario() const {
    ScenarioFile file;
    tracking::LinearScenario& model = file.model;
    model.survival_probability = number("Ps");
    model.step_s = number("Ts");
    model.acceleration_density = number("q");
    model.rate_forgetting = number("eta");
    model.extent_memory_s = number("tau");
    model.detection_probability = number("Pd");
    model.spread = number("Ch");
    model.noise_variance_m2 = number("Cv");
    model.clutter_per_scan = number("c_lambda");
    if (line_of_.contains("range_rate_std")) {
      model.range_rate_std_mps = number("range_rate_std");
      model.clutter_range_rate_span_mps = number("range_rate_span");
    }
    model.area_min_m = {element("range_x", 0, 0), element("range_y", 0, 0)};
    model.area_max_m = {element("range_x", 0, 1), element("range_y", 0, 1)};
    model.birth_weight = number("birth_w");
    for (std::size_t column = 0; column < values_.at("birth_xr").front().size(); ++column) {
      tracking::ScenarioBirth& birth = model.births.emplace_back();
      for (std::size_t i = 0; i < 4; ++i) {
        birth.mean(static_cast<Eigen::Index>(i)) = element("birth_xr", i, column);
        birth.std(static_cast<Eigen::Index>(i)) = element("birth_std", 0, i);
      }
      birth.extent_scale << element("birth_V", 0, 0), element("birth_V", 0, 1),  //
          element("birth_V", 1, 0), element("birth_V", 1, 1);
      birth.extent_dof = number("birth_v");
      birth.rate_shape = number("birth_alpha");
      birth.rate_inverse_scale = number("birth_beta");
    }
    file.number_of_scans = static_cast<std::size_t>(number("T"));
    return file;
  }

  [[nodiscard]] double element(std::string_view key, std::size_t row, std::size_t column) const {
    return values_.at(key)[row][column];
  }
  [[nodiscard]] double number(std::string_view key) const { return element(key, 0, 0); }

  void finish() const {
    if (!problems_.empty()) throw config::Error(fmt::format("{}", fmt::join(problems_, "\n")));
  }

  recording::ByteSource source_;
  recording::LineReader lines_;
  std::size_t line_number_ = 0;
  std::map<std::string_view, std::size_t> line_of_;  // of every key that was read
  std::map<std::string_view, Rows> values_;
  std::vector<std::string> problems_;
};

}  // namespace

ScenarioFile read_scenario_file(const std::filesystem::path& file) {
  return Reading(file).read();
}

}  // namespace boresight::track
