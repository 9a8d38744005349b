// A domain of fake processes in a temporary folder, for the supervisor's tests.
#pragma once

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "deploy/supervisor/supervisor.hpp"

namespace boresight::supervisor {

using std::filesystem::path;

inline std::int64_t milliseconds_now() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// A domain of fake processes in a temporary folder.
class SupervisorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = ::testing::TempDir() + "supervisor-XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
    std::filesystem::create_directories(bus());
    std::filesystem::create_directories(directory_ / "config");
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  [[nodiscard]] path bus() const { return directory_ / "bus"; }

  [[nodiscard]] ProcessSpec service(const std::string& name, const std::string& option = "-") const {
    return {.name = name,
            .command = {.arguments = {FAKE_PROCESS, "service", bus().string(), option, "socket-" + name},
                        .environment = {}},
            .runtime_name = "socket-" + name};
  }
  [[nodiscard]] DomainConfig domain(std::vector<ProcessSpec> services, const std::string& roudi_option = "-") const {
    DomainConfig config;
    config.roudi = {.arguments = {FAKE_PROCESS, "roudi", bus().string(), roudi_option}, .environment = {}};
    config.services = std::move(services);
    config.run_directory = directory_ / "run";
    config.log_directory = directory_ / "logs";
    config.config_directory = directory_ / "config";
    config.places = {.shared_memory = bus(), .sockets = bus()};
    config.stop_timeout_ns = 300'000'000;
    return config;
  }

  /// Polls until `condition` holds; false after five seconds.
  static bool poll_until(Supervisor& supervisor, const std::function<bool()>& condition) {
    const std::int64_t deadline_ms = milliseconds_now() + 5000;
    while (!condition()) {
      if (milliseconds_now() > deadline_ms) return false;
      supervisor.poll(5'000'000);
    }
    return true;
  }
  static bool become_ready(Supervisor& supervisor) {
    return poll_until(supervisor, [&] { return supervisor.all_ready(); });
  }
  static std::size_t count(const Supervisor& supervisor, EventKind kind, const std::string& process) {
    return static_cast<std::size_t>(
        std::count_if(supervisor.events().begin(), supervisor.events().end(),
                      [&](const Event& e) { return e.kind == kind && e.process == process; }));
  }
  /// The detail of the first event of the kind; empty without one.
  static std::string first_detail(const Supervisor& supervisor, EventKind kind) {
    const auto found = std::find_if(supervisor.events().begin(), supervisor.events().end(),
                                    [&](const Event& e) { return e.kind == kind; });
    return found == supervisor.events().end() ? "" : found->detail;
  }
  [[nodiscard]] std::vector<std::string> files_on_bus() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(bus())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  static bool is_gone(pid_t pid) { return kill(pid, 0) != 0 && errno == ESRCH; }

  path directory_;
};

}  // namespace boresight::supervisor
