#include "services/common/runtime/vehicle_choice.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "services/common/runtime/config/reader.hpp"

namespace boresight::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kHowToChoose =
    "choose one by 'boresight vehicle use NAME|FILE'; 'boresight vehicle list' lists the names";

fs::path choice_of(const fs::path& directory) {
  return directory / "vehicle.toml";
}

}  // namespace

std::vector<std::string> vehicle_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path chosen_vehicle_file(const fs::path& directory) {
  std::error_code error;
  const fs::path choice = choice_of(directory), folder = directory / "vehicle";
  if (fs::is_symlink(choice, error)) {
    const fs::path file = directory / fs::read_symlink(choice, error);
    if (!error && fs::exists(file, error)) return file;
    throw config::Error(
        fmt::format("{}: the chosen vehicle {} does not exist; {}", choice.string(), file.string(), kHowToChoose));
  }
  if (!fs::is_directory(folder, error)) {
    throw config::Error(fmt::format("{}: cannot be read: {}", folder.string(),
                                    error ? error.message() : "it is no folder; must be one with vehicle files"));
  }
  const std::vector<std::string> names = vehicle_names(folder);
  if (names.size() == 1) return folder / (names.front() + ".toml");
  if (names.empty()) throw config::Error(fmt::format("{}: holds no vehicle; {}", folder.string(), kHowToChoose));
  throw config::Error(
      fmt::format("{}: holds several vehicles, and none is chosen; {} or name one by --vehicle or "
                  "$BORESIGHT_VEHICLE: {}",
                  folder.string(), kHowToChoose, fmt::join(names, ", ")));
}

void choose_vehicle(const fs::path& directory, const std::string& name) {
  const fs::path choice = choice_of(directory);
  const auto fail = [&choice](const std::error_code& error) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", choice.string(), error.message()));
  };
  std::error_code error;
  if (fs::exists(fs::symlink_status(choice, error)) && !fs::is_symlink(choice, error)) {
    throw std::runtime_error(fmt::format("{}: is no link that this command made; rename it", choice.string()));
  }
  fs::path partial = choice;
  partial += fmt::format(".partial-{}", getpid());
  fs::create_symlink(fs::path("vehicle") / (name + ".toml"), partial, error);
  if (error) fail(error);
  fs::rename(partial, choice, error);
  if (!error) return;
  std::error_code ignored;
  fs::remove(partial, ignored);
  fail(error);
}

fs::path example_vehicle_folder(const fs::path& binaries) {
  std::error_code ignored;
  const fs::path folder = binaries.parent_path() / "share" / "boresight" / "vehicle";
  return binaries.filename() == "bin" && fs::is_directory(folder, ignored) ? folder : fs::path();
}

fs::path example_vehicle_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : example_vehicle_folder(program.parent_path());
}

}  // namespace boresight::runtime
