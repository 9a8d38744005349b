// A health service that is killed, stopped, ended or unplugged: a tool knows it within two seconds, and when it is
// back.
#include <algorithm>
#include <array>
#include <csignal>

#include "tests/system/dds_silence/bench.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight::dds {
namespace {

constexpr double kKnownWithin_s = 2.0;
const std::string kLoopback = R"(["127.0.0.1"])";

class DdsSilence : public SilenceTest {
 protected:
  /// On the same machine, with the default interfaces.
  void start_on_loopback() {
    start_health(kLoopback);
    tool_ = std::make_unique<Tool>(config({"127.0.0.1"}));
    ASSERT_TRUE(all_present());
  }
  [[nodiscard]] bool all_present() {
    return harness::eventually(
        15.0, [&] { return tool_->sources() == Tool::kSources && tool_->in_state(Absence::kNone) == Tool::kSources; });
  }
  [[nodiscard]] bool all_absent() {
    return harness::eventually(kKnownWithin_s, [&] { return tool_->absent() == Tool::kSources; });
  }
  std::unique_ptr<Tool> tool_;
};

TEST_F(DdsSilence, PeriodicSamplesAreNeverStale) {
  start_on_loopback();
  harness::sleep_s(6.0);
  EXPECT_EQ(tool_->in_state(Absence::kNone), Tool::kSources);
}

TEST_F(DdsSilence, AKilledServiceIsStaleWithinTwoSecondsAndBackAfterItsStart) {
  start_on_loopback();
  health_->send(SIGKILL);
  EXPECT_TRUE(all_absent());
  EXPECT_EQ(tool_->in_state(Absence::kEnded), 0u) << "it did not end in order";
  health_.reset();
  start_health(kLoopback);
  EXPECT_TRUE(all_present());
}

TEST_F(DdsSilence, AStoppedServiceIsStaleWithinTwoSecondsAndBackWhenItContinues) {
  start_on_loopback();
  health_->send(SIGSTOP);
  EXPECT_TRUE(all_absent());
  EXPECT_EQ(tool_->in_state(Absence::kEnded), 0u) << "it did not end in order";
  health_->send(SIGCONT);
  EXPECT_TRUE(all_present());
}

TEST_F(DdsSilence, AnOrderlyEndDisposesTheInstancesAndLeavesRosDiagnosticsStale) {
  start_on_loopback();
  EXPECT_EQ(health_->stop(), 0);
  EXPECT_TRUE(harness::eventually(0.5, [&] { return tool_->in_state(Absence::kEnded) == Tool::kSources; }))
      << tool_->in_state(Absence::kEnded) << " ended, " << tool_->in_state(Absence::kNoWriter) << " without writer";
  const std::vector<int> levels = tool_->levels();
  constexpr int kStale = 3;
  EXPECT_FALSE(levels.empty());
  EXPECT_TRUE(std::ranges::all_of(levels, [](int level) { return level == kStale; }));
}

TEST_F(DdsSilence, AnUnpluggedEcuIsStaleWithinTwoSecondsAndBackWithItsCable) {
  start_health(R"(["127.0.0.1", "radar0"])");
  hosts().as(network::Host::kSensors, [&] { tool_ = std::make_unique<Tool>(config({network::kServerInterface})); });
  ASSERT_TRUE(all_present()) << "an interface is given by its name";
  FaultMemoryClient on_ecu(config({"127.0.0.1", network::kEcuInterface}), FaultMemoryClient::Use::kRead);
  EXPECT_TRUE(mute_becomes(false, on_ecu, 10.0));
  hosts().cut_cable();
  EXPECT_TRUE(all_absent());
  EXPECT_TRUE(mute_becomes(true, on_ecu, 3.0)) << "diagnostics_mute";
  hosts().lay_cable();
  EXPECT_TRUE(mute_becomes(false, on_ecu, 10.0));
  EXPECT_TRUE(all_present());
  hosts().as(network::Host::kSensors, [&] { tool_.reset(); });
}

TEST_F(DdsSilence, ByDefaultOtherMachinesReceiveNothing) {
  start_on_loopback();
  hosts().as(network::Host::kSensors, [&] {
    Tool stranger(config({"all"}));
    harness::sleep_s(3.0);
    EXPECT_EQ(stranger.sources(), 0u);
  });
}

TEST_F(DdsSilence, AnInterfaceThatDoesNotExistIsAFindingAndTheOthersWork) {
  start_health(R"(["127.0.0.1", "nosuch0"])");
  FaultMemoryClient client(config({"127.0.0.1"}), FaultMemoryClient::Use::kRead);
  EXPECT_TRUE(mute_becomes(true, client, 10.0));
}

TEST_F(DdsSilence, AServiceThatIsMuteAtItsStartIsHeardWhenTheInterfaceAppears) {
  hosts().cut_cable();
  start_health(R"(["radar0"])");
  harness::sleep_s(2.0);
  hosts().lay_cable();
  hosts().as(network::Host::kSensors, [&] { tool_ = std::make_unique<Tool>(config({network::kServerAddress})); });
  EXPECT_TRUE(all_present());
  hosts().as(network::Host::kSensors, [&] { tool_.reset(); });
}

TEST_F(DdsSilence, AToolWithoutAUsableInterfaceSaysWhy) {
  try {
    const Tool tool(config({"nosuch0"}));
    ADD_FAILURE() << "joined the domain without an interface";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "DDS: nosuch0: this machine has no such interface");
  }
}

}  // namespace
}  // namespace boresight::dds
