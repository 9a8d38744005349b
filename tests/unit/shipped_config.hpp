// A shipped configuration file against the code that reads it.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::test {

/// All settings that are numbers, in one order, of a file's text.
using SettingsOf = std::function<std::vector<double>(const std::string& text)>;

/// Changes each number of the file a little, one at a time, and expects that exactly one setting changes by it, none
/// twice: a key that is written but not read, or read into another's place, is a lie. Tables whose name begins with
/// `but` are passed over. Returns how many settings the file has.
inline std::size_t expect_each_number_is_read(const std::filesystem::path& shipped, const SettingsOf& settings_of,
                                              std::string_view but = {}) {
  std::ifstream file(shipped);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  const auto text_with = [&lines](std::size_t index, const std::string& changed) {
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) text += (i == index ? changed : lines[i]) + "\n";
    return text;
  };
  const std::vector<double> before = settings_of(text_with(lines.size(), {}));
  std::vector<int> changes(before.size(), 0);
  bool passed_over = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with("[")) passed_over = !but.empty() && lines[i].starts_with("[" + std::string(but));
    const std::size_t equals = lines[i].find(" = ");
    if (passed_over || equals == std::string::npos || lines[i].front() == '#') continue;
    const std::string written = lines[i].substr(equals + 3);
    if (std::isdigit(static_cast<unsigned char>(written.front())) == 0 && written.front() != '-') continue;
    std::size_t end = 0;
    const double value = std::stod(written, &end);
    std::ostringstream changed;
    changed.precision(12);
    if (written.substr(0, end).find_first_of(".e") == std::string::npos) {
      changed << static_cast<long>(value) + 1;
    } else {
      changed << std::scientific << (value == 0.0 ? 0.03 : 0.97 * value);
    }
    const std::vector<double> after = settings_of(text_with(i, lines[i].substr(0, equals + 3) + changed.str()));
    int different = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (after[k] == before[k]) continue;
      ++different;
      ++changes[k];
    }
    EXPECT_EQ(different, 1) << lines[i];
  }
  EXPECT_EQ(std::count_if(changes.begin(), changes.end(), [](int n) { return n > 1; }), 0);
  return static_cast<std::size_t>(std::count(changes.begin(), changes.end(), 1));
}

}  // namespace boresight::test
