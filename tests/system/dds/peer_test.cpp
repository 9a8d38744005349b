// Another implementation of DDS reads the topics, and learns of the silence of the service.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "services/health/dds/diagnostics_writer.hpp"
#include "tests/system/dds/samples.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::dds {
namespace {

volatile std::sig_atomic_t end_is_wanted = 0;

/// Sends the report in each period until SIGTERM, then ends in order.
std::unique_ptr<harness::Child> start_writer(const HealthReport& sent) {
  return std::make_unique<harness::Child>([&sent] {
    std::signal(SIGTERM, [](int) { end_is_wanted = 1; });
    Participant participant(kConfig, "test");
    DiagnosticsWriter writer(participant, vehicle());
    for (int tenth = 0; end_is_wanted == 0; ++tenth) {
      if (tenth % 10 == 0) writer.write(sent, kTime_ns);
      harness::sleep_s(0.1);
    }
    writer.end(kTime_ns, kConfig.farewell_s);
    return 0;
  });
}

class AnotherImplementation : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(BORESIGHT_PEER)) GTEST_SKIP() << "skipped: Cyclone DDS is not installed";
    setenv("CYCLONEDDS_URI", kOnLoopback, 1);
  }
  void start_peer(const std::string& arguments) {
    pipe_ = popen((BORESIGHT_PEER " 77 20 " + arguments).c_str(), "r");
    ASSERT_NE(pipe_, nullptr);
  }
  /// Reads its output up to that line, or to its end.
  void read_until(const std::string& line = {}) {
    std::array<char, 512> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe_) != nullptr) {
      output_ += buffer.data();
      if (!line.empty() && buffer.data() == line + "\n") return;
    }
  }
  [[nodiscard]] int end_peer() {
    read_until();
    return pclose(pipe_);
  }
  [[nodiscard]] bool has(const std::string& text) const { return output_.find(text) != std::string::npos; }
  /// The writer gets `signal`; the peer must know its silence within two seconds.
  void expect_silence_is_learnt_after(int signal) {
    const auto writer = start_writer(report());
    start_peer("watch");
    read_until("complete");
    writer->send(signal);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(end_peer(), 0) << output_;
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(taken.count(), 2.1) << "two seconds, and the end of the process";
  }

  // The loopback is not flagged as able to multicast.
  static constexpr const char* kOnLoopback =
      "<General><Interfaces><NetworkInterface name='lo'/></Interfaces></General>";
  std::string output_;

 private:
  FILE* pipe_ = nullptr;
};

TEST_F(AnotherImplementation, ReadsTheTopicsWithAndWithoutRequests) {
  HealthReport sent = report();
  sent.services[3].condition = ServiceCondition::kDegraded;
  sent.sensors[0].data_qualifier = DataQualifier::kNotAvailable;
  sent.sensors[0].extended_qualifier = ExtendedQualifier::kBlocked;
  const auto writer = start_writer(sent);
  for (const char* const mode : {"", "plain"}) {
    output_.clear();
    start_peer(mode);
    EXPECT_EQ(end_peer(), 0) << output_;
    for (const char* const line : {
             "status 0 boresight/service/health: alive",
             "status 1 boresight/service/ghost_filter: degraded",
             "status 1 boresight/radar/front_right: AVAILABLE_REDUCED MISALIGNED",
             "status 2 boresight/radar/front_left: NOT_AVAILABLE BLOCKED",
             "status 3 boresight/service/tracker: silent",
             "system test car 1 pipeline 1 U1B00-82 U1B00-33 lost 12",
             "sensor 2 front_right 1 1 yaw 0.0436 suspect 34 conditions 72",
         }) {
      EXPECT_TRUE(has(line)) << line << " is missing in\n" << output_;
    }
  }
}

TEST_F(AnotherImplementation, LearnsThatAKilledServiceIsSilent) {
  expect_silence_is_learnt_after(SIGKILL);
}

TEST_F(AnotherImplementation, LearnsThatAStoppedServiceIsSilent) {
  expect_silence_is_learnt_after(SIGSTOP);
}

TEST_F(AnotherImplementation, LearnsOfTheOrderlyEnd) {
  const auto writer = start_writer(report());
  start_peer("watch");
  read_until("complete");
  EXPECT_EQ(writer->stop(), 0);
  EXPECT_EQ(end_peer(), 0) << output_;
  EXPECT_TRUE(has("disposed")) << output_;
  EXPECT_TRUE(has("status 3 boresight/radar/front_left: the health service ended")) << output_;
}

TEST_F(AnotherImplementation, OnAllInterfacesFindsTheServiceOnTheLoopback) {
  unsetenv("CYCLONEDDS_URI");
  const auto writer = start_writer(report());
  start_peer("plain");
  EXPECT_EQ(end_peer(), 0) << output_;
}

}  // namespace
}  // namespace boresight::dds
