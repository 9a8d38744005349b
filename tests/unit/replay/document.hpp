// The worked examples of the Boresight service's definition, as bytes.
#pragma once

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace boresight::replay {

/// The bytes of the example of that name; empty if there is none.
inline std::vector<std::uint8_t> document_example(const std::string& name) {
  std::ifstream file(BORESIGHT_SOURCE_DIR "/interfaces/wire/boresight_service.md");
  std::vector<std::uint8_t> bytes;
  std::string line;
  while (std::getline(file, line) && line != "<!-- example: " + name + " -->") {
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

}  // namespace boresight::replay
