#include "deploy/supervisor/configuration_watch.hpp"

#include <functional>
#include <string>
#include <system_error>

namespace boresight::supervisor {

std::uint64_t fingerprint_of(const std::filesystem::path& folder) {
  // A sum does not depend on the order in which the file system lists the files.
  std::uint64_t sum = 0;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    const std::uintmax_t bytes = std::filesystem::file_size(entry->path(), ignored);
    const auto written = std::filesystem::last_write_time(entry->path(), ignored).time_since_epoch().count();
    sum +=
        std::hash<std::string>()(entry->path().string() + " " + std::to_string(bytes) + " " + std::to_string(written));
  }
  return sum;
}

}  // namespace boresight::supervisor
