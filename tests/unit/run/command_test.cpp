// `boresight run` as a user calls it: files, exit codes, damaged input, a full disk, Ctrl-C.
#include <csignal>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/run/drive_in_memory.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::run {
namespace {

using ::testing::HasSubstr;

class RunCommand : public ::testing::Test {
 protected:
  /// Runs `boresight run ARGUMENTS` in a shell; what it prints is in output_ and errors_.
  int run(const std::string& arguments) {
    const std::string out = (folder_.path() / "stdout").string(), err = (folder_.path() / "stderr").string();
    const std::string command = BORESIGHT_BINARY_DIR "/boresight run --config " BORESIGHT_SOURCE_DIR "/config " +
                                arguments + " > " + out + " 2> " + err;
    const int status = std::system(command.c_str());
    output_ = schema_page::text_of(out);
    errors_ = schema_page::text_of(err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] static std::string drive() {
    return testing::demo_drive().radars.string() + " " + testing::demo_drive().ego.string();
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] std::string text(const std::string& name) const { return schema_page::text_of(path(name).string()); }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
  }
  /// run.json without the object "timing", which is its last.
  static std::string without_timing(const std::string& json) { return json.substr(0, json.find("\"timing\"")); }

  static void expect_complete_rows(const std::string& csv, const std::string& name) {
    ASSERT_TRUE(csv.ends_with("\n")) << name;
    const std::size_t columns = testing::cells_of(csv.substr(0, csv.find('\n'))).size();
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
      ASSERT_EQ(testing::cells_of(line).size(), columns) << name << ": " << line;
    }
  }

  testing::TemporaryFolder folder_{"command"};
  std::string output_, errors_;
};

TEST_F(RunCommand, TwoRunsDifferInTheirTimingOnly) {
  ASSERT_EQ(run(drive() + " --vehicle demo --out " + path("a").string()), 0) << errors_;
  EXPECT_THAT(output_, HasSubstr("times real time"));
  EXPECT_EQ(errors_, "");
  ASSERT_EQ(run(drive() + " --vehicle demo --quiet --out " + path("b").string()), 0) << errors_;
  EXPECT_EQ(output_, "");
  for (const std::string_view name : kFileNames) {
    const std::string once = text("a/" + std::string(name));
    EXPECT_GT(once.size(), 200u) << name;
    EXPECT_TRUE(once == text("b/" + std::string(name))) << name;
    if (name.ends_with(".csv")) expect_complete_rows(once, std::string(name));
  }
  const std::string json = text("a/run.json");
  EXPECT_EQ(without_timing(json), without_timing(text("b/run.json")));
  EXPECT_THAT(json, HasSubstr("\"complete\": true"));
  EXPECT_THAT(json, HasSubstr("\"ghost_filter\": "));
  EXPECT_THAT(json, HasSubstr("\"scans\": " + std::to_string(testing::demo_drive().scans)));
}

TEST_F(RunCommand, WritesAFolderThatReportShows) {
  ASSERT_EQ(run(drive() + " --vehicle demo --quiet --out " + path("run").string()), 0) << errors_;
  const std::string page = path("page.html").string(), printed = path("printed").string();
  const std::string report = BORESIGHT_BINARY_DIR "/boresight report --config " BORESIGHT_SOURCE_DIR "/config ";
  const int status = std::system(
      (report + path("run").string() + " --vehicle demo --out " + page + " > " + printed + " 2>&1").c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_LE(WEXITSTATUS(status), 1) << text("printed");
  EXPECT_THAT(text("printed"), HasSubstr("[ok] every radar delivered scans"));
  EXPECT_THAT(text("printed"), HasSubstr("[ok] the alignment and the verdicts of health could be read to their end"));
  EXPECT_THAT(text("page.html"), HasSubstr("An offline run has no latencies"));
  ASSERT_NE(std::system((report + path("").string() + " --vehicle demo > " + printed + " 2>&1").c_str()), 0);
  EXPECT_THAT(text("printed"), HasSubstr("holds neither monitor.jsonl nor scans.csv"));
}

TEST_F(RunCommand, TakesTheTablesOfDecodeInPlaceOfTheRecording) {
  const std::string decode =
      BORESIGHT_BINARY_DIR "/boresight decode --config " BORESIGHT_SOURCE_DIR "/config --vehicle demo ";
  const std::string detections = path("d.csv").string(), ego = path("e.csv").string();
  ASSERT_EQ(std::system((decode + "--csv --out " + detections + " " + drive() + " 2> /dev/null").c_str()), 0);
  ASSERT_EQ(std::system((decode + "--ego --out " + ego + " " + drive() + " 2> /dev/null").c_str()), 0);
  ASSERT_EQ(run(drive() + " --vehicle demo --out " + path("recorded").string()), 0) << errors_;
  ASSERT_EQ(run("--detections " + detections + " --ego " + ego + " --vehicle demo --out " + path("table").string()), 0)
      << errors_;
  EXPECT_THAT(errors_, HasSubstr("ignored columns: \"cycle\""));
  for (const char* const name : {"scans.csv", "detections.csv", "reflectors.csv", "tracks.csv", "road_edges.csv",
                                 "collision_warnings.csv", "alignment.csv"}) {
    EXPECT_TRUE(text("recorded/" + std::string(name)) == text("table/" + std::string(name))) << name;
  }
}

TEST_F(RunCommand, CountsAndReportsDamagedInput) {
  std::string log = schema_page::text_of(testing::demo_drive().ego.string());
  const std::size_t middle = log.find('\n', log.size() / 2);
  log.insert(middle + 1, "no frame\n(also) none\n");
  write("damaged.log", log);
  EXPECT_EQ(run(testing::demo_drive().radars.string() + " " + path("damaged.log").string() + " --vehicle demo --out " +
                path("run").string()),
            0)
      << "two lines of many";
  EXPECT_THAT(errors_, HasSubstr("damaged.log:"));
  EXPECT_THAT(errors_, HasSubstr("2 of "));
  EXPECT_THAT(text("run/run.json"), HasSubstr("\"unreadable\": 2,"));
  for (int i = 0; i < 200; ++i) log.insert(middle + 1, "no frame\n");
  write("damaged.log", log);
  EXPECT_EQ(run(path("damaged.log").string() + " --vehicle demo --out " + path("run").string()), 1);
  EXPECT_THAT(errors_, HasSubstr("more than one in a hundred"));
  EXPECT_THAT(errors_, HasSubstr("there is no scan"));
}

TEST_F(RunCommand, NamesWithBlanksAndQuotesWork) {
  std::string vehicle = schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/vehicle/demo.toml");
  const std::string name = "\"front_left\"";
  ASSERT_NE(vehicle.find(name), std::string::npos);
  vehicle.replace(vehicle.find(name), name.size(), R"("front \"left\" one")");
  write("my car.toml", vehicle);
  ASSERT_EQ(run(drive() + " --vehicle '" + path("my car.toml").string() + "' --out '" + path("my run").string() + "'"),
            0)
      << errors_;
  EXPECT_THAT(text("my run/run.json"), HasSubstr(R"("name": "front \"left\" one")"));
  expect_complete_rows(text("my run/scans.csv"), "scans.csv");
}

TEST_F(RunCommand, RefusesWrongCommandLinesAndLeavesNothing) {
  const std::string out = " --vehicle demo --out " + path("none").string();
  EXPECT_EQ(run(out), 2);
  EXPECT_THAT(errors_, HasSubstr("give either recordings, or --detections and --ego"));
  EXPECT_EQ(run(drive() + " --ego x.csv" + out), 2);
  EXPECT_EQ(run("--detections - --ego -" + out), 2);
  EXPECT_EQ(run(drive() + " --vehicle absent --out " + path("none").string()), 2);
  EXPECT_EQ(run(path("absent.pcap").string() + out), 3);
  EXPECT_THAT(errors_, HasSubstr("absent.pcap: No such file or directory"));
  write("empty.csv", "");
  EXPECT_EQ(run("--detections " + path("empty.csv").string() + " --ego " + path("empty.csv").string() + out), 3);
  EXPECT_THAT(errors_, HasSubstr("empty.csv: is empty"));
  EXPECT_FALSE(std::filesystem::exists(path("none")));
}

TEST_F(RunCommand, AFullDiskIsNamedAndLeavesNoFile) {
  std::filesystem::create_directories(path("full"));
  std::filesystem::create_symlink("/dev/full", path("full/tracks.csv"));
  EXPECT_EQ(run(drive() + " --vehicle demo --out " + path("full").string()), 3);
  EXPECT_THAT(errors_, HasSubstr("full/tracks.csv: cannot be written: No space left on device"));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path("full"))) files += entry.is_symlink() ? 0 : 1;
  EXPECT_EQ(files, 0u);
}

TEST_F(RunCommand, CtrlCLeavesCompleteRows) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const std::string out = path("interrupted").string();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    dup2(pipe_ends[0], STDIN_FILENO);
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    execl(BORESIGHT_BINARY_DIR "/boresight", "boresight", "run", "-", "--config", BORESIGHT_SOURCE_DIR "/config",
          "--vehicle", "demo", "--quiet", "--out", out.c_str(), static_cast<char*>(nullptr));
    _exit(99);
  }
  close(pipe_ends[0]);
  const std::string bytes = schema_page::text_of(testing::demo_drive().radars.string());
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::write(pipe_ends[1], bytes.data() + sent, bytes.size() - sent);
    ASSERT_GT(n, 0);
    sent += static_cast<std::size_t>(n);
  }
  // All but the rest that the pipe holds has been read; the input stays open.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  close(pipe_ends[1]);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_THAT(text("interrupted/run.json"), HasSubstr("\"complete\": false"));
  for (const std::string_view name : kFileNames) {
    if (name.ends_with(".csv")) expect_complete_rows(text("interrupted/" + std::string(name)), std::string(name));
  }
  EXPECT_GT(testing::table_of(text("interrupted/scans.csv")).size(), 100u);
  for (const auto& entry : std::filesystem::directory_iterator(path("interrupted"))) {
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace boresight::run
