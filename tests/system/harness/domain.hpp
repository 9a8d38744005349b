// The whole product as its supervisor runs it, for a test.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "deploy/supervisor/supervisor.hpp"

namespace boresight::harness {

/// Whether the service's binary exists; a build of a part of the product runs a part of the chain.
[[nodiscard]] bool is_built(std::string_view service);

/// RouDi and every service that is built, listening to boresight-replay. Logs and sockets lie under /tmp/domain.
class Domain {
 public:
  explicit Domain(const std::string& vehicle);

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

/// Simulates the demo vehicle's drive into /tmp/drive; returns its recordings.
[[nodiscard]] std::vector<std::filesystem::path> simulated_drive(double duration_s);

}  // namespace boresight::harness
