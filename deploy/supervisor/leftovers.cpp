#include "deploy/supervisor/leftovers.hpp"

#include <cerrno>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace boresight::supervisor {

std::optional<std::string> running_roudi(const Places& places) {
  const std::filesystem::path lock = places.sockets / "iox-unique-roudi.lock";
  const int descriptor = open(lock.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) {
    if (errno == EACCES) return lock.string() + " belongs to another user, whose RouDi is running or was killed";
    return std::nullopt;
  }
  const bool held = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  if (held) return "another RouDi runs on this machine (it holds " + lock.string() + "); stop it first";
  return std::nullopt;
}

void wait_for_end_of_roudi(const Places& places) {
  constexpr int kPatience_ms = 500;
  constexpr int kLook_ms = 5;
  for (int waited_ms = 0; waited_ms < kPatience_ms && running_roudi(places); waited_ms += kLook_ms) {
    usleep(kLook_ms * 1000);
  }
}

std::vector<ino_t> segment_inodes(const Places& places, const std::vector<std::string>& segments) {
  std::vector<ino_t> inodes;
  for (const std::string& segment : segments) {
    struct stat status {};
    inodes.push_back(stat((places.shared_memory / segment).c_str(), &status) == 0 ? status.st_ino : 0);
  }
  return inodes;
}

std::vector<std::string> reserved_segments(const std::string& roudi_output) {
  static constexpr std::string_view kAnnouncement = "bytes in the shared memory [";
  std::vector<std::string> names;
  for (std::size_t at = roudi_output.find(kAnnouncement); at != std::string::npos;
       at = roudi_output.find(kAnnouncement, at + 1)) {
    const std::size_t begin = at + kAnnouncement.size();
    const std::size_t end = roudi_output.find(']', begin);
    if (end == std::string::npos) break;
    const std::string name = roudi_output.substr(begin, end - begin);
    if (!name.empty() && name.find('/') == std::string::npos) names.push_back(name);
  }
  return names;
}

std::vector<std::filesystem::path> leftovers(const Places& places, const std::vector<std::string>& segments,
                                             const std::vector<std::string>& runtime_names) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : segments) files.push_back(places.shared_memory / name);
  for (const std::string& name : runtime_names) {
    files.push_back(places.sockets / name);
    files.push_back(places.sockets / (name + ".lock"));
  }
  for (const char* name : {"roudi", "roudi.lock", "iox-unique-roudi.lock"}) files.push_back(places.sockets / name);
  return files;
}

}  // namespace boresight::supervisor
