// Calls the program as a user does, in a folder of small tables.
#pragma once

#include <array>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/unit/track/files.hpp"

namespace boresight::track::testing {

class CommandTest : public ::testing::Test {
 protected:
  Files files_{"track_commands"};
  std::string output_;

  /// Exit code; output and errors are in output_.
  int run(const std::string& arguments) {
    const std::string command =
        "cd '" + files_.path("").string() + "' && " BORESIGHT_BINARY_DIR "/boresight " + arguments + " 2>&1";
    output_.clear();
    std::FILE* const pipe = popen(command.c_str(), "re");
    if (pipe == nullptr) return -1;
    std::array<char, 4096> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output_ += buffer.data();
    return WEXITSTATUS(pclose(pipe));
  }
};

}  // namespace boresight::track::testing
