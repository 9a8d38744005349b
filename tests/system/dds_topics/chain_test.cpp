// Tracks, alignment and services of the running product arrive at another implementation of DDS as they are in shared
// memory.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/runtime/node.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;

constexpr double kDrive_s = 14.0;
constexpr int kListening_s = 12;
constexpr const char* kDdsDomain = "76";
const fs::path kReceived = "/tmp/received.txt";

/// What the peer prints of a track, and of an estimate.
using Values = std::array<float, 5>;

/// All track lists and estimates in shared memory, recorded by a process of its own.
class Recorder {
 public:
  Recorder() : process_(std::make_unique<harness::Child>([this] { return record(); })) {}
  [[nodiscard]] harness::Child& process() { return *process_; }
  [[nodiscard]] bool is_attached() const { return log_->attached; }

  /// By list and track.
  [[nodiscard]] std::map<std::pair<std::uint64_t, std::uint32_t>, Values> tracks() const {
    std::map<std::pair<std::uint64_t, std::uint32_t>, Values> found;
    for (std::size_t i = 0; i < log_->rows; ++i) {
      const Row& row = log_->row[i];
      found[{row.sequence, row.id}] = row.values;
    }
    return found;
  }
  [[nodiscard]] std::map<std::uint64_t, Values> estimates() const {
    std::map<std::uint64_t, Values> found;
    for (std::size_t i = 0; i < log_->estimates; ++i) found[log_->estimate[i].sequence] = log_->estimate[i].values;
    return found;
  }
  [[nodiscard]] std::size_t lists() const { return log_->lists; }

 private:
  struct Row {
    std::uint64_t sequence;
    std::uint32_t id;
    Values values;
  };
  static constexpr std::size_t kMaxRows = 100'000, kMaxEstimates = 10'000;
  struct Log {
    volatile bool attached;
    volatile std::size_t rows, estimates, lists;
    std::array<Row, kMaxRows> row;
    std::array<Row, kMaxEstimates> estimate;
  };

  int record() {
    runtime::Node node(catalogue::Service::kMonitor, "-dds-topics");
    node.on<TrackList>([&](const TrackList& list) {
      log_->lists = log_->lists + 1;
      for (std::size_t i = 0; i < list.number_of_tracks && log_->rows < kMaxRows; ++i) {
        const Track& t = list.tracks[i];
        log_->row[log_->rows] = {list.header.sequence, t.tracking_id,
                                 Values{t.position_vehicle_m[0], t.position_vehicle_m[1], t.velocity_over_ground_mps[0],
                                        t.existence_probability, t.covariance[48]}};
        log_->rows = log_->rows + 1;
      }
    });
    node.on<AlignmentEstimate>([&](const AlignmentEstimate& e) {
      if (log_->estimates >= kMaxEstimates) return;
      log_->estimate[log_->estimates] = {e.header.sequence, e.header.source_id,
                                         Values{e.speed_scale, e.alignment_yaw_rad, e.covariance[5], 0.0F, 0.0F}};
      log_->estimates = log_->estimates + 1;
    });
    log_->attached = true;
    return node.spin();
  }

  harness::Shared<Log> log_;
  std::unique_ptr<harness::Child> process_;
};

float float_of(const std::string& word) {
  return std::strtof(word.c_str(), nullptr);
}

TEST(TopicsOfTheChain, EqualThoseInSharedMemoryAtAnotherImplementation) {
  if (!fs::exists(BORESIGHT_TOPICS_PEER)) GTEST_SKIP() << "skipped: Cyclone DDS is not installed";
  ASSERT_EQ(setenv("BORESIGHT_DDS_DOMAIN", kDdsDomain, 1), 0);
  const auto recordings = harness::simulated_drive(kDrive_s);
  Recorder recorder;
  harness::Child peer([] {
    const std::string config = "file://" BORESIGHT_SOURCE_DIR "/config/dds/cyclonedds.xml";
    setenv("CYCLONEDDS_URI", config.c_str(), 1);
    const std::string seconds = std::to_string(kListening_s + 15);
    execl(BORESIGHT_TOPICS_PEER, BORESIGHT_TOPICS_PEER, kDdsDomain, seconds.c_str(), kReceived.c_str(), nullptr);
    return 1;
  });
  harness::Domain domain("demo");
  domain.start();
  ASSERT_TRUE(domain.until(5.0, [&] { return recorder.is_attached(); }));
  std::map<std::string, int> pids;
  for (std::size_t i = 0; i < catalogue::kNumberOfSupervisedServices; ++i) {
    const std::string service(catalogue::kServiceNames[i]);
    pids[service] = domain.supervisor().pid_of(service);
  }
  domain.replay(recordings);
  domain.run_for(kListening_s);
  EXPECT_EQ(recorder.process().stop(), 0);
  peer.send(SIGKILL);  // its lines are flushed

  const auto tracks = recorder.tracks();
  const auto estimates = recorder.estimates();
  std::size_t lists = 0, equal_tracks = 0, equal_estimates = 0;
  std::set<std::string> with_heartbeat;
  std::ifstream file(kReceived);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind, word;
    words >> kind;
    if (kind == "list") {
      ++lists;
    } else if (kind == "track") {
      std::uint64_t sequence = 0;
      std::uint32_t id = 0;
      words >> sequence >> id;
      const auto found = tracks.find({sequence, id});
      if (found == tracks.end()) continue;  // the recorder lost this list
      for (const float expected : found->second) {
        words >> word;
        EXPECT_EQ(float_of(word), expected) << line;
      }
      ++equal_tracks;
    } else if (kind == "estimate") {
      std::uint64_t sequence = 0;
      words >> sequence >> word >> word;
      const auto found = estimates.find(sequence);
      if (found == estimates.end()) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        words >> word;
        EXPECT_EQ(float_of(word), found->second[i]) << line;
      }
      ++equal_estimates;
    } else if (kind == "service") {
      std::string name, condition, pid;
      words >> name >> condition >> word >> pid;
      // Whether a service is alive or degraded depends on the load of the machine; that it has a heartbeat does not.
      if (pid != "0") {
        EXPECT_EQ(std::stoi(pid), pids[name]) << line;
        with_heartbeat.insert(name);
      }
    }
  }
  std::printf("%zu of %zu lists, %zu tracks, %zu estimates equal\n", lists, recorder.lists(), equal_tracks,
              equal_estimates);
  // One list in 50 ms, of which some may be lost on a busy machine.
  EXPECT_GT(lists, kListening_s * 10U);
  EXPECT_LE(lists, kListening_s * 20U + 20U) << "the period of the lists is not kept";
  EXPECT_GT(equal_tracks, 100U);
  EXPECT_GT(equal_estimates, 4U * (kListening_s - 4U)) << "four radars, one estimate a second";
  EXPECT_EQ(with_heartbeat.size(), catalogue::kNumberOfSupervisedServices);
}

}  // namespace
}  // namespace boresight
