// `boresight demo`: a drive through the whole pipeline, process by process, watched, judged and cleaned up after.
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "deploy/roudi/pools.hpp"
#include "deploy/supervisor/domain.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/report_input.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/commands/simulate_drive.hpp"
#include "services/boresight/report/html_report.hpp"
#include "services/boresight/report/truth_table.hpp"
#include "services/boresight/run/summary.hpp"
#include "services/boresight/run/writer.hpp"
#include "services/boresight/score/mounting_truth.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kReadyTimeout_ns = 30'000'000'000;
// From the last frame to the last snapshot that contains its effect: two periods of the monitor's record.
constexpr std::int64_t kLinger_ns = 1'000'000'000;
constexpr const char* kSimulatedVehicle = "demo";
constexpr int kReplayLostScans = exit_code::kFinding;  // of boresight-replay --speed max

struct DemoOptions {
  runtime::Configuration configuration;
  std::vector<std::string> recordings;
  std::string truth;  ///< folder of the truth of the recordings
  double duration_s = 0.0;
  std::string speed = "1";  ///< factor, or "max"
  fs::path output = "demo_output";
};

fs::path own_program() {
  return fs::read_symlink("/proc/self/exe");
}

/// The recordings that are played, and the truth that is known about them.
struct Drive {
  std::string title;
  std::vector<std::string> recordings;
  fs::path truth_file;  ///< truth.csv; empty where no truth is known
  report::Truth truth;
};

/// Whether the truth of each radar is beyond the tolerance that health uses, sometime and at the end of the drive.
std::map<std::uint32_t, report::TrueMisalignment> true_misalignments(const fs::path& folder,
                                                                     const VehicleConfig& vehicle, double duration_s) {
  const score::TruthSource source = score::find_truth(folder);
  score::MountingTruthReader mountings(source, vehicle);
  std::map<std::uint32_t, report::TrueMisalignment> misaligned;
  const auto judge = [&](double t_s) {
    for (const RadarConfig& radar : vehicle.radars) {
      const std::optional<bool> is_misaligned = mountings.is_misaligned(radar.id, t_s);
      if (!is_misaligned) continue;
      report::TrueMisalignment& seen = misaligned[radar.id];
      seen.at_end = *is_misaligned;
      seen.ever = seen.ever || *is_misaligned;
    }
  };
  judge(0.0);
  if (source.sensors.empty()) return misaligned;
  score::Table sensors(source.sensors, {"t_s"});
  constexpr double kLatest_s = 4e9;  // seconds since the epoch are allowed, too
  while (sensors.next()) {
    stop_if_interrupted();
    const double t_s = sensors.number("t_s", -kLatest_s, kLatest_s);
    if (duration_s > 0.0 && t_s > duration_s) break;
    judge(t_s);
  }
  return misaligned;
}

report::Truth read_truth(const fs::path& truth_file, const VehicleConfig& vehicle, double duration_s) {
  InputFile file(truth_file.string());
  report::Truth truth = report::truth_of(read_drive_truth(file), vehicle);
  if (!truth.known()) throw std::runtime_error("there is no truth in " + truth_file.string());
  truth.misaligned = true_misalignments(truth_file.parent_path(), vehicle, duration_s);
  return truth;
}

Drive simulated_drive(const DemoOptions& options, const VehicleConfig& vehicle) {
  const fs::path directory = options.output / "drive";
  const simulator::Scenario scenario = simulator::scenario("demo_drive");
  terminal::print("simulating a drive\n");
  constexpr std::uint64_t kSeed = 1;
  static_cast<void>(write_simulated_drive(
      scenario, vehicle, kSeed, options.duration_s > 0.0 ? options.duration_s : scenario.duration_s, directory));
  Drive drive{.title = "simulated drive", .recordings = {}, .truth_file = directory / "truth.csv", .truth = {}};
  drive.truth = read_truth(drive.truth_file, vehicle, 0.0);
  for (const char* file : {"radars.pcap", "ego.candump.log"}) drive.recordings.push_back((directory / file).string());
  return drive;
}

Drive recorded_drive(const DemoOptions& options, const VehicleConfig& vehicle) {
  Drive drive;
  for (const std::string& file : options.recordings) {
    InputFile readable(file);  // before anything is started
    drive.recordings.push_back(fs::absolute(file).string());
    drive.title += (drive.title.empty() ? "" : ", ") + fs::path(file).filename().string();
  }
  if (options.truth.empty()) return drive;
  drive.truth_file = fs::absolute(fs::path(options.truth) / "truth.csv");
  drive.truth = read_truth(drive.truth_file, vehicle, options.duration_s);
  // The number of scans is that of the whole drive.
  if (options.duration_s > 0.0) drive.truth.scans.clear();
  return drive;
}

supervisor::ProcessSpec monitor_of(const DemoOptions& options, const fs::path& run_folder) {
  supervisor::ProcessSpec spec;
  spec.name = "monitor";
  spec.command.arguments = {own_program().string(),
                            "monitor",
                            "--config",
                            options.configuration.directory.string(),
                            "--vehicle",
                            options.configuration.vehicle_name,
                            "--record",
                            run_folder.string()};
  spec.role = supervisor::Role::kSpectator;
  spec.shares_terminal = true;
  return spec;
}

supervisor::ProcessSpec replay_of(const DemoOptions& options, const Drive& drive, const fs::path& binaries,
                                  const fs::path& run_directory) {
  supervisor::ProcessSpec spec;
  spec.name = "replay";
  spec.command.arguments = {(binaries / "boresight-replay").string(), "--speed", options.speed};
  // A simulated drive already has the wanted duration. To cut it again would lose the datagrams that arrive just after
  // its end.
  if (options.duration_s > 0.0 && !options.recordings.empty()) {
    spec.command.arguments.insert(spec.command.arguments.end(), {"--duration", fmt::format("{}", options.duration_s)});
  }
  spec.command.arguments.insert(spec.command.arguments.end(), drive.recordings.begin(), drive.recordings.end());
  spec.command.environment = {{"BORESIGHT_RUNTIME_DIR", run_directory.string()}};
  spec.role = supervisor::Role::kIndependent;
  return spec;
}

/// A service that refuses its configuration once will refuse it again, so the demo does not wait for it.
void throw_if_refused(const supervisor::Supervisor& domain, const fs::path& logs) {
  for (const supervisor::Event& event : domain.events()) {
    const bool refused = event.kind == supervisor::EventKind::kExited && event.detail == "exit code 2";
    const std::string problem =
        event.process + " cannot run: " + event.detail + "; see " + (logs / (event.process + ".log")).string();
    if (refused) throw config::Error(problem);
    if (event.kind == supervisor::EventKind::kStartFailed) throw std::runtime_error(problem);
  }
}

struct Played {
  std::vector<supervisor::Event> events;  ///< of the supervisor
  bool has_losses = false;                ///< reported by the replay
};

/// Plays the drive through a fresh domain. Whatever happens, the domain is gone after.
Played play(const DemoOptions& options, const Drive& drive, const fs::path& logs, const fs::path& run_folder) {
  const auto segments = roudi::single_segment();
  if (const auto shortage = supervisor::shared_memory_shortage(roudi::total_bytes(segments), "/dev/shm")) {
    throw std::runtime_error(*shortage);
  }
  const fs::path pools = logs / "roudi.toml";
  terminal::write_file(pools, roudi::to_toml(segments));
  supervisor::DomainOptions domain_options{.binaries = supervisor::binaries_folder(),
                                           .config_directory = options.configuration.directory,
                                           .vehicle = options.configuration.vehicle_name,
                                           .run_directory = supervisor::unused_run_directory(),
                                           .log_directory = logs,
                                           .environment = {{"BORESIGHT_INPUT", "replay"}}};
  // The estimator compares its key figures with the truth.
  if (!drive.truth_file.empty()) domain_options.environment.emplace_back("BORESIGHT_TRUTH", drive.truth_file.string());
  supervisor::DomainConfig config = supervisor::domain_of_catalogue(domain_options, pools);
  config.services.push_back(monitor_of(options, run_folder));

  terminal::print(fmt::format("starting RouDi and {} services; their output is in {}\n",
                              catalogue::kNumberOfSupervisedServices, logs.string()));
  supervisor::Supervisor domain(config);
  domain.start([] { return runtime::stop_signalled(); });
  const std::int64_t deadline_ns = runtime::monotonic_now_ns() + kReadyTimeout_ns;
  while (!domain.all_ready()) {
    domain.poll(20'000'000);
    stop_if_interrupted();
    throw_if_refused(domain, logs);
    if (runtime::monotonic_now_ns() > deadline_ns) {
      throw Finding("not every service became ready; see " + logs.string());
    }
  }
  domain.start_independent(replay_of(options, drive, domain_options.binaries, domain_options.run_directory));
  while (!domain.independent_result("replay")) {
    domain.poll(50'000'000);
    stop_if_interrupted();
  }
  const std::int64_t end_ns = runtime::monotonic_now_ns() + kLinger_ns;
  while (runtime::monotonic_now_ns() < end_ns) {
    domain.poll(50'000'000);
    stop_if_interrupted();
  }
  const int status = *domain.independent_result("replay");
  Played played{.events = domain.events(), .has_losses = status == kReplayLostScans};
  domain.stop();
  if (status != 0 && !played.has_losses) {
    throw Finding("the replay failed with " + supervisor::describe_exit(status) + "; see " +
                  (logs / "replay.log").string());
  }
  return played;
}

/// "4 × real time"; empty for real time.
std::string pace_of(const std::string& speed) {
  if (speed == "max") return "as fast as the pipeline takes the scans";
  return std::stod(speed) == 1.0 ? "" : speed + " × real time";
}

/// Processes that ended while the drive was played, which the health service cannot see.
report::Check check_of_processes(const std::vector<supervisor::Event>& events) {
  const auto count = std::count_if(events.begin(), events.end(), [](const supervisor::Event& event) {
    return event.kind == supervisor::EventKind::kExited && event.process != "replay";
  });
  return {fmt::format("no process ended by itself ({} did)", count), count == 0, false};
}

std::vector<std::string> event_lines(const std::vector<supervisor::Event>& events) {
  std::vector<std::string> lines;
  for (const supervisor::Event& event : events) {
    lines.push_back(
        fmt::format("{:9.3f} s  {:<15}{:<22}{}", static_cast<double>(event.time_ns - events.front().time_ns) * 1e-9,
                    supervisor::name_of(event.kind), event.process.empty() ? "domain" : event.process, event.detail));
  }
  return lines;
}

/// Processes append to their logs, so the logs of an earlier demo are removed. Other files in the folder are the
/// user's.
void remove_earlier_logs(const fs::path& logs) {
  std::vector<std::string> names = {"roudi", "monitor", "replay", "simulate"};
  names.insert(names.end(), catalogue::kServiceNames.begin(), catalogue::kServiceNames.end());
  for (const std::string& name : names) fs::remove(logs / (name + ".log"));
}

/// The monitor would continue an earlier record.
void remove_earlier_run(const fs::path& folder) {
  for (const std::string_view name : run::kFileNames) fs::remove(folder / name);
  for (const char* const name : {"monitor.jsonl", "run.json"}) fs::remove(folder / name);
}

int run_demo(DemoOptions options) {
  const bool simulated = options.recordings.empty();
  if (simulated && !options.truth.empty()) throw UsageError("--truth belongs to --recording");
  if (simulated && options.configuration.vehicle_name.empty()) options.configuration.vehicle_name = kSimulatedVehicle;
  report::ReportInput input;
  input.vehicle = options.configuration.vehicle();  // a wrong configuration is reported before anything starts
  // A file, so that every process finds it from any working directory.
  options.configuration.vehicle_name = fs::absolute(options.configuration.vehicle_file()).string();
  options.configuration.directory = fs::absolute(options.configuration.directory);
  options.output = fs::absolute(options.output);
  const fs::path logs = options.output / "logs";
  const fs::path run_folder = options.output / "run";
  std::error_code error;
  fs::create_directories(logs, error);
  if (error) throw terminal::OutputError(logs.string(), error.value());
  remove_earlier_logs(logs);
  const fs::path page = options.output / "report.html";
  fs::remove(page);
  remove_earlier_run(run_folder);

  const Drive drive = simulated ? simulated_drive(options, input.vehicle) : recorded_drive(options, input.vehicle);
  const Played played = play(options, drive, logs, run_folder);

  input.title = drive.title + ", vehicle " + input.vehicle.name;
  input.truth = drive.truth;
  input.events = event_lines(played.events);
  input.pace = pace_of(options.speed);
  read_run_folder(run_folder, drive.truth_file, input);
  if (input.ghosts.truth_begin_ns) {
    InputFile run_json((run_folder / "run.json").string());
    const std::string text{std::istreambuf_iterator<char>(run_json), std::istreambuf_iterator<char>()};
    terminal::write_file(run_folder / "run.json", run::with_truth_begin(text, *input.ghosts.truth_begin_ns));
  }
  input.more_checks.push_back(check_of_processes(played.events));
  if (options.speed == "max") {
    input.more_checks.push_back(
        {"every scan came back as a track list (see " + (logs / "replay.log").string() + ")", !played.has_losses});
  }
  report::Summary summary = report::summarise(input.snapshots, input.truth);
  summary.pace = input.pace;
  summary.checks.insert(summary.checks.end(), input.more_checks.begin(), input.more_checks.end());
  const std::string html = report::render_html(input);
  stop_if_interrupted();
  terminal::write_file(page, html);
  terminal::print(report::render_summary(summary) + "\n  report: " + page.string() + "\n");
  return summary.all_passed() ? exit_code::kSuccess : exit_code::kFinding;
}

}  // namespace

void add_demo_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "demo", "Plays a drive through every process of the pipeline, shows it live, and judges the result.");
  auto options = std::make_shared<DemoOptions>();
  command
      ->add_option("--recording", options->recordings,
                   "candump log or pcap capture of a drive; repeatable; default: a simulated drive")
      ->type_name("FILE");
  command
      ->add_option("--truth", options->truth,
                   "Folder of `boresight simulate` with the truth of the recordings; the run is compared with it")
      ->type_name("DIR");
  command
      ->add_option("--speed", options->speed,
                   "Factor on the recorded speed, or max: as fast as the pipeline takes the scans")
      ->check(CLI::Range(0.01, 1000.0) | CLI::IsMember({"max"}))
      ->type_name("FACTOR")
      ->capture_default_str();
  runtime::add_config_option(*command, options->configuration);
  runtime::add_vehicle_option(*command, options->configuration)->envname("BORESIGHT_VEHICLE");
  command->add_option("--duration", options->duration_s, "Plays so many seconds of the drive; 0: all of it")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  command
      ->add_option("--out", options->output, "Folder for the report, the run folder, the logs and the simulated drive")
      ->type_name("DIR")
      ->capture_default_str();
  on_call(
      *command, exit_code,
      {"demo --duration 20\n"
       "demo --vehicle demo --recording drive/radars.pcap --recording drive/ego.candump.log --truth drive --speed max",
       "every check passed", "a check failed, or a process of the pipeline failed"},
      [options] { return run_demo(*options); }, &options->configuration);
}

}  // namespace boresight
