// Running processes that lose no scan give the same tracks as `boresight run` on the same recording.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "services/boresight/score/run_folder.hpp"
#include "services/common/runtime/node.hpp"
#include "tests/system/harness/domain.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;

// The processes run at the same time, so an estimate may reach the detection corrector a scan earlier or later than in
// `boresight run`. This changes a track by millimetres, and a decision at a threshold now and then: a weak track is
// confirmed earlier or later, or not at all, and ids, which count births, differ from then on. So tracks are compared
// by position, on a drive with the statistics of a real radar. The limits are choices, twice and more what four calls
// on a busy machine showed: a median of 5 mm, and 1 … 5 % of the tracks without partner.
constexpr double kMedian_m = 0.02;
constexpr double kPartner_m = 0.5;
constexpr double kMostWithoutPartner_share = 0.1;

constexpr double kDrive_s = 20.0;
const fs::path kLists = "/tmp/same_tracks.csv";
const fs::path kRun = "/tmp/same_tracks_run";

/// Confirmed tracks after a scan.
struct List {
  std::int64_t time_ns = 0;  // of measurement
  std::vector<Eigen::Vector2d> positions_m;
};
/// By radar, in the order of its scans.
using Lists = std::map<std::uint32_t, std::vector<List>>;

/// Writes "radar time_ns tracks" and "x y" for each of these tracks, list by list.
int record_lists(const fs::path& attached) {
  runtime::Node node(catalogue::Service::kMonitor, "-same-tracks");
  std::ofstream file(kLists);
  file.precision(std::numeric_limits<float>::max_digits10);
  node.on<TrackList>([&](const TrackList& list) {
    file << list.header.source_id << ' ' << list.header.measurement_time_ns << ' ' << list.number_of_confirmed_tracks
         << '\n';
    for (std::size_t k = 0; k < list.number_of_confirmed_tracks; ++k) {
      const Track& track = list.tracks[k];
      file << track.position_vehicle_m[0] << ' ' << track.position_vehicle_m[1] << '\n';
    }
  });
  std::ofstream{attached};
  return node.spin();
}

Lists recorded_lists() {
  Lists lists;
  std::ifstream file(kLists);
  std::uint32_t radar = 0;
  std::size_t tracks = 0;
  for (List list; file >> radar >> list.time_ns >> tracks; lists[radar].push_back(list)) {
    list.positions_m.clear();
    for (Eigen::Vector2d at_m; tracks > 0 && file >> at_m.x() >> at_m.y(); --tracks) list.positions_m.push_back(at_m);
  }
  return lists;
}

Lists lists_of_run() {
  Lists lists;
  score::RunScans scans(kRun);
  score::RunTracks tracks(kRun);
  std::vector<judge::ScoredTrack> of_scan;
  for (score::RunScan scan; scans.next(scan);) {
    tracks.take(scan, of_scan);
    List list;
    list.time_ns = scan.time_ns;
    for (const judge::ScoredTrack& track : of_scan) {
      if (track.confirmed) list.positions_m.push_back(track.position_m);
    }
    lists[scan.radar].push_back(list);
  }
  return lists;
}

/// From each track of one list to the nearest of the other.
std::vector<double> distances_m(const List& from, const List& to) {
  std::vector<double> distances;
  for (const Eigen::Vector2d& at_m : from.positions_m) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& other_m : to.positions_m) nearest_m = std::min(nearest_m, (other_m - at_m).norm());
    distances.push_back(nearest_m);
  }
  return distances;
}

TEST(SameTracks, ProcessesThatLoseNoScanGiveTheTracksOfTheRunCommand) {
  const std::vector<fs::path> recordings = harness::simulated_drive(kDrive_s, "demo_drive", "can_cluster");
  const fs::path attached = "/tmp/same_tracks_attached";
  fs::remove(attached);
  harness::Child observer([&] { return record_lists(attached); });
  harness::Domain domain("demo");
  domain.start();
  ASSERT_TRUE(domain.until(5.0, [&] { return fs::exists(attached); }));
  domain.replay(recordings, {"--speed", "max"});
  ASSERT_TRUE(domain.until(60.0, [&] { return domain.replay_has_ended(); }));
  domain.run_for(0.3);
  ASSERT_EQ(observer.stop(), 0);

  std::string command = BORESIGHT_BINARY_DIR "/boresight run --quiet --vehicle demo --out " + kRun.string();
  for (const fs::path& recording : recordings) command += " " + recording.string();
  ASSERT_EQ(std::system(command.c_str()), 0);

  const Lists of_processes = recorded_lists(), of_run = lists_of_run();
  ASSERT_EQ(of_run.size(), 4u);
  std::size_t scans = 0;
  std::vector<double> all_m;  // in both directions
  for (const auto& [radar, lists] : of_run) {
    ASSERT_TRUE(of_processes.contains(radar)) << "radar " << radar;
    const std::vector<List>& received = of_processes.at(radar);
    ASSERT_EQ(received.size(), lists.size()) << "radar " << radar;
    for (std::size_t i = 0; i < lists.size(); ++i) {
      // The processes have another clock, so the same scan is as long after the radar's first one.
      ASSERT_EQ(received[i].time_ns - received[0].time_ns, lists[i].time_ns - lists[0].time_ns)
          << "radar " << radar << ", scan " << i + 1;
      ++scans;
      for (const std::vector<double>& each : {distances_m(lists[i], received[i]), distances_m(received[i], lists[i])}) {
        all_m.insert(all_m.end(), each.begin(), each.end());
      }
    }
  }
  ASSERT_GT(all_m.size(), scans);
  std::sort(all_m.begin(), all_m.end());
  const double median_m = all_m[all_m.size() / 2];
  const auto lonely = all_m.end() - std::upper_bound(all_m.begin(), all_m.end(), kPartner_m);
  const double lonely_share = static_cast<double>(lonely) / static_cast<double>(all_m.size());
  std::printf("%zu scans: median distance of the tracks %.4f m, %.1f %% without partner\n", scans, median_m,
              100.0 * lonely_share);
  EXPECT_LE(median_m, kMedian_m);
  EXPECT_LE(lonely_share, kMostWithoutPartner_share);
}

}  // namespace
}  // namespace boresight
