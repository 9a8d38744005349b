// Recordings of real radars through all processes in real time.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "tests/golden/support/npy.hpp"
#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;
using catalogue::Service;
using catalogue::TopicId;
using harness::Observer;
using harness::Sample;

const fs::path kData = BORESIGHT_SHARED_DATA;

/// Plays the recording through the whole chain and returns the recorded messages; the domain has ended afterwards.
std::unique_ptr<Observer> play(const std::string& vehicle, const fs::path& recording, double limit_s) {
  auto observer = std::make_unique<Observer>("-recordings");
  harness::Domain domain(vehicle);
  domain.start();
  EXPECT_TRUE(domain.until(5.0, [&] { return observer->is_attached(); }));
  domain.replay({recording});
  EXPECT_TRUE(domain.until(limit_s, [&] { return domain.replay_has_ended(); }));
  domain.run_for(0.5);
  EXPECT_EQ(observer->process().stop(), 0);
  domain.supervisor().stop();
  return observer;
}

class Comma2k19 : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!fs::exists(kRecording)) return;
    observer_ = play("comma2k19", kRecording, 75.0);
  }
  static void TearDownTestSuite() { observer_.reset(); }
  void SetUp() override {
    if (!observer_) GTEST_SKIP() << "skipped: no shared data";
  }

  /// The recording's clock at a message's measurement time: the first ego frame is the recording's first frame.
  static double recording_time_s(const Sample& sample) {
    const auto& first = *observer_->of(TopicId::kEgoMotion).front();
    return kFirstFrame_s +
           static_cast<double>(sample.header.measurement_time_ns - first.header.measurement_time_ns) * 1e-9;
  }

  static inline const fs::path kFolder = kData / "comma2k19_seg40";
  static inline const fs::path kRecording = kFolder / "radar_ego.candump.log";
  static constexpr double kFirstFrame_s = 46408.585;
  static inline std::unique_ptr<Observer> observer_;
};

TEST_F(Comma2k19, EveryValidRowOfTheRecordingArrives) {
  std::uint64_t rows = 0;
  std::uint64_t last = 0;
  for (const Sample* scan : observer_->of(TopicId::kRadarScan)) {
    rows += scan->count;
    EXPECT_EQ(scan->header.sequence, last + 1);
    last = scan->header.sequence;
  }
  EXPECT_EQ(rows, 10'100u);
}

TEST_F(Comma2k19, EgoMotionIsThatOfTheReferenceDecodings) {
  const auto speed_times = golden::read_npy(kFolder / "processed_log/CAN/speed/t");
  const auto speeds = golden::read_npy(kFolder / "processed_log/CAN/speed/value");
  const auto gyro_times = golden::read_npy(kFolder / "processed_log/IMU/gyro/t");
  // Columns in order: forward, right, down.
  auto gyro = golden::read_npy_columns(kFolder / "processed_log/IMU/gyro/value");
  const std::vector<double> down(gyro.end() - static_cast<std::ptrdiff_t>(gyro_times.size()), gyro.end());
  double speed_square = 0.0;
  double yaw_rate_square = 0.0;
  const auto egos = observer_->of(TopicId::kEgoMotion);
  ASSERT_GT(egos.size(), 2000u);
  for (const Sample* ego : egos) {
    const double time_s = recording_time_s(*ego);
    speed_square += std::pow(static_cast<double>(ego->values[0]) - golden::at(speed_times, speeds, time_s), 2);
    yaw_rate_square += std::pow(static_cast<double>(ego->values[1]) + golden::at(gyro_times, down, time_s), 2);
  }
  const auto count = static_cast<double>(egos.size());
  RecordProperty("speed_rms_mps", std::to_string(std::sqrt(speed_square / count)));
  RecordProperty("yaw_rate_rms_radps", std::to_string(std::sqrt(yaw_rate_square / count)));
  EXPECT_LT(std::sqrt(speed_square / count), 0.15);
  EXPECT_LT(std::sqrt(yaw_rate_square / count), 0.015) << "against a phone's gyro";
}

TEST_F(Comma2k19, GatewayRejectsNothing) {
  const ServiceStatus* gateway = nullptr;
  for (const Sample* sample : observer_->of(TopicId::kServiceStatus)) {
    if (sample->header.source_id == static_cast<std::uint32_t>(Service::kIngestGateway)) gateway = &sample->status;
  }
  ASSERT_NE(gateway, nullptr);
  for (const Fault fault : {Fault::kWireLength, Fault::kWireValue, Fault::kLink, Fault::kLoanFailed}) {
    EXPECT_EQ(gateway->faults[static_cast<std::size_t>(fault)], 0u) << gateway->last_fault.data();
  }
}

TEST_F(Comma2k19, SpeedScaleAgreesWithTheInertialReference) {
  const auto times = golden::read_npy(kFolder / "global_pose/frame_times");
  const auto velocities = golden::read_npy(kFolder / "global_pose/frame_velocities");
  ASSERT_EQ(velocities.size(), 3 * times.size());
  std::vector<double> speeds;
  for (std::size_t i = 0; i < times.size(); ++i) {
    speeds.push_back(std::hypot(velocities[3 * i], velocities[3 * i + 1], velocities[3 * i + 2]));
  }
  double reference = 0.0;
  double signalled = 0.0;
  for (const Sample* ego : observer_->of(TopicId::kEgoMotion)) {
    reference += golden::at(times, speeds, recording_time_s(*ego));
    signalled += static_cast<double>(ego->values[0]);
  }
  const auto estimates = observer_->of(TopicId::kAlignmentEstimate);
  ASSERT_FALSE(estimates.empty());
  const double found = static_cast<double>(estimates.back()->values[0]);
  // The goal of 0.5 % is missed, as in the golden test, which states the reason.
  EXPECT_NEAR(found, reference / signalled, 0.007);
}

TEST_F(Comma2k19, TracksAppear) {
  const auto lists = observer_->of(TopicId::kTrackList);
  EXPECT_EQ(lists.size(), observer_->of(TopicId::kRadarScan).size());
  EXPECT_TRUE(std::any_of(lists.begin(), lists.end(), [](const Sample* s) { return s->confirmed_tracks > 0; }));
}

TEST(Ars548, RealScanArrivesInSharedMemory) {
  const fs::path recording = kData / "nebula_ars548_srr520/ars548_real_2msgs_ipfrag.pcap";
  if (!fs::exists(recording)) GTEST_SKIP() << "skipped: no shared data";
  const auto observer = play("ars548_single", recording, 20.0);
  const auto scans = observer->of(TopicId::kRadarScan);
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans.front()->count, 308u);
  EXPECT_TRUE(scans.front()->in_shared_memory);
  EXPECT_EQ(observer->of(TopicId::kClassifiedScan).size(), 1u) << "and passes the chain without ego motion";
}

}  // namespace
}  // namespace boresight
