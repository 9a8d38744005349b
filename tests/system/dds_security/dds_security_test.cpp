// In a secured domain only those read and publish who have a certificate and the right. `SECURITY=off` runs the same
// without security; then every case fails.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <sys/wait.h>

#include "services/health/dds/diagnostics_reader.hpp"
#include "services/health/dds/diagnostics_writer.hpp"
#include "tests/system/dds_security/forger.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;
using catalogue::TopicId;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 79;
constexpr std::size_t kRadars = 4;  // of the vehicle "demo"
// Discovery and handshake take 0.2 s, and up to 4 s if a datagram is lost.
constexpr double kDiscovery_s = 20.0;
constexpr double kTimeOfForgery_s = 6.0;
const fs::path kConfig = "/tmp/config", kState = "/tmp/state";
const fs::path kCredentials = "/tmp/credentials", kOfOthers = "/tmp/credentials_of_others";
const std::string kTool = BORESIGHT_SOURCE_DIR "/deploy/dds_security";

bool is_secured() {
  const char* const security = std::getenv("SECURITY");
  return security == nullptr || std::string(security) != "off";
}

int exit_code_of(const std::string& command) {
  const int status = std::system((command + " > /tmp/output.txt 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string text_of(const fs::path& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
}

dds::Config config_of(const fs::path& credentials) {
  dds::Config config;
  config.domain = kDomain;
  if (is_secured() && !credentials.empty()) config.security = dds::secured_by(credentials);
  return config;
}

/// What a diagnosis tool gets.
class Subscriber {
 public:
  explicit Subscriber(const fs::path& credentials) : reader_(config_of(credentials), callbacks()) {}
  [[nodiscard]] std::size_t radars() {
    const std::lock_guard lock(mutex_);
    return radars_.size();
  }
  [[nodiscard]] int genuine() const { return genuine_; }
  [[nodiscard]] int forged() const { return forged_; }

 private:
  dds::DiagnosticsCallbacks callbacks() {
    dds::DiagnosticsCallbacks calls;
    calls.on_sensor_health = [this](const diagnostics::SensorHealth& sample) { take(sample); };
    return calls;
  }
  void take(const diagnostics::SensorHealth& sample) {
    const std::lock_guard lock(mutex_);
    ++(sample.time_ns() == kForgedTime_ns ? forged_ : genuine_);
    if (sample.time_ns() != kForgedTime_ns) radars_.insert(sample.radar_id());
  }
  std::mutex mutex_;
  std::set<std::uint32_t> radars_;
  std::atomic<int> genuine_ = 0, forged_ = 0;
  dds::DiagnosticsReader reader_;
};

class DdsSecurity : public testing::Test {
 protected:
  /// The credentials are made once: OpenSSL is started some sixty times.
  static void SetUpTestSuite() {
    ASSERT_EQ(exit_code_of(kTool + " /tmp/made --vehicle demo"), 0) << text_of("/tmp/output.txt");
    ASSERT_EQ(exit_code_of(kTool + " " + kOfOthers.string() + " --vehicle demo"), 0) << text_of("/tmp/output.txt");
    // Before this process has threads of the middleware, whose locks a fork would copy.
    without_certificate_ = std::make_unique<Forger>(kDomain, "");
    of_another_authority_ = std::make_unique<Forger>(kDomain, kOfOthers / "health");
  }
  static void TearDownTestSuite() {
    without_certificate_.reset();
    of_another_authority_.reset();
  }

  void SetUp() override {
    for (const fs::path& folder : {kConfig, kState, kCredentials}) fs::remove_all(folder);
    fs::create_directories(kState);
    fs::copy(harness::shipped_configuration(), kConfig, fs::copy_options::recursive);
    fs::copy("/tmp/made", kCredentials, fs::copy_options::recursive);
    if (is_secured()) {
      replace("enabled = false            # true: if", "enabled = true  # if");
      replace("directory = \"\"             # absolute", "directory = \"/tmp/credentials/health\"  # absolute");
    }
    std::ofstream("/tmp/command.key") << std::string(64, 'k');
    fs::permissions("/tmp/command.key", fs::perms::owner_read | fs::perms::owner_write);
    replace("command_key_file = \"\"", "command_key_file = \"/tmp/command.key\"");
    ASSERT_EQ(setenv("STATE_DIRECTORY", kState.c_str(), 1), 0);
    ASSERT_EQ(setenv("BORESIGHT_DDS_DOMAIN", std::to_string(kDomain).c_str(), 1), 0);
  }

  static void replace(const std::string& old, const std::string& by) {
    const fs::path file = kConfig / "services" / "health.toml";
    std::string text = text_of(file);
    const std::size_t at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    std::ofstream(file) << text.replace(at, old.size(), by);
  }

  void start() {
    domain_ = std::make_unique<harness::Domain>("demo", std::vector<std::string>{}, kConfig);
    domain_->start();
  }
  /// Output of `boresight ARGUMENTS`, with its exit code in the first line. The domain is served meanwhile.
  [[nodiscard]] std::string boresight(const std::string& arguments) {
    auto running = std::async(std::launch::async,
                              [&arguments] { return exit_code_of(BORESIGHT_BINARY_DIR "/boresight " + arguments); });
    EXPECT_TRUE(domain_->until(40.0, [&] {
      return running.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    })) << arguments;
    return std::to_string(running.get()) + "\n" + text_of("/tmp/output.txt");
  }

  /// `peer`: credentials of a reader that accepts the forger, which shows that it works.
  void expect_that_nobody_believes(Forger& forger, const fs::path& peer) {
    start();
    Subscriber reader(kCredentials / "diagnosis");
    ASSERT_TRUE(domain_->until(kDiscovery_s, [&] { return reader.radars() == kRadars; })) << "the reader got nothing";
    Subscriber accomplice(peer);
    forger.begin();
    EXPECT_TRUE(domain_->until(kDiscovery_s, [&] { return accomplice.forged() > 0; })) << "the forger does not work";
    const int genuine = reader.genuine();
    domain_->run_for(kTimeOfForgery_s);
    EXPECT_EQ(reader.forged(), 0) << "samples of the forger at the reader";
    EXPECT_GT(reader.genuine(), genuine) << "the reader must go on to read";
    EXPECT_EQ(forger.read(), 0) << "samples of the health service at the forger";
    EXPECT_EQ(accomplice.genuine(), 0) << "samples of the health service at another stranger";
  }

  static inline std::unique_ptr<Forger> without_certificate_, of_another_authority_;
  std::unique_ptr<harness::Domain> domain_;
};

TEST_F(DdsSecurity, ReadersWithPermissionsGetTheVerdicts) {
  const auto recordings = harness::simulated_drive(20.0);
  start();
  domain_->replay(recordings);
  Subscriber reader(kCredentials / "diagnosis");
  EXPECT_TRUE(domain_->until(kDiscovery_s, [&] { return reader.radars() == kRadars; }));
  const std::string diagnosis = " --security " + (kCredentials / "diagnosis").string();
  const std::string dtc = " --config " + kConfig.string() + " --seconds 20";
  EXPECT_THAT(boresight("diagnostics --all --count 8 --seconds 20" + diagnosis), HasSubstr("front_right"));
  EXPECT_THAT(boresight("dtc list" + dtc + diagnosis), HasSubstr("0\ndemo: operation cycle 1")) << "by an option";
  EXPECT_THAT(boresight("dtc list" + dtc), HasSubstr("0\ndemo: operation cycle 1")) << "by the configuration";
  EXPECT_THAT(boresight("diagnostics --seconds 4"), HasSubstr("1\n")) << "without certificate";
  EXPECT_THAT(boresight("dtc clear" + dtc + diagnosis), HasSubstr("cannot create a writer")) << "without the right";
  EXPECT_THAT(boresight("dtc clear" + dtc + " --security " + (kCredentials / "commander").string()),
              HasSubstr("0\nall codes cleared"));
}

TEST_F(DdsSecurity, AStrangerWithoutCertificateIsNotBelievedAndReadsNothing) {
  expect_that_nobody_believes(*without_certificate_, {});
  without_certificate_.reset();
}

TEST_F(DdsSecurity, AStrangerOfAnotherAuthorityIsNotBelievedAndReadsNothing) {
  expect_that_nobody_believes(*of_another_authority_, kOfOthers / "diagnosis");
  of_another_authority_.reset();
}

TEST_F(DdsSecurity, AReaderCannotPublish) {
  dds::Participant participant(config_of(kCredentials / "diagnosis"), "reader");
  EXPECT_THROW(dds::DiagnosticsWriter(participant, VehicleConfig{}), std::runtime_error);
}

TEST_F(DdsSecurity, AnExpiredCertificateMakesHealthMuteAndARenewedOneEndsThat) {
  const std::string renewal = kTool + " " + kCredentials.string() + " --vehicle demo --renew";
  ASSERT_EQ(exit_code_of(renewal + " --days 0"), 1) << "certificates that have expired";
  harness::Observer observer("-mute");
  start();
  Subscriber stranger{fs::path()};
  domain_->run_for(8.0);
  EXPECT_EQ(stranger.genuine(), 0) << "an open participant";
  EXPECT_FALSE(observer.of(TopicId::kHealthReport).empty()) << "supervision must go on";
  const std::string list = "dtc list --vehicle demo --state " + (kState / "fault_memory").string();
  EXPECT_THAT(boresight(list), HasSubstr("U1C00-88"));
  ASSERT_EQ(exit_code_of(renewal), 0);
  Subscriber reader(kCredentials / "diagnosis");
  EXPECT_TRUE(domain_->until(kDiscovery_s, [&] { return reader.radars() == kRadars; })) << "after the renewal";
  // The file is written after the sample was sent.
  const auto has_passed = [&] { return boresight(list).find("passed, confirmed") != std::string::npos; };
  EXPECT_TRUE(domain_->until(kDiscovery_s, has_passed)) << text_of("/tmp/output.txt");
}

TEST_F(DdsSecurity, MissingFilesMakeHealthMute) {
  fs::remove(kCredentials / "health" / "governance.p7s");
  start();
  Subscriber stranger{fs::path()};
  domain_->run_for(4.0);
  EXPECT_EQ(stranger.genuine(), 0) << "an open participant";
  EXPECT_THAT(boresight("dtc list --vehicle demo --state " + (kState / "fault_memory").string()),
              HasSubstr("U1C00-88"));
}

}  // namespace
}  // namespace boresight
