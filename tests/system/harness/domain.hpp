// The whole product under its supervisor, for a test.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "deploy/supervisor/supervisor.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::harness {

[[nodiscard]] std::filesystem::path shipped_configuration();

/// RouDi and every service, listening to boresight-replay. Logs and sockets lie under /tmp/domain.
class Domain {
 public:
  /// Services in `without` are not started, those in `more` in addition. `config`: the folder of the configuration.
  explicit Domain(const std::string& vehicle, const std::vector<std::string>& without = {},
                  const std::filesystem::path& config = shipped_configuration(),
                  const std::vector<supervisor::ProcessSpec>& more = {});

  /// Starts it and waits until every service is ready; throws if that takes longer than 20 s.
  void start();
  /// Plays recordings once; the result is read with replay_result().
  void replay(const std::vector<std::filesystem::path>& recordings, std::vector<std::string> options = {});
  /// Serves the supervisor until `condition` holds; false if it did not in time.
  bool until(double seconds, const std::function<bool()>& condition);
  void run_for(double seconds);
  /// True once the replay has ended; then its exit code is 0 or the test fails.
  [[nodiscard]] bool replay_has_ended();

  [[nodiscard]] supervisor::Supervisor& supervisor() { return supervisor_; }

 private:
  supervisor::Supervisor supervisor_;
};

/// Starts a service of the demo vehicle outside of any supervision, with the shipped configuration or another; it
/// writes to log_of_alone(), which is emptied before.
[[nodiscard]] std::unique_ptr<Child> start_alone(const std::string& service,
                                                 const std::filesystem::path& config = shipped_configuration());
[[nodiscard]] std::filesystem::path log_of_alone(const std::string& service);

/// Simulates a drive of the demo vehicle into /tmp/drive; returns its recordings, the ego signals last. `profile`: of
/// all radars; empty: that of the scenario.
[[nodiscard]] std::vector<std::filesystem::path> simulated_drive(double duration_s,
                                                                 const std::string& scenario = "demo_drive",
                                                                 const std::string& profile = {});

}  // namespace boresight::harness
