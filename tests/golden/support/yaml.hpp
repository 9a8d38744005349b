// Reads the subset of YAML that the expected decodings use.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace boresight::golden {

using Record = std::map<std::string, double>;

/// The `key: number` lines of a list. Lines before the first `- ` go to `head`. True and false are 1 and 0. Within the
/// list, the numbers of a nested mapping are named "mapping.key".
inline std::vector<Record> read_yaml_list(const std::filesystem::path& file, Record& head) {
  std::vector<Record> records;
  std::ifstream input(file);
  std::string mapping;
  std::size_t mapping_begin = 0;
  for (std::string line; std::getline(input, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    if (line.find("- ") != std::string::npos) records.emplace_back();
    const std::size_t begin = line.find_first_not_of(" -");
    const std::string text = line.substr(colon + 1);
    const double value = text.find("true") != std::string::npos ? 1.0 : std::atof(text.c_str());
    if (begin <= mapping_begin) mapping.clear();
    (records.empty() ? head : records.back())[mapping + line.substr(begin, colon - begin)] = value;
    if (!records.empty() && text.empty()) {
      mapping = line.substr(begin, colon - begin) + '.';
      mapping_begin = begin;
    }
  }
  return records;
}

}  // namespace boresight::golden
