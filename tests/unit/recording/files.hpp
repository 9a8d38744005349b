// A folder of recordings for one test.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/recording/reader.hpp"

namespace boresight::recording {

class Files : public testing::Test {
 protected:
  Files() : folder_(std::filesystem::temp_directory_path() / ("boresight_recording_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Files() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  struct Copied {
    Frame frame;
    std::string data;
  };
  struct Contents {
    std::vector<Copied> frames;
    Counts counts;
    Progress progress;
  };
  Contents read(const std::filesystem::path& file, const ReadOptions& options = {}) {
    const auto reader = open_recording(file, note_, options);
    Contents contents;
    Frame frame;
    while (reader->next(frame)) {
      contents.frames.push_back({frame, std::string(frame.payload.begin(), frame.payload.end())});
    }
    contents.counts = reader->counts();
    contents.progress = reader->progress();
    return contents;
  }

  std::filesystem::path folder_;
  std::vector<std::string> problems_;
  OnProblem note_ = [this](const std::string& text) { problems_.push_back(text); };
};

}  // namespace boresight::recording
