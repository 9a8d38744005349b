// What the radars are used to see outlives a kill of the health service. A file that cannot be used is refused, and
// reported as an event.
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/health/core/function/levels_codec.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const fs::path kState = "/tmp/state";
const fs::path kConfig = "/tmp/config";
const fs::path kLevels = kState / "levels";

std::string text_of(const fs::path& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
}

class LevelsRestored : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(kState);
    fs::copy(harness::shipped_configuration(), kConfig,
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    // As under systemd; a DDS domain of this test.
    ASSERT_EQ(setenv("STATE_DIRECTORY", kState.c_str(), 1), 0);
    ASSERT_EQ(setenv("BORESIGHT_DDS_DOMAIN", "79", 1), 0);
    vehicle_ = config::read_vehicle_file(kConfig / "vehicle" / "demo.toml");
  }

  /// Seconds of motion over which the stored level of radar 1 was learnt; 0 without a file that can be used.
  [[nodiscard]] double learnt_s() const {
    const std::string bytes = text_of(kLevels);
    health::VehicleLevels levels;
    std::size_t rejected = 0;
    const std::span read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const auto identity = health::levels_identity_of(vehicle_, {});
    if (health::decode_levels(read, identity, levels, rejected) != health::StoredLevels::kTaken) return 0.0;
    return levels.number_of_radars == 0 ? 0.0 : levels.radars[0].sight.log_count.learnt_s;
  }
  /// Trouble codes after a start of the domain with that file of levels.
  [[nodiscard]] std::string codes_after_start_with(const std::function<void()>& make_file) const {
    for (const char* name : {"levels", "levels.rejected", "fault_memory"}) fs::remove(kState / name);
    make_file();
    {
      harness::Domain domain("demo", {}, kConfig);
      domain.start();
      domain.run_for(1.0);
    }
    const std::string command = BORESIGHT_BINARY_DIR "/boresight dtc list --vehicle demo --config " + kConfig.string() +
                                " --state " + (kState / "fault_memory").string() + " > /tmp/dtc.txt 2>&1";
    static_cast<void>(std::system(command.c_str()));
    return text_of("/tmp/dtc.txt");
  }

  VehicleConfig vehicle_;
};

TEST_F(LevelsRestored, OverAKillOfHealth) {
  const std::vector<fs::path> recordings = harness::simulated_drive(40.0);
  {
    harness::Domain domain("demo", {}, kConfig);
    domain.start();
    domain.replay(recordings);
    ASSERT_TRUE(domain.until(30.0, [&] { return learnt_s() > 8.0; })) << learnt_s();
    ASSERT_EQ(kill(domain.supervisor().pid_of("health"), SIGKILL), 0);
    domain.run_for(4.0);
  }
  EXPECT_GT(learnt_s(), 10.0) << "the new process went on learning where the old one was killed";
  EXPECT_FALSE(fs::exists(kState / "levels.rejected"));
}

TEST_F(LevelsRestored, AFileThatCannotBeUsedIsRefusedAndReported) {
  EXPECT_THAT(codes_after_start_with([] {}), Not(HasSubstr("U1D00-46"))) << "a first start";
  EXPECT_THAT(codes_after_start_with([] { std::ofstream(kLevels) << "damaged"; }), HasSubstr("U1D00-46"));
  EXPECT_EQ(text_of(kState / "levels.rejected"), "damaged");
  EXPECT_THAT(codes_after_start_with([] { ASSERT_EQ(mkfifo(kLevels.c_str(), 0600), 0); }), HasSubstr("U1D00-46"))
      << "and it does not hang";
  const auto of_another_vehicle = [this] {
    VehicleConfig other = vehicle_;
    other.name = "another";
    std::vector<std::uint8_t> bytes(health::kMaxLevelsBytes);
    bytes.resize(health::encode_levels({}, health::levels_identity_of(other, {}), bytes));
    std::ofstream(kLevels, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  };
  EXPECT_THAT(codes_after_start_with(of_another_vehicle), HasSubstr("U1D00-46"));
  EXPECT_TRUE(fs::exists(kState / "levels.rejected"));
}

}  // namespace
}  // namespace boresight
