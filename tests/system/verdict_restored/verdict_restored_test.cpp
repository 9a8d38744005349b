// A misaligned radar stays misaligned over every restart: of the health service, of the whole domain, of the ECU. Its
// trouble code can be read by DDS and cleared only by those who know the secret.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <future>
#include <iterator>
#include <memory>
#include <mutex>
#include <vector>

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "services/health/dds/diagnostics_reader.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;
using catalogue::TopicId;
using harness::Observer;
using testing::HasSubstr;

constexpr std::uint32_t kMisaligned = 2;  // front_right, which the drive turns by 2.5°
constexpr auto kReason = static_cast<std::uint32_t>(ExtendedQualifier::kMisaligned);
constexpr auto kReduced = static_cast<std::uint32_t>(DataQualifier::kAvailableReduced);
const fs::path kState = "/tmp/state";
const fs::path kConfig = "/tmp/config";
const fs::path kKey = "/tmp/command.key";

std::string text_of(const fs::path& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
}

/// What a diagnosis tool got by DDS about the misaligned radar.
class Subscriber {
 public:
  explicit Subscriber(const dds::Config& config)
      : reader_(config, {.on_sensor_health = [this](const diagnostics::SensorHealth& sample) { take(sample); },
                         .on_system_health = {},
                         .on_diagnostic_array = {},
                         .on_presence = {}}) {}
  /// Samples that do not report the misalignment.
  [[nodiscard]] std::size_t other() {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::count_if(samples_.begin(), samples_.end(), [](const auto& sample) {
      return sample.extended_qualifier() != diagnostics::MISALIGNED;
    }));
  }
  [[nodiscard]] std::size_t size() {
    const std::lock_guard lock(mutex_);
    return samples_.size();
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    samples_.clear();
  }

 private:
  void take(const diagnostics::SensorHealth& sample) {
    const std::lock_guard lock(mutex_);
    if (sample.radar_id() == kMisaligned) samples_.push_back(sample);
  }
  std::mutex mutex_;
  std::vector<diagnostics::SensorHealth> samples_;
  dds::DiagnosticsReader reader_;
};

class VerdictRestored : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(kState);
    fs::copy(harness::shipped_configuration(), kConfig,
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    std::ofstream(kKey) << std::string(64, 'k');
    ASSERT_EQ(chmod(kKey.c_str(), 0600), 0);
    const fs::path file = kConfig / "services" / "health.toml";
    std::string text = text_of(file);
    const std::string shipped = "command_key_file = \"\"";
    const std::size_t at = text.find(shipped);
    ASSERT_NE(at, std::string::npos);
    std::ofstream(file) << text.replace(at, shipped.size(), "command_key_file = \"" + kKey.string() + "\"");
    // As under systemd; a DDS domain of this test.
    ASSERT_EQ(setenv("STATE_DIRECTORY", kState.c_str(), 1), 0);
    ASSERT_EQ(setenv("BORESIGHT_DDS_DOMAIN", "78", 1), 0);
    recordings_ = harness::simulated_drive(40.0);
  }

  void start() {
    domain_ = std::make_unique<harness::Domain>("demo", std::vector<std::string>{}, kConfig);
    observer_ = std::make_unique<Observer>("-story" + std::to_string(++observers_));
    domain_->start();
    domain_->replay(recordings_);
  }
  /// Reports from `from` on that do not say that the radar is misaligned.
  [[nodiscard]] std::size_t others(std::size_t from) const {
    const auto reports = observer_->of(TopicId::kHealthReport, from);
    return static_cast<std::size_t>(std::count_if(reports.begin(), reports.end(), [](const harness::Sample* s) {
      return s->sensor_reason[kMisaligned] != kReason;
    }));
  }
  [[nodiscard]] bool is_misaligned() const {
    const auto reports = observer_->of(TopicId::kHealthReport);
    return !reports.empty() && reports.back()->sensor_reason[kMisaligned] == kReason &&
           reports.back()->sensor[kMisaligned] == kReduced;
  }
  /// Output of `boresight dtc ARGUMENTS`, with its exit code in the first line. The domain is served meanwhile.
  [[nodiscard]] std::string dtc(const std::string& arguments) {
    const std::string command =
        BORESIGHT_BINARY_DIR "/boresight dtc " + arguments + " --config " + kConfig.string() + " > /tmp/dtc.txt 2>&1";
    auto running = std::async(std::launch::async, [command] { return std::system(command.c_str()); });
    const auto has_ended = [&running] {
      return running.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    if (domain_) {
      EXPECT_TRUE(domain_->until(30.0, has_ended)) << arguments;
    }
    const int status = running.get();
    return std::to_string(WIFEXITED(status) ? WEXITSTATUS(status) : -1) + "\n" + text_of("/tmp/dtc.txt");
  }

  std::vector<fs::path> recordings_;
  std::unique_ptr<harness::Domain> domain_;
  std::unique_ptr<Observer> observer_;
  int observers_ = 0;
  const dds::Config dds_{.domain = 78, .command_key_file = {}};
};

TEST_F(VerdictRestored, OverAKillOfHealthAndOfRouDiAndANewStart) {
  start();
  ASSERT_TRUE(domain_->until(20.0, [&] { return is_misaligned(); })) << "the drive does not misalign the radar";
  Subscriber subscriber(dds_);
  ASSERT_TRUE(domain_->until(5.0, [&] { return subscriber.size() > 0; }));

  // The trouble code is published on DDS. A command that is signed with another secret does not clear it.
  EXPECT_THAT(dtc("list"), HasSubstr("C1D02-78  radar front_right"));
  EXPECT_THAT(dtc("show C1D02-78"), HasSubstr("lateral displacement"));
  std::ofstream("/tmp/other.key") << std::string(64, 'x');
  ASSERT_EQ(chmod("/tmp/other.key", 0600), 0);
  EXPECT_THAT(dtc("clear C1D02-78 --key /tmp/other.key"), HasSubstr("refused: not authorised"));
  EXPECT_TRUE(is_misaligned());

  for (int i = 0; i < 3; ++i) {
    const std::size_t before = observer_->size();
    subscriber.clear();
    ASSERT_EQ(kill(domain_->supervisor().pid_of("health"), SIGKILL), 0);
    ASSERT_TRUE(domain_->until(5.0, [&] {
      const auto reports = observer_->of(TopicId::kHealthReport, before);
      return !reports.empty() && reports.back()->header.sequence < 10;
    })) << "no report of the new process";
    domain_->run_for(1.0);
    EXPECT_EQ(others(before), 0u) << "a report after the restart of health";
    EXPECT_EQ(subscriber.other(), 0u) << "a sample on DDS";
  }

  subscriber.clear();
  ASSERT_EQ(kill(domain_->supervisor().roudi_pid(), SIGKILL), 0);
  ASSERT_TRUE(domain_->until(10.0, [&] { return domain_->supervisor().domain_restarts() == 1; }));
  observer_ = std::make_unique<Observer>("-after");
  ASSERT_TRUE(domain_->until(10.0, [&] { return !observer_->of(TopicId::kHealthReport).empty(); }));
  domain_->run_for(1.0);
  EXPECT_EQ(others(0), 0u) << "a report after the restart of the domain";
  EXPECT_EQ(subscriber.other(), 0u) << "a sample on DDS";

  observer_.reset();
  domain_.reset();
  subscriber.clear();
  start();
  ASSERT_TRUE(domain_->until(10.0, [&] { return !observer_->of(TopicId::kHealthReport).empty(); }));
  domain_->run_for(1.0);
  EXPECT_EQ(others(0), 0u) << "a report after a new start";
  EXPECT_EQ(subscriber.other(), 0u) << "a sample on DDS";

  // Cleared, the radar is not available before it was tested, and then misaligned again.
  const std::size_t before = observer_->size();
  EXPECT_THAT(dtc("clear C1D02-78"), HasSubstr("0\nC1D02-78 cleared"));
  EXPECT_TRUE(domain_->until(15.0, [&] { return others(before) > 0 && is_misaligned(); }));
  for (const harness::Sample* report : observer_->of(TopicId::kHealthReport, before)) {
    EXPECT_NE(report->sensor[kMisaligned], static_cast<std::uint32_t>(DataQualifier::kAvailable));
  }
  domain_.reset();
  EXPECT_THAT(dtc("list --vehicle demo --state " + (kState / "fault_memory").string()), HasSubstr("C1D02-78"));
  EXPECT_THAT(dtc("list --seconds 1"), HasSubstr("1\n"));
}

}  // namespace
}  // namespace boresight
