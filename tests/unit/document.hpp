// The worked examples of a definition in interfaces/wire, as bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace boresight::test {

/// The bytes of the example of that name in interfaces/wire/`document`; empty if there is none.
inline std::vector<std::uint8_t> document_example(const std::string& document, const std::string& name) {
  std::ifstream file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "interfaces" / "wire" / document);
  std::vector<std::uint8_t> bytes;
  std::string line;
  std::string mark = "<!-- example: ";
  mark.append(name).append(" -->");
  while (std::getline(file, line) && line != mark) {
  }
  std::getline(file, line);
  while (std::getline(file, line) && line != "```") {
    std::istringstream text(line);
    std::string word;
    text >> word;  // the offset
    while (text >> word) bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
  }
  return bytes;
}

}  // namespace boresight::test
