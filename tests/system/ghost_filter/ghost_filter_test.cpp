// The ghost filter as a process, with each method: it works without the tracker and reports this, continues while the
// tracker starts and stops, and rejects an invalid configuration.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

namespace fs = std::filesystem;
using catalogue::TopicId;
using harness::Observer;
using harness::Sample;
using testing::HasSubstr;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The shipped configuration with `from` in the ghost filter's file replaced.
fs::path configuration(const std::string& from, const std::string& to) {
  const fs::path folder = "/tmp/ghost_filter_configuration";
  fs::remove_all(folder);
  fs::copy(harness::shipped_configuration(), folder, fs::copy_options::recursive);
  const fs::path file = folder / "services" / "ghost_filter.toml";
  std::string text = text_of(file);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  std::ofstream(file) << text;
  return folder;
}

class GhostFilter : public testing::TestWithParam<std::string> {};

TEST_P(GhostFilter, LabelsEveryScanWithOrWithoutTheTracker) {
  const auto recordings = harness::simulated_drive(12.0, "tunnel");
  Observer observer("-ghosts");
  harness::Domain domain("demo", {"ghost_filter", "tracker"});
  domain.start();
  const auto filter =
      harness::start_alone("ghost_filter", configuration(R"(method = "evidence")", "method = \"" + GetParam() + "\""));
  ASSERT_TRUE(domain.until(5.0, [&] { return observer.is_attached(); }));
  domain.run_for(0.5);
  domain.replay(recordings);
  const auto scans = [&](std::size_t from) { return observer.of(TopicId::kClassifiedScan, from); };
  const auto never_had_tracks = [](const Sample* s) { return (s->flags & pipeline_flag::kNoTracks) != 0; };
  const auto without_tracks = [](const Sample* s) {
    return (s->flags & (pipeline_flag::kNoTracks | pipeline_flag::kTracksStale)) != 0;
  };

  ASSERT_TRUE(domain.until(6.0, [&] { return scans(0).size() >= 160; }))
      << text_of(harness::log_of_alone("ghost_filter"));
  const auto alone = scans(0);
  EXPECT_TRUE(std::all_of(alone.begin(), alone.end(), never_had_tracks)) << "there is no tracker";
  std::array<std::size_t, kNumberOfProvenances> classified{};
  std::size_t with_segments = 0;
  for (const Sample* scan : alone) {
    for (std::size_t i = 0; i < classified.size(); ++i) classified[i] += scan->labels[i];
    with_segments += scan->segments > 0 ? 1 : 0;
  }
  EXPECT_GT(classified[static_cast<std::size_t>(Provenance::kStationary)], 1000u);
  EXPECT_GT(classified[static_cast<std::size_t>(Provenance::kMoving)], 50u);
  std::size_t ghosts = 0;
  for (const Provenance origin :
       {Provenance::kGhostType1, Provenance::kGhostType2, Provenance::kClutter, Provenance::kAmbiguity}) {
    ghosts += classified[static_cast<std::size_t>(origin)];
  }
  EXPECT_GT(ghosts, 50u) << "tunnels are mirrors";
  EXPECT_GT(with_segments, alone.size() / 2) << "of the tunnel's walls";

  auto tracker = harness::start_alone("tracker");
  std::size_t before = observer.size();
  const auto with_tracks = [&] {
    const auto now = scans(before);
    return now.size() >= 8 && std::none_of(now.end() - 8, now.end(), without_tracks);
  };
  EXPECT_TRUE(domain.until(3.0, with_tracks)) << "the tracker runs, but its tracks are not used";
  EXPECT_EQ(tracker->stop(), 0);
  before = observer.size();
  const auto alone_again = [&] {
    const auto now = scans(before);
    return now.size() >= 8 && std::all_of(now.end() - 8, now.end(), without_tracks);
  };
  EXPECT_TRUE(domain.until(3.0, alone_again)) << "the tracker is gone, and its tracks are still used";
  tracker = harness::start_alone("tracker");
  before = observer.size();
  EXPECT_TRUE(domain.until(3.0, with_tracks)) << "the tracker is back";

  // No scan is missing during the whole time.
  std::array<std::uint64_t, 5> last{};
  for (const Sample* scan : scans(0)) {
    EXPECT_EQ(scan->header.source_sequence, ++last.at(scan->header.source_id)) << "radar " << scan->header.source_id;
    EXPECT_NE(scan->correspondence, 2);
  }
  EXPECT_EQ(tracker->stop(), 0);
  EXPECT_EQ(filter->stop(), 0);
  EXPECT_EQ(observer.process().stop(), 0);
}

INSTANTIATE_TEST_SUITE_P(By, GhostFilter, testing::Values("evidence", "published"),
                         [](const auto& info) { return info.param; });

TEST(GhostFilterConfiguration, AnInvalidFileEndsItWithFileLineKeyAndRange) {
  struct Case {
    std::string from, to, classified;
  };
  const std::string file = "/tmp/ghost_filter_configuration/services/ghost_filter.toml:";
  for (const Case& c : {
           Case{R"(method = "evidence")", R"(method = "magic")", ":3: method: "},
           Case{R"(method = "evidence")", R"(method = "magic")",
                R"("magic" is unknown; must be one of "evidence", "published")"},
           Case{"ambiguous_share = 0.03", "ambiguous_share = 1.5",
                "evidence.intensity.ambiguous_share: 1.5 is out of range; allowed: 0 … 0.5"},
           Case{"burst = [8, 20, 45]", "burst = [8, 45, 20]", "evidence.levels.burst: must rise"},
           Case{"min_cells = 6", "min_cells = \"six\"",
                "evidence.map.min_cells: must be an integer (1 … 1000), but is a string"},
           Case{"cluster_min_points = 8", "cluster_points = 8", "published.reflectors.cluster_points: unknown key"},
       }) {
    const auto filter = harness::start_alone("ghost_filter", configuration(c.from, c.to));
    EXPECT_EQ(filter->wait_for(5.0), 2) << c.to;
    const std::string log = text_of(harness::log_of_alone("ghost_filter"));
    EXPECT_THAT(log, HasSubstr(file));
    EXPECT_THAT(log, HasSubstr(c.classified));
  }
}

}  // namespace
}  // namespace boresight
