// A folder for the runs of a benchmark.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace boresight::bench::tracking {

/// It is removed at the end, unless the user named it.
class Place {
 public:
  explicit Place(const std::string& program, const std::string& kept = {})
      : path_(kept.empty() ? std::filesystem::temp_directory_path() / fmt::format("{}_{}", program, getpid())
                           : std::filesystem::path(kept)),
        is_kept_(!kept.empty()) {
    std::filesystem::create_directories(path_);
  }
  ~Place() {
    std::error_code ignored;
    if (!is_kept_) std::filesystem::remove_all(path_, ignored);
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool is_kept_;
};

}  // namespace boresight::bench::tracking
