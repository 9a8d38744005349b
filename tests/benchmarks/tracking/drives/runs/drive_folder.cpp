#include "tests/benchmarks/tracking/drives/runs/drive_folder.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/tracking/common/baseline_run.hpp"
#include "tests/benchmarks/tracking/drives/perfect/perfect_run.hpp"
#include "tests/benchmarks/tracking/drives/runs/process.hpp"
#include "tests/benchmarks/tracking/drives/runs/run_reader.hpp"

namespace boresight::bench::tracking {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRecording = "radars.pcap";
constexpr const char* kEgo = "ego.candump.log";
constexpr int kDoubtful = 1;  // exit code of `boresight run`; its results are written all the same

/// Of the name of a drive's folder, what follows the seed.
std::string length_in_name(const DriveSpec& drive) {
  return drive.longest_s > 0.0 ? fmt::format("_{:g}s", drive.longest_s) : std::string();
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A drive that is simulated again must be the one that the runs beside it saw.
void require_same_truth(const fs::path& before, const fs::path& now) {
  for (const char* const table : {"truth_objects.csv", "truth_visibility.csv"}) {
    if (text_of(before / table) == text_of(now / table)) continue;
    throw std::runtime_error(before.string() + ": another simulator made this drive; delete the folder above it");
  }
}

class DriveFolder {
 public:
  DriveFolder(const DriveSetup& setup, const DriveSpec& drive)
      : setup_(setup), drive_(drive), folder_(folder_of(setup, drive)), log_(folder_ / "log.txt") {
    fs::create_directories(folder_);
  }

  void simulate_if_missing() const {
    const fs::path drive = folder_ / "drive", fresh = folder_ / "drive.new";
    if (fs::exists(drive / kRecording)) return;
    std::vector<std::string> words = {boresight(),  "simulate",
                                      "--scenario", drive_.scenario,
                                      "--profile",  drive_.profile,
                                      "--seed",     std::to_string(drive_.seed),
                                      "--config",   setup_.config.string(),
                                      "--vehicle",  setup_.vehicle,
                                      "--out",      fresh.string()};
    if (drive_.longest_s > 0.0) {
      const double duration_s = std::min(drive_.longest_s, simulator::scenario(drive_.scenario).duration_s);
      words.insert(words.end(), {"--duration", fmt::format("{:g}", duration_s)});
    }
    run_program(words, log_, {0});
    if (fs::exists(drive)) require_same_truth(drive, fresh);
    fs::remove_all(drive);
    fs::rename(fresh, drive);
  }

  [[nodiscard]] fs::path run(const std::string& tracker) const {
    fs::path folder = folder_ / ("run_" + tracker);
    if (fs::exists(folder / "run.json") && !setup_.runs_again) return folder;
    if (tracker == kPerfectTracker) {
      make_perfect_run(folder);
    } else {
      make_run(tracker, folder);
    }
    return folder;
  }

  [[nodiscard]] fs::path baseline(std::size_t min_points) const {
    fs::path folder = folder_ / fmt::format("baseline_{}", min_points);
    if (fs::exists(folder)) return folder;
    // All runs have the same detections; only one that has its table is needed.
    fs::path run_folder = folder_ / ("run_" + setup_.trackers.front());
    if (!fs::exists(run_folder / "detections.csv")) {
      run_folder = folder_ / "run_for_baselines";
      if (!fs::exists(run_folder / "run.json")) make_run(kDefaultTracker, run_folder);
    }
    const fs::path fresh = folder_ / fmt::format("baseline_{}.new", min_points);
    BaselineSettings settings;
    settings.cluster_min_points = min_points;
    run_baseline(run_folder, setup_.baseline_vehicle, fresh, settings);
    fs::rename(fresh, folder);
    return folder;
  }

 private:
  [[nodiscard]] std::string boresight() const { return (setup_.programs / "boresight").string(); }

  void make_run(const std::string& tracker, const fs::path& folder) const {
    simulate_if_missing();
    const fs::path drive = folder_ / "drive", fresh = folder.string() + ".new";
    const bool is_unfiltered = tracker == kUnfilteredTracker;
    std::vector<std::string> words = {boresight(),
                                      "run",
                                      (drive / kRecording).string(),
                                      (drive / kEgo).string(),
                                      "--config",
                                      (is_unfiltered ? setup_.unfiltered : setup_.config).string(),
                                      "--vehicle",
                                      setup_.vehicle,
                                      "--statistics",
                                      drive_.profile,
                                      "--out",
                                      fresh.string(),
                                      "--quiet"};
    if (tracker != kDefaultTracker && !is_unfiltered) words.insert(words.end(), {"--tracker", tracker});
    run_program(words, log_, {0, kDoubtful});
    fs::remove_all(folder);
    fs::rename(fresh, folder);
  }

  void make_perfect_run(const fs::path& folder) const {
    simulate_if_missing();
    const fs::path drive = folder_ / "drive", fresh = folder.string() + ".new";
    fs::remove_all(fresh);
    runtime::Configuration configuration;
    configuration.directory = setup_.config;
    configuration.vehicle_name = setup_.vehicle;
    configuration.statistics = drive_.profile;
    run_with_true_origins({drive / kRecording, drive / kEgo}, drive, configuration, fresh);
    fs::remove_all(folder);
    fs::rename(fresh, folder);
  }

  const DriveSetup& setup_;
  const DriveSpec& drive_;
  fs::path folder_, log_;
};

}  // namespace

void write_unfiltered_config(const fs::path& config, const fs::path& copy) {
  fs::remove_all(copy);
  fs::copy(config, copy, fs::copy_options::recursive);
  const fs::path file = copy / "services/tracker.toml";
  std::string text = text_of(file);
  const std::string key = "\norigin_weight = ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) throw std::runtime_error(file.string() + ": no line \"origin_weight = …\"");
  const std::size_t begin = at + key.size();
  text.replace(begin, text.find_first_of(" \n", begin) - begin, "0.0");
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

std::string name_of(const std::string& name_or_file) {
  return fs::path(name_or_file).stem().string();
}

fs::path folder_of(const DriveSetup& setup, const DriveSpec& drive) {
  return setup.place / name_of(drive.profile) /
         fmt::format("{}_{}{}", name_of(drive.scenario), drive.seed, length_in_name(drive));
}

std::vector<std::uint64_t> seeds_there(const DriveSetup& setup, const DriveSpec& drive) {
  std::vector<std::uint64_t> seeds;
  const fs::path of_profile = setup.place / name_of(drive.profile);
  const std::string begin = name_of(drive.scenario) + "_", end = length_in_name(drive);
  if (!fs::is_directory(of_profile)) return seeds;
  for (const fs::directory_entry& entry : fs::directory_iterator(of_profile)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(end) || name.size() <= begin.size() + end.size()) continue;
    const std::string digits = name.substr(begin.size(), name.size() - begin.size() - end.size());
    std::uint64_t seed = 0;
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seed);
    if (error == std::errc{} && rest == digits.data() + digits.size()) seeds.push_back(seed);
  }
  std::sort(seeds.begin(), seeds.end());
  return seeds;
}

std::vector<NamedRun> make_runs(const DriveSetup& setup, const DriveSpec& drive) {
  const DriveFolder folder(setup, drive);
  if (!fs::exists(folder_of(setup, drive) / "drive/truth_objects.csv")) folder.simulate_if_missing();
  std::vector<NamedRun> runs;
  for (const std::string& tracker : setup.trackers) runs.push_back({tracker, folder.run(tracker), kExistenceColumn});
  for (const std::size_t min_points : setup.baselines) {
    runs.push_back({fmt::format("baseline {}+", min_points), folder.baseline(min_points), kHitsColumn});
  }
  return runs;
}

void trim(const DriveSetup& setup, const DriveSpec& drive) {
  if (setup.keeps_all) return;
  const fs::path folder = folder_of(setup, drive);
  for (const char* const file : {kRecording, kEgo, "truth_detections.csv"}) fs::remove(folder / "drive" / file);
  fs::remove_all(folder / "run_for_baselines");
  for (const std::string& tracker : setup.trackers) {
    for (const char* const file : {"detections.csv", "reflectors.csv"}) {
      fs::remove(folder / ("run_" + tracker) / file);
    }
  }
}

}  // namespace boresight::bench::tracking
