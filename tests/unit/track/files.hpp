// A folder of small tables for the tests, removed at the end.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

namespace boresight::track::testing {

class Files {
 public:
  explicit Files(std::string_view name)
      : folder_(std::filesystem::temp_directory_path() / (std::string(name) + "." + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Files() { std::filesystem::remove_all(folder_); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  [[nodiscard]] std::filesystem::path path(std::string_view name) const { return folder_ / name; }
  std::filesystem::path write(std::string_view name, std::string_view text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

/// Parameters as the shared scenarios have them.
inline constexpr std::string_view kParameters =
    "seed = 11\n"
    "Ps = 0.98999999999999999\n"
    "Ts = 0.10000000000000001\n"
    "q = 2\n"
    "eta = 1.1000000000000001\n"
    "tau = 5\n"
    "birth_w = 0.02\n"
    "birth_xr = [80 -15;-2 0.5;-3 4;0 1]\n"
    "birth_std = [15 5 6 1.5]\n"
    "birth_V = [49 2;2 16.8]\n"
    "birth_v = 20\n"
    "birth_alpha = 16\n"
    "birth_beta = 2\n"
    "Ch = 0.25\n"
    "Cv = 0.09\n"
    "Pd = 0.9\n"
    "range_x = [-80 120]\n"
    "range_y = [-25 25]\n"
    "c_lambda = 15\n"
    "db_max = 4\n"
    "mb_approx = false\n"
    "T = 3\n"
    "maxn = Inf\n"
    "# state [x y vx vy]\n";

}  // namespace boresight::track::testing
