// How services end: the exit code and the reason in the log.
#include "services/common/runtime/exit_codes.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <iceoryx_hoofs/error_handling/error_handling.hpp>
#include <unistd.h>

#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/service_main.hpp"
#include "tests/system/harness/roudi.hpp"

namespace boresight {
namespace {

constexpr const char* kLog = "/tmp/exit_codes.log";

/// Runs a tracker whose work is `run`; its output goes to kLog.
harness::Child tracker(const std::function<int(runtime::Node&)>& run) {
  return harness::Child([&run] {
    if (std::freopen(kLog, "w", stderr) == nullptr) return 99;
    std::string name = "boresight-tracker";
    char* arguments[] = {name.data(), nullptr};
    return runtime::service_main(catalogue::Service::kTracker, 1, arguments,
                                 [&](const runtime::Configuration&) -> runtime::Run { return run; });
  });
}

std::string logged() {
  std::ifstream file(kLog);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class ExitCode : public testing::Test {
 protected:
  harness::Roudi roudi_;
};

TEST_F(ExitCode, IsTwoForAConfigurationErrorThatIsFoundAfterTheStart) {
  auto service = tracker([](runtime::Node& node) -> int {
    node.every(10'000'000, [] { throw config::Error("tracker.toml:7: capacity: must be 1 … 4096"); });
    return node.spin();
  });
  EXPECT_EQ(service.wait_for(5.0), exit_code::kUsage);
  EXPECT_NE(logged().find("tracker.toml:7: capacity: must be 1 … 4096"), std::string::npos) << logged();
}

TEST_F(ExitCode, IsOneForAFailureAtRunTimeWithItsReason) {
  auto service = tracker([](runtime::Node&) -> int { throw std::runtime_error("the disk is \x1b[31mfull"); });
  EXPECT_EQ(service.wait_for(5.0), exit_code::kFinding);
  EXPECT_NE(logged().find("the disk is ?[31mfull"), std::string::npos) << logged();
}

TEST_F(ExitCode, IsSeventyForAnUnrecoverableErrorOfTheMiddlewareWithItsName) {
  auto service = tracker([](runtime::Node& node) -> int {
    iox::errorHandler(iox::Error::kPOPO__CONDITION_NOTIFIER_SEMAPHORE_CORRUPT_IN_NOTIFY, nullptr,
                      iox::ErrorLevel::SEVERE);
    return node.spin();
  });
  EXPECT_EQ(service.wait_for(5.0), exit_code::kMiddleware);
  EXPECT_NE(logged().find("CONDITION_NOTIFIER_SEMAPHORE_CORRUPT_IN_NOTIFY"), std::string::npos) << logged();
}

/// A service that waits for ever after the stop signal.
int hang(runtime::Node& node) {
  static_cast<void>(node.spin());
  for (;;) pause();
}

/// The exit code of such a service after SIGTERM, and nothing if it does not end within a second.
std::optional<int> end_of_hanging_service(const char* stop_limit_ms) {
  std::remove(kLog);  // of an earlier test
  if (stop_limit_ms != nullptr) setenv("BORESIGHT_STOP_LIMIT_MS", stop_limit_ms, 1);
  auto service = tracker(hang);
  unsetenv("BORESIGHT_STOP_LIMIT_MS");
  EXPECT_TRUE(harness::eventually(5.0, [] { return logged().find("started") != std::string::npos; })) << logged();
  service.send(SIGTERM);
  return service.wait_for(1.0);
}

TEST_F(ExitCode, IsThatOfSigkillIfAStoppedServiceDoesNotEndWithinItsLimit) {
  EXPECT_EQ(end_of_hanging_service("200"), -SIGKILL);
}

TEST_F(ExitCode, IsAwaitedWithoutALimitOfTheServiceManager) {
  EXPECT_EQ(end_of_hanging_service(nullptr), std::nullopt);
}

TEST_F(ExitCode, IsTwoForALimitThatIsNoNumber) {
  setenv("BORESIGHT_STOP_LIMIT_MS", "0.5", 1);
  auto service = tracker([](runtime::Node& node) { return node.spin(); });
  unsetenv("BORESIGHT_STOP_LIMIT_MS");
  EXPECT_EQ(service.wait_for(5.0), exit_code::kUsage);
  EXPECT_NE(logged().find("BORESIGHT_STOP_LIMIT_MS=0.5: must be a whole number"), std::string::npos) << logged();
}

}  // namespace
}  // namespace boresight
