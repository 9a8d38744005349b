// The health service alone on the ECU, and a diagnosis tool on the ECU or off it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "services/health/dds/diagnostics_reader.hpp"
#include "services/health/dds/fault_memory_client.hpp"
#include "tests/system/harness/child.hpp"
#include "tests/system/harness/roudi.hpp"
#include "tests/system/harness/two_hosts.hpp"

namespace boresight::dds {

/// What a tool with the default request learns of the health of the demo vehicle: four radars and the system.
class Tool {
 public:
  explicit Tool(const Config& config);

  static constexpr std::size_t kSources = 5;
  /// Sources from which a sample came.
  [[nodiscard]] std::size_t sources();
  /// Sources whose latest known state is that.
  [[nodiscard]] std::size_t in_state(Absence absence);
  [[nodiscard]] std::size_t absent();
  /// Levels of the statuses of the last array.
  [[nodiscard]] std::vector<int> levels();
  [[nodiscard]] std::size_t arrays();

 private:
  std::mutex mutex_;
  std::map<std::string, Absence> states_;  ///< by source
  std::vector<int> levels_;
  std::size_t arrays_ = 0;
  DiagnosticsReader reader_;  // last member: its destructor stops the callbacks
};

class SilenceTest : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  /// Starts health with these interfaces and the domain of this test.
  void start_health(const std::string& interfaces);
  [[nodiscard]] static network::TwoHosts& hosts() { return *hosts_; }
  [[nodiscard]] static Config config(const std::vector<std::string>& interfaces);
  /// True once the trouble code of mute diagnostics is known to that client and failed or not.
  [[nodiscard]] static bool mute_becomes(bool is_failed, FaultMemoryClient& client, double seconds);

  std::unique_ptr<harness::Child> health_;

 private:
  static std::unique_ptr<network::TwoHosts> hosts_;
  static std::unique_ptr<harness::Roudi> roudi_;
};

}  // namespace boresight::dds
