// Ignition cycles of the running estimator: its memory survives SIGTERM and a kill. A file that is not its own memory
// is reported, kept aside and not used. Unit tests cover the content of files, system_memory_killed the death of a
// writer.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>

#include <gtest/gtest.h>
#include <signal.h>

#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/store/memory_file.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/common/runtime/node.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;
using alignment::LoadedMemory;
using alignment::Memory;
constexpr std::uint32_t kMisaligned = 2;              // front_right, which the drive turns by …
constexpr double kTrueYaw = 2.5 * kRadiansPerDegree;  // … this
const std::string kService = "alignment_estimator";
const fs::path kState = "/tmp/state";
const fs::path kConfig = "/tmp/config";

std::string text_of(const fs::path& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), std::istreambuf_iterator<char>()};
}

VehicleConfig vehicle() {
  return config::read_vehicle_file(harness::shipped_configuration() / "vehicle" / "demo.toml");
}

/// The shipped configuration, but the memory is written every second.
void write_configuration() {
  fs::copy(harness::shipped_configuration(), kConfig,
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  const fs::path file = kConfig / "services" / (kService + ".toml");
  std::string text = text_of(file);
  const std::string shipped = "period_s = 30.0";
  const std::size_t at = text.find(shipped);
  ASSERT_NE(at, std::string::npos);
  std::ofstream(file) << text.replace(at, shipped.size(), "period_s = 1.0");
}

/// All estimates of the misaligned radar, and the last status of the estimator.
class Witness {
 public:
  Witness() : process_([this] { return watch(); }) {}

  /// The number of estimates so far.
  [[nodiscard]] std::size_t size() const { return seen_->estimates; }
  [[nodiscard]] const AlignmentEstimate& last() const { return seen_->log[size() - 1]; }
  /// The first estimate of a process that was started after `from` estimates.
  [[nodiscard]] const AlignmentEstimate* first(std::size_t from) const {
    for (std::size_t i = from; i < size(); ++i) {
      if (seen_->log[i].header.source_sequence == 1) return &seen_->log[i];
    }
    return nullptr;
  }
  [[nodiscard]] const ServiceStatus& status() const { return seen_->status; }
  /// Rejected inputs as reported by the health service.
  [[nodiscard]] std::uint64_t rejected_inputs() const { return seen_->rejected_inputs; }

 private:
  struct Seen {
    volatile std::size_t estimates;
    std::array<AlignmentEstimate, 1000> log;
    ServiceStatus status;
    volatile std::uint64_t rejected_inputs;
  };
  int watch() {
    runtime::Node node(catalogue::Service::kMonitor, "-story");
    const auto estimator = static_cast<std::uint32_t>(catalogue::Service::kAlignmentEstimator);
    node.on<AlignmentEstimate>([this](const AlignmentEstimate& estimate) {
      if (estimate.header.source_id != kMisaligned || size() == seen_->log.size()) return;
      seen_->log[size()] = estimate;
      seen_->estimates = size() + 1;
    });
    node.on<ServiceStatus>([&](const ServiceStatus& status) {
      if (status.header.source_id == estimator) seen_->status = status;
    });
    node.on<HealthReport>([&](const HealthReport& report) {
      for (const ServiceHealth& service : report.services) {
        if (service.service == estimator) seen_->rejected_inputs = service.rejected_inputs;
      }
    });
    return node.spin();
  }

  harness::Shared<Seen> seen_;
  harness::Child process_;
};

double yaw_std(const AlignmentEstimate& estimate) {
  return std::sqrt(estimate.vehicle_covariance[5]);
}

class IgnitionCycles : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(kState);
    fs::create_directories(kState);
    ASSERT_NO_FATAL_FAILURE(write_configuration());
    const auto recordings = harness::simulated_drive(20.0);
    // As under systemd.
    ASSERT_EQ(setenv("STATE_DIRECTORY", kState.c_str(), 1), 0);
    witness_ = std::make_unique<Witness>();
    domain_.start();
    domain_.replay(recordings);
  }

  /// The first estimate of a new process.
  const AlignmentEstimate& ignition_on() {
    const std::size_t before = witness_->size();
    estimator_ = harness::start_alone(kService, kConfig);
    EXPECT_TRUE(domain_.until(5.0, [&] { return witness_->first(before) != nullptr; })) << log();
    return witness_->first(before) != nullptr ? *witness_->first(before) : witness_->last();
  }
  void ignition_off() {
    EXPECT_EQ(estimator_->stop(), 0) << log();
    EXPECT_FALSE(fs::exists(kState / "alignment.tmp"));
  }
  [[nodiscard]] static std::string log() { return text_of(harness::log_of_alone(kService)); }

  [[nodiscard]] LoadedMemory kept() const { return alignment::load_memory(file_, identity_of(vehicle_)); }
  /// Seconds of drive in the stored memory, for the whole vehicle; 0 without a memory.
  [[nodiscard]] double kept_drive_s() const {
    if (!fs::exists(file_)) return 0.0;
    const LoadedMemory loaded = kept();
    EXPECT_EQ(loaded.kind, LoadedMemory::Kind::kTaken) << loaded.reason;
    return loaded.memory.radars[kMisaligned - 1].seconds_of_drive;
  }

  /// Stores the memory as if the machine had been switched off and on since.
  void reboot(Memory memory) const {
    memory.boot = 0;
    alignment::MemoryBytes bytes;
    const std::size_t length = alignment::encode_memory(memory, identity_of(vehicle_), bytes);
    ASSERT_GT(length, 0u);
    std::ofstream(file_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(length));
  }

  /// The stored estimate; with a larger standard deviation if the machine was off.
  void expect_taken_up(const AlignmentEstimate& first, const Memory& memory, bool was_off) const {
    const alignment::windows::RestoreConfig config;
    const Memory::Radar& radar = memory.radars[kMisaligned - 1];
    // What a slow fluctuation of yaw may have done since counts as well.
    const double variance = radar.rotation_variance(2, 2);
    const double doubts =
        std::pow(config.rotation_std_rad, 2) + radar.fluctuation_variance[0] + memory.fluctuation_variance[0];
    const double doubted = std::sqrt(variance + (was_off ? doubts : 0.0));
    // The memory has a rotation vector, the message angles about fixed axes: with roll and pitch they differ by 2e-4.
    // The estimate is that without the excess of heights.
    const Eigen::Vector3d remembered(radar.rotation_vehicle_rad.data());
    EXPECT_NEAR(first.vehicle_yaw_rad, geometry::fixed_axes_angles(geometry::so3_exp(remembered))(0), 3e-4);
    EXPECT_NEAR(first.speed_scale, memory.speed_scale * (1.0 + radar.range_rate_scale), 2e-4);
    EXPECT_NEAR(yaw_std(first), doubted, 0.2 * doubted) << "what the excess of heights does to yaw counts, too";
    if (was_off) {
      EXPECT_LT(std::sqrt(variance), 0.9 * doubted) << "otherwise the standard deviation was not increased";
    }
    EXPECT_TRUE(first.is_observable(alignment_axis::kVehicleYaw | alignment_axis::kSpeedScale));
    EXPECT_NEAR(first.kpis.seconds_of_drive, memory.radars[kMisaligned - 1].seconds_of_drive, 0.1);
    EXPECT_NE(log().find("alignment of 4 radars restored from " + file_.string()), std::string::npos) << log();
  }

  static void expect_from_the_prior(const AlignmentEstimate& first) {
    const alignment::windows::Priors config;
    EXPECT_EQ(first.vehicle_yaw_rad, 0.0F);
    EXPECT_EQ(first.speed_scale, 1.0F);
    EXPECT_NEAR(yaw_std(first), config.rotation_std_rad, 0.01 * config.rotation_std_rad);
    EXPECT_EQ(first.observable & (alignment_axis::kVehicleYaw | alignment_axis::kSpeedScale), 0u);
    EXPECT_LT(first.kpis.seconds_of_drive, 0.1F);
  }

  /// Writes a file that must not be used, and checks the report.
  void expect_refused(const std::string& content, const std::string& said) {
    std::ofstream(file_, std::ios::binary) << content;
    expect_from_the_prior(ignition_on());
    EXPECT_FALSE(fs::exists(file_)) << "it does not block the next memory";
    EXPECT_EQ(text_of(kState / "alignment.rejected"), content) << "kept for inspection";
    EXPECT_NE(log().find("stored alignment is " + said + "; kept with the suffix .rejected and not used"),
              std::string::npos)
        << log();
    EXPECT_TRUE(domain_.until(3.0, [&] { return witness_->rejected_inputs() == 1; }))
        << "health did not receive the fault";
    const ServiceStatus& status = witness_->status();
    EXPECT_EQ(status.faults[static_cast<std::size_t>(Fault::kWireValue)], 1u);
    EXPECT_EQ(std::string(status.last_fault.data()), "stored alignment is " + said);
    // It learns from the start, and stores the result.
    EXPECT_TRUE(domain_.until(5.0, [&] { return kept_drive_s() > 1.0; }));
    EXPECT_NEAR(witness_->last().vehicle_yaw_rad, kTrueYaw, 0.5 * kRadiansPerDegree);
    ignition_off();
    EXPECT_EQ(text_of(kState / "alignment.rejected"), content);
  }

  /// A memory that would turn the misaligned radar by 5° to the other side if it were used.
  [[nodiscard]] static std::string wrong_memory(const VehicleConfig& of) {
    Memory memory;
    memory.number_of_radars = of.radars.size();
    for (std::size_t i = 0; i < of.radars.size(); ++i) {
      memory.radars[i].id = of.radars[i].id;
      memory.radars[i].rotation_vehicle_rad = {0.0, 0.0, -5.0 * kRadiansPerDegree};
      memory.radars[i].seconds_of_drive = 3600.0;
      for (std::size_t axis = 0; axis < 3; ++axis) memory.radars[i].rotation_variance(axis, axis) = 1e-8;
    }
    alignment::MemoryBytes bytes;
    const std::size_t length = alignment::encode_memory(memory, identity_of(of), bytes);
    EXPECT_GT(length, 0u);
    return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)};
  }

  const VehicleConfig vehicle_ = vehicle();
  const fs::path file_ = kState / "alignment";
  std::unique_ptr<Witness> witness_;
  std::unique_ptr<harness::Child> estimator_;
  harness::Domain domain_{"demo", {kService, "detection_corrector", "ghost_filter", "tracker"}};
};

TEST_F(IgnitionCycles, TheStoredEstimateIsUsedAndDoubtedIfTheMachineWasOff) {
  expect_from_the_prior(ignition_on());
  ASSERT_TRUE(domain_.until(8.0, [&] { return witness_->last().kpis.seconds_of_drive > 3.0F; }));
  ignition_off();
  const LoadedMemory first = kept();
  ASSERT_EQ(first.kind, LoadedMemory::Kind::kTaken) << first.reason;
  EXPECT_NEAR(first.memory.radars[kMisaligned - 1].rotation_vehicle_rad[2], kTrueYaw, 0.2 * kRadiansPerDegree);
  EXPECT_NEAR(first.memory.radars[kMisaligned - 1].seconds_of_drive, witness_->last().kpis.seconds_of_drive, 0.3)
      << "the file is that of the end, not of the last period";

  ASSERT_NO_FATAL_FAILURE(reboot(first.memory));
  expect_taken_up(ignition_on(), first.memory, true);
  // Killed during the drive, after it has stored more than at its start.
  const double began_s = first.memory.radars[kMisaligned - 1].seconds_of_drive;
  ASSERT_TRUE(domain_.until(5.0, [&] { return kept_drive_s() > began_s + 1.0; }));
  // Just after an estimate was sent, because a process that dies while sending leaves the bus locked
  // (system_service_killed).
  const std::size_t sent = witness_->size();
  ASSERT_TRUE(domain_.until(2.0, [&] { return witness_->size() > sent; }));
  estimator_->send(SIGKILL);
  EXPECT_EQ(estimator_->wait_for(2.0), -SIGKILL);
  const LoadedMemory second = kept();
  ASSERT_EQ(second.kind, LoadedMemory::Kind::kTaken) << second.reason;

  expect_taken_up(ignition_on(), second.memory, false);
  ignition_off();
  EXPECT_FALSE(fs::exists(kState / "alignment.rejected"));
}

TEST_F(IgnitionCycles, ACorruptFileIsReportedKeptAsideAndNotUsed) {
  std::string content = wrong_memory(vehicle_);
  content[content.size() / 2] = static_cast<char>(content[content.size() / 2] ^ 1);
  expect_refused(content, alignment::describe(alignment::MemoryVerdict::kCorrupt));
}

TEST_F(IgnitionCycles, AnotherVehiclesFileIsReportedKeptAsideAndNotUsed) {
  VehicleConfig other = vehicle_;
  other.name = "another car";
  expect_refused(wrong_memory(other), alignment::describe(alignment::MemoryVerdict::kForeign));
}

}  // namespace
}  // namespace boresight
