// `boresight fit-evidence` as a user calls it: simulated drives, tables of a foreign drive, wrong input.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "services/ghost_filter/weights_file.hpp"
#include "tests/unit/schema_page.hpp"

namespace boresight::fit_evidence {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::string& csv) {
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',') {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    return cells;
  };
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells.at(i);
  }
  return rows;
}

class FitEvidenceCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder() = fs::temp_directory_path() / ("unit_fit_evidence." + std::to_string(getpid()));
    fs::create_directories(folder());
    for (const char* const seed : {"1", "2"}) {
      const std::string name = std::string("drive_") + seed;
      ASSERT_EQ(call("simulate --scenario straight_rail --profile series_77ghz --duration 4 --seed " +
                     std::string(seed) + " --out " + name),
                0)
          << text("stderr.txt");
    }
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }

  static fs::path& folder() {
    static fs::path folder;
    return folder;
  }
  /// Runs `boresight ARGUMENTS` in the folder; what it prints is in stdout.txt and stderr.txt.
  static int call(const std::string& arguments) {
    const std::string command = "cd '" + folder().string() + "' && " BORESIGHT_BINARY_DIR "/boresight " + arguments +
                                " > stdout.txt 2> stderr.txt";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  static std::string text(const fs::path& name) { return schema_page::text_of((folder() / name).string()); }
  static void write(const std::string& name, const std::string& content) {
    fs::create_directories((folder() / name).parent_path());
    std::ofstream(folder() / name, std::ios::binary) << content;
  }
  static void copy(const std::string& from, const std::string& to) {
    fs::create_directories((folder() / to).parent_path());
    fs::copy_file(folder() / from, folder() / to, fs::copy_options::overwrite_existing);
  }
  static std::string problem(const std::string& arguments, int exit_code) {
    EXPECT_EQ(call("fit-evidence " + arguments + " --out never.toml"), exit_code) << arguments << text("stderr.txt");
    EXPECT_FALSE(fs::exists(folder() / "never.toml")) << arguments;
    return text("stderr.txt");
  }
};

TEST_F(FitEvidenceCommand, FittedProfileImprovesOtherDrivesAndRuns) {
  // The start are the weights of another radar.
  ASSERT_EQ(call("fit-evidence drive_1 drive_2 --vehicle demo --statistics ideal --out fitted.toml --json fit.json"), 0)
      << text("stderr.txt");
  EXPECT_THAT(text("stdout.txt"), HasSubstr("each drive is judged by weights fitted on the other drives"));
  const Json fit = Json::parse(text("fit.json"));
  for (const char* const lane : {"without_tracks", "perfect_tracks", "chain"}) {
    const Json& scores = fit.at("lanes").at(lane);
    for (const char* const score : {"brier", "log_loss"}) {
      const double fitted = scores.at("fitted").at(score).get<double>();
      EXPECT_LT(fitted, 0.5 * scores.at("base_rate").at(score).get<double>()) << lane << ' ' << score;
      EXPECT_LT(fitted, scores.at("start").at(score).get<double>()) << lane << ' ' << score;
    }
  }
  // All else of the profile is kept.
  const std::string shipped = schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/radar_profiles/ideal.toml");
  const std::string fitted = text("fitted.toml"), table = "[evidence]\n";
  EXPECT_EQ(fitted.substr(0, fitted.find(table)), shipped.substr(0, shipped.find(table)));
  EXPECT_THAT(fitted, HasSubstr("origin = \"boresight fit-evidence: drive_1 (seed 1), drive_2 (seed 2); "));
  EXPECT_NE(fitted.substr(fitted.find(table)), shipped.substr(shipped.find(table)));

  // The probabilities of `boresight run` with this profile have the score that a fit states for its start.
  ASSERT_EQ(call("fit-evidence drive_1 --vehicle demo --statistics ./fitted.toml --json self.json"), 0);
  ASSERT_EQ(call("run drive_1/radars.pcap drive_1/ego.candump.log --vehicle demo --statistics ./fitted.toml --out run"),
            0)
      << text("stderr.txt");
  std::map<std::tuple<std::string, std::string, std::string>, bool> is_real;
  for (const Row& row : rows_of(text("drive_1/truth_detections.csv"))) {
    is_real[{row.at("radar"), row.at("scan"), row.at("index")}] = row.at("provenance") == "moving";
  }
  double squares = 0.0;
  std::size_t moving = 0;
  for (const Row& row : rows_of(text("run/detections.csv"))) {
    if (!row.at("rejected").empty() || row.at("origin") == "stationary" || row.at("origin") == "unknown") continue;
    const double truth = is_real.at({row.at("radar"), row.at("scan"), row.at("index")}) ? 1.0 : 0.0;
    squares += std::pow(std::stod(row.at("p_moving")) - truth, 2);
    ++moving;
  }
  const Json self = Json::parse(text("self.json"));
  ASSERT_EQ(self.at("moving_detections").get<std::size_t>(), moving);
  ASSERT_GT(moving, 100u);
  EXPECT_NEAR(self.at("lanes").at("chain").at("start").at("brier").get<double>(), squares / static_cast<double>(moving),
              1e-4);
  EXPECT_FALSE(self.at("judges_other_drives").get<bool>());
}

TEST_F(FitEvidenceCommand, WithoutOutTheTableGoesToStandardOutput) {
  ASSERT_EQ(call("fit-evidence drive_1 --vehicle demo --statistics series_77ghz"), 0) << text("stderr.txt");
  EXPECT_THAT(text("stdout.txt"), StartsWith("[evidence]\norigin = \"boresight fit-evidence: drive_1 (seed 1); "));
  static_cast<void>(ghosts::read_weights(config::Reader::parse(text("stdout.txt"), "stdout")));
  EXPECT_THAT(text("stderr.txt"), HasSubstr("judged on the fitted drive itself"));
}

TEST_F(FitEvidenceCommand, TablesOfAForeignDriveFitWhatTheyCan) {
  ASSERT_EQ(call("decode --csv --vehicle demo --out foreign/detections.csv drive_1/radars.pcap"), 3)
      << "the folder does not exist";
  fs::create_directories(folder() / "foreign");
  ASSERT_EQ(call("decode --csv --vehicle demo --out foreign/detections.csv drive_1/radars.pcap"), 0);
  ASSERT_EQ(call("decode --ego --vehicle demo --out foreign/ego.csv drive_1/ego.candump.log"), 0);
  std::string labels = "t_s,radar,index,object,class\n";
  for (const Row& row : rows_of(text("drive_1/truth_detections.csv"))) {
    const std::string& provenance = row.at("provenance");
    labels += row.at("t_s") + "," + row.at("radar") + "," + row.at("index") + "," + row.at("object") + "," +
              (provenance == "moving" ? "car" : provenance) + "\n";
  }
  write("foreign/labels.csv", labels);
  // A radar without a profile of its own: no weights at the start.
  write("new_radar.toml", "name = \"new_radar\"\nabout = \"by us\"");
  ASSERT_EQ(
      call("fit-evidence foreign/ --vehicle demo --statistics ./new_radar.toml --out new_radar.toml --json f.json"), 0)
      << text("stderr.txt");
  EXPECT_THAT(text("stderr.txt"), HasSubstr("new_radar.toml: has no table [evidence]"));
  EXPECT_THAT(text("new_radar.toml"),
              StartsWith("name = \"new_radar\"\nabout = \"by us\"\n\n# Weights of the evidence\n[evidence]\n"));
  EXPECT_THAT(text("new_radar.toml"), HasSubstr("origin = \"boresight fit-evidence: foreign; "));
  const Json of_tables = Json::parse(text("f.json"));
  EXPECT_EQ(of_tables.at("start"), "");
  EXPECT_TRUE(of_tables.at("lanes").at("perfect_tracks").at("fitted").at("brier").is_null());
  // The same drive as a recording has the same detections and labels.
  ASSERT_EQ(call("fit-evidence drive_1 --vehicle demo --start zero --json r.json"), 0);
  const Json of_recordings = Json::parse(text("r.json"));
  EXPECT_EQ(of_tables.at("moving_detections"), of_recordings.at("moving_detections"));
  EXPECT_EQ(of_tables.at("real_share"), of_recordings.at("real_share"));
  EXPECT_EQ(of_tables.at("lanes").at("chain").at("base_rate"), of_recordings.at("lanes").at("chain").at("base_rate"));

  // With the true objects there are perfect tracks.
  std::string boxes = "t_s,id,class,x,y,yaw,length,width,vx,vy,parked\n";
  for (const Row& row : rows_of(text("drive_1/truth_objects.csv"))) {
    for (const char* const column : {"t_s", "object", "kind", "x_vehicle_m", "y_vehicle_m", "heading_rad", "length_m",
                                     "width_m", "vx_over_ground_mps", "vy_over_ground_mps"}) {
      boxes += row.at(column) + ",";
    }
    boxes += row.at("parked") + "\n";
  }
  write("foreign/boxes.csv", boxes);
  ASSERT_EQ(call("fit-evidence foreign --vehicle demo --start zero --json b.json"), 0) << text("stderr.txt");
  EXPECT_EQ(Json::parse(text("b.json")).at("lanes"), of_recordings.at("lanes"));
}

TEST_F(FitEvidenceCommand, LabelsOfTheMovingDetectionsOfARunSuffice) {
  for (const char* const file : {"radars.pcap", "ego.candump.log"})
    copy(std::string("drive_1/") + file, std::string("by_hand/") + file);
  ASSERT_EQ(call("run by_hand/radars.pcap by_hand/ego.candump.log --vehicle demo --quiet --out run_to_label"), 0);
  std::map<std::tuple<std::string, std::string, std::string>, bool> is_real;
  for (const Row& row : rows_of(text("drive_1/truth_detections.csv"))) {
    is_real[{row.at("radar"), row.at("scan"), row.at("index")}] = row.at("provenance") == "moving";
  }
  std::string labels = "t_s,radar,index,object,class\n";
  std::size_t real = 0, moving = 0;
  for (const Row& row : rows_of(text("run_to_label/detections.csv"))) {
    if (!row.at("rejected").empty() || row.at("origin") == "stationary" || row.at("origin") == "unknown") continue;
    const bool is = is_real.at({row.at("radar"), row.at("scan"), row.at("index")});
    real += is ? 1 : 0;
    ++moving;
    labels += row.at("t_s") + "," + row.at("radar") + "," + row.at("index") + (is ? ",1,car\n" : ",0,clutter\n");
  }
  write("by_hand/labels.csv", labels);
  ASSERT_EQ(call("fit-evidence by_hand --vehicle demo --json hand.json"), 0) << text("stderr.txt");
  const Json fit = Json::parse(text("hand.json"));
  EXPECT_EQ(fit.at("moving_detections").get<std::size_t>(), moving);
  EXPECT_NEAR(fit.at("real_share").get<double>(), static_cast<double>(real) / static_cast<double>(moving), 1e-12);
  EXPECT_EQ(fit.at("drives").at(0).at("scans_without_truth"), 0);
}

TEST_F(FitEvidenceCommand, AWrongDriveIsNamedAndNothingIsWritten) {
  const std::string vehicle = " --vehicle demo --statistics series_77ghz";
  EXPECT_THAT(problem("absent" + vehicle, 3), HasSubstr("absent: No such file or directory"));
  fs::create_directories(folder() / "empty");
  EXPECT_THAT(problem("drive_1 empty" + vehicle, 3), HasSubstr("empty: holds no drive"));
  for (const char* const file : {"radars.pcap", "ego.candump.log", "truth_detections.csv", "truth.csv"}) {
    copy(std::string("drive_1/") + file, std::string("bad/") + file);
  }
  fs::remove(folder() / "bad/truth_detections.csv");
  EXPECT_THAT(problem("bad" + vehicle, 3), HasSubstr("bad: is not labelled"));

  std::string labels = text("drive_1/truth_detections.csv");
  const std::size_t second = labels.find('\n', labels.find('\n') + 1) + 1;
  const std::size_t word = labels.find(",stationary,", second);
  ASSERT_NE(word, std::string::npos);
  std::string damaged = labels;
  damaged.replace(word, 12, ",standing,");
  write("bad/truth_detections.csv", damaged);
  EXPECT_THAT(problem("bad" + vehicle, 3),
              ::testing::AllOf(HasSubstr("truth_detections.csv:"), HasSubstr("provenance: read \"standing\"")));

  const auto all_as = [&](const std::string& provenance) {
    std::string header, rows;
    for (const Row& row : rows_of(labels)) {
      rows += row.at("t_s") + "," + row.at("radar") + "," + row.at("scan") + "," + row.at("index") + "," + provenance +
              "\n";
    }
    write("bad/truth_detections.csv", "t_s,radar,scan,index,provenance\n" + rows);
  };
  all_as("moving");
  EXPECT_THAT(problem("bad" + vehicle, 1), HasSubstr("all moving detections of the drives are real"));
  all_as("clutter");
  EXPECT_THAT(problem("bad" + vehicle, 1), HasSubstr("no moving detection of the drives is real"));
  write("bad/truth_detections.csv", "t_s,radar,scan,index,provenance\n1000,1,900,0,moving\n");
  EXPECT_THAT(problem("bad" + vehicle, 1),
              ::testing::AllOf(HasSubstr("scans with moving detections have no row in truth_detections.csv"),
                               HasSubstr("bad: has no labelled moving detection")));
  write("bad/detections.csv", "t_s\n");
  EXPECT_THAT(problem("bad" + vehicle, 3), HasSubstr("bad/ego.csv: No such file or directory"));
}

TEST_F(FitEvidenceCommand, AWrongCommandLineIsRefused) {
  EXPECT_EQ(call("fit-evidence drive_1 --vehicle demo --json"), 2);
  EXPECT_THAT(text("stderr.txt"), HasSubstr("only one result can go to standard output"));
  EXPECT_THAT(problem("drive_1 --vehicle demo --statistics absent_radar", 2), HasSubstr("absent_radar.toml"));
  write("old.toml", "name = \"old\"\n[evidence]\norigin = \"1 drive\"\n");
  EXPECT_THAT(problem("drive_1 --vehicle demo --statistics ./old.toml", 2),
              HasSubstr("evidence.prior_log_odds: is missing"));
  // Weights that cannot be read are no obstacle if the start needs none.
  EXPECT_EQ(call("fit-evidence drive_1 --vehicle demo --statistics ./old.toml --start zero --out old.toml"), 0)
      << text("stderr.txt");
  EXPECT_THAT(text("old.toml"),
              ::testing::AllOf(StartsWith("name = \"old\"\n[evidence]\n"), Not(HasSubstr("1 drive"))));
  std::string vehicle = schema_page::text_of(BORESIGHT_SOURCE_DIR "/config/vehicle/demo.toml");
  const std::string ideal = "statistics = \"ideal\"";
  ASSERT_NE(vehicle.find(ideal), std::string::npos);
  vehicle.replace(vehicle.find(ideal), ideal.size(), "statistics = \"series_77ghz\"");
  write("mixed.toml", vehicle);
  EXPECT_THAT(problem("drive_1 --vehicle ./mixed.toml", 2),
              HasSubstr("the radars of the vehicle have different profiles"));
}

}  // namespace
}  // namespace boresight::fit_evidence
