// Plays RouDi or a service for the supervisor's tests: `fake_domain_process roudi DIR [option…]` behaves towards the
// outside as boresight-roudi does (files, lock, READY and WATCHDOG datagrams), `… service DIR [option…]` as a service
// does (READY and WATCHDOG datagrams).
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace {

volatile std::sig_atomic_t stopped = 0;

void notify(const std::string& text) {
  const char* const path = std::getenv("NOTIFY_SOCKET");
  if (path == nullptr) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path, sizeof(address.sun_path) - 1);
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sendto(descriptor, text.data(), text.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&address),
         sizeof(address));
  close(descriptor);
}

/// True for the first process that asks with this name, so that only the first incarnation behaves well or badly.
bool first_time(const std::string& directory, const std::string& name) {
  const std::string marker = directory + "/" + name + ".started";
  const int descriptor = open(marker.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  return descriptor >= 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argv[1];
  const std::string directory = argv[2];
  const std::string option = argc > 3 ? argv[3] : "";
  if (option == "fail") return 3;
  if (option == "refuse") {
    std::cerr << "first line\nservices/x.toml:3: key must be positive" << std::endl;
    return 2;
  }
  if (option == "refuse_later" && !first_time(directory, argv[4]) &&
      !std::ifstream(directory + "/../config/mended").is_open()) {
    std::cerr << "services/x.toml:4: unknown key" << std::endl;
    return 2;
  }
  std::signal(
      SIGTERM, option == "deaf" ? SIG_IGN : +[](int) { stopped = 1; });
  if (kind == "roudi") {
    if (option == "silent_later" && !first_time(directory, "roudi")) std::this_thread::sleep_for(std::chrono::hours(1));
    const int lock = open((directory + "/iox-unique-roudi.lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    if (flock(lock, LOCK_EX | LOCK_NB) != 0) return 134;
    for (const char* name : {"iceoryx_mgmt", "some_group"}) {
      const std::string file = directory + "/" + name;
      unlink(file.c_str());
      std::ofstream(file) << "memory";
    }
    std::ofstream(directory + "/roudi.lock") << "";
    notify("READY=1\nX_SEGMENTS=iceoryx_mgmt some_group");
  } else {
    std::ofstream(directory + "/" + argv[4]) << "socket";
    if (option != "hang_later" || first_time(directory, argv[4])) notify("READY=1");
  }
  const bool strokes = option != "mute_once" || !first_time(directory, kind);
  for (int turn = 0; stopped == 0; ++turn) {
    constexpr int kTurnsPerStroke = 10;
    if (strokes && turn % kTurnsPerStroke == 0) notify("WATCHDOG=1");
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return 0;
}
