#include "services/common/runtime/runtime_directory.hpp"

#include <cstdlib>

#include <unistd.h>

namespace boresight::runtime {

std::string runtime_directory() {
  if (const char* const own = std::getenv("BORESIGHT_RUNTIME_DIR")) return own;
  if (const char* const systemd = std::getenv("RUNTIME_DIRECTORY")) {
    const std::string list(systemd);
    return list.substr(0, list.find(':'));
  }
  return "/tmp/boresight-" + std::to_string(getuid());
}

}  // namespace boresight::runtime
