// `boresight fit-evidence`: weights of the ghost filter's evidence from labelled drives of a radar.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/fit_evidence/fit.hpp"
#include "services/boresight/fit_evidence/report.hpp"
#include "services/boresight/fit_evidence/run_drive.hpp"
#include "services/boresight/fit_evidence/weights_text.hpp"
#include "services/boresight/run/settings.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/boresight/terminal/progress_bar.hpp"
#include "services/common/runtime/config/read_text.hpp"
#include "services/ghost_filter/weights_file.hpp"

namespace boresight {

namespace {

struct FitOptions {
  std::vector<std::string> drives;
  std::string start = "profile";
  std::string out, json;
  runtime::Configuration configuration;
};

class FitEvidence {
 public:
  FitEvidence(const FitOptions& options, const CLI::App& command)
      : options_(options), command_(command), bar_("fitting") {}

  int run() {
    for (const std::string& folder : options_.drives) drives_.push_back(fit_evidence::find_labelled_drive(folder));
    std::vector<std::string> names;
    for (const fit_evidence::LabelledDrive& drive : drives_) {
      vehicles_.push_back(options_.configuration.vehicle(drive.has_tables() ? config::VehicleUse::kOffline
                                                                            : config::VehicleUse::kLive));
      names.push_back(drive.folder.string());
    }
    profile_ = profile_file();
    const ghosts::EvidenceWeights start = start_weights();
    // The weights are those of the fit, so no radar's profile is read: it may lack them.
    settings_ = run::read_settings(options_.configuration, VehicleConfig{});
    settings_.ghosts.method = ghosts::MethodName::kEvidence;
    // Before the work, so that a wrong place is found at once.
    if (!options_.out.empty()) out_.emplace(options_.out);
    if (!options_.json.empty()) json_.emplace(options_.json);
    return report(fit(names, start));
  }

 private:
  /// The profile of all radars.
  [[nodiscard]] std::filesystem::path profile_file() const {
    const std::vector<RadarConfig>& radars = vehicles_.front().radars;
    const bool is_one = std::all_of(radars.begin(), radars.end(), [&](const RadarConfig& radar) {
      return radar.statistics == radars.front().statistics;
    });
    if (!is_one) throw UsageError("the radars of the vehicle have different profiles; name one by --statistics");
    return options_.configuration.radar_profile_file(radars.front().statistics);
  }

  [[nodiscard]] ghosts::EvidenceWeights start_weights() {
    config::Reader profile = config::Reader::open(profile_);
    if (options_.start == "zero") return {};
    if (profile.has("evidence")) return ghosts::read_weights(profile_);
    tell(profile_.string() + ": has no table [evidence]; the filter starts without weights");
    has_start_ = false;
    return {};
  }

  [[nodiscard]] fit_evidence::Fit fit(const std::vector<std::string>& names, const ghosts::EvidenceWeights& start) {
    try {
      return fit_evidence::fit_drives(names, start, [this](std::size_t drive, const ghosts::EvidenceWeights& weights) {
        return run_drive(drive, weights);
      });
    } catch (const fit_evidence::NoFit& error) {
      bar_.wipe();
      throw Finding(error.what());
    }
  }

  fit_evidence::DriveEvidence run_drive(std::size_t index, const ghosts::EvidenceWeights& weights) {
    const fit_evidence::LabelledDrive& drive = drives_[index];
    settings_.ghosts.evidence.weights = weights;
    // Each drive is read three times; the first time shows its problems.
    const bool is_first = runs_ < drives_.size();
    input::Problems problems([&](const std::string& problem) {
      if (!is_first) return;
      bar_.wipe();
      std::fprintf(stderr, "%s\n", problem.c_str());
    });
    const double all = 3.0 * static_cast<double>(drives_.size());
    fit_evidence::DriveRun run =
        fit_evidence::run_drive(drive, vehicles_[index], settings_, problems, [&](double share) {
          stop_if_interrupted();
          if (bar_.is_due()) bar_.show((static_cast<double>(runs_) + std::max(0.0, share)) / all, drive.name);
        });
    stop_if_interrupted();
    ++runs_;
    if (is_first) note(drive, run, problems);
    return std::move(run.evidence);
  }

  /// What the first run of a drive shows.
  void note(const fit_evidence::LabelledDrive& drive, const fit_evidence::DriveRun& run,
            const input::Problems& problems) {
    bar_.wipe();
    const std::string folder = drive.folder.string();
    fitted_.push_back({drive.name, drive.seed, folder, run.moving_scans, run.scans_without_truth,
                       run.evidence.detections(), run.evidence.real_detections(), run.evidence.has_objects()});
    if (problems.bad_lines() > 0) {
      const std::string text = fmt::format("{}: {} of {} {} were skipped", folder, problems.bad_lines(),
                                           problems.lines(), drive.has_tables() ? "lines" : "frames");
      tell_or_complain(problems.too_many(), problems.too_many() ? text + ": more than one in a hundred" : text);
    }
    if (run.lines_of_unknown_radars > 0) {
      complain(fmt::format("{}: {} lines are of radars that the vehicle does not have", folder,
                           run.lines_of_unknown_radars));
    }
    if (run.scans_without_truth > 0) {
      tell_or_complain(
          2 * run.scans_without_truth > run.moving_scans,
          fmt::format("{}: {} of {} scans with moving detections have no row in {}", folder, run.scans_without_truth,
                      run.moving_scans, drive.truth.detections.filename().string()));
    }
    if (run.scans_without_ego_motion > 0) {
      tell_or_complain(2 * run.scans_without_ego_motion > run.scans,
                       fmt::format("{}: {} of {} scans have no ego motion near their time", folder,
                                   run.scans_without_ego_motion, run.scans));
    }
  }

  int report(const fit_evidence::Fit& fit) {
    bar_.wipe();
    const std::string table = fit_evidence::weights_text(fit.weights, fit_evidence::origin_of(fit, fitted_));
    if (out_) {
      out_->write(fit_evidence::with_weights(config::read_text(profile_), table, profile_.string()));
      out_->commit();
    } else {
      if (!json_) std::fprintf(stderr, "%s", fit_evidence::to_text(fit, fitted_).c_str());
      terminal::print(table);
    }
    if (json_) {
      const bool has_start = has_start_ && options_.start == "profile";
      json_->write(fit_evidence::to_json(fit, fitted_, has_start ? profile_.string() : "", BORESIGHT_VERSION));
      json_->commit();
    }
    // Standard output is for one result.
    if (out_ && options_.out != "-" && options_.json != "-") {
      terminal::print(fit_evidence::to_text(fit, fitted_) + options_.out + "\n");
    }
    return exit_code_;
  }

  void tell(const std::string& text) const { report_problem(command_, text); }
  /// Something that makes the result doubtful.
  void complain(const std::string& text) {
    tell(text);
    exit_code_ = exit_code::kFinding;
  }
  void tell_or_complain(bool is_doubtful, const std::string& text) {
    if (is_doubtful) {
      complain(text);
    } else {
      tell(text);
    }
  }

  const FitOptions& options_;
  const CLI::App& command_;
  terminal::ProgressBar bar_;
  std::vector<fit_evidence::LabelledDrive> drives_;
  std::vector<VehicleConfig> vehicles_;  // by drive: tables need fewer keys
  std::filesystem::path profile_;
  run::Settings settings_;
  std::vector<fit_evidence::FittedDrive> fitted_;
  std::optional<terminal::OutputFile> out_, json_;
  std::size_t runs_ = 0;
  bool has_start_ = true;
  int exit_code_ = exit_code::kSuccess;
};

}  // namespace

void add_fit_evidence_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "fit-evidence", "Fits the weights of the ghost filter's evidence to labelled drives of a radar.");
  const auto options = std::make_shared<FitOptions>();
  command
      ->add_option("drives", options->drives,
                   "Folders of labelled drives: recordings, or detections.csv and ego.csv, with their truth")
      ->type_name("DRIVE")
      ->required();
  runtime::add_vehicle_option(*command, options->configuration,
                              "Vehicle: a name in the folder vehicle/, or a file. Tables need no links in it")
      ->required();
  runtime::add_config_option(*command, options->configuration);
  command
      ->add_option("--statistics", options->configuration.statistics,
                   "Radar profile whose weights are the start, and whose other tables --out keeps: a name in the "
                   "folder radar_profiles/, or a file; default: the one in the vehicle file")
      ->type_name("NAME|FILE");
  command->add_option("--start", options->start, "Weights of the first run: those of the profile, or none")
      ->check(CLI::IsMember({"profile", "zero"}))
      ->capture_default_str();
  command
      ->add_option("--out", options->out,
                   "File for the whole profile with the fitted table [evidence]; without it the table goes to "
                   "standard output, and the scores to standard error")
      ->type_name("FILE");
  add_json_option(*command, options->json, "Scores as JSON; without FILE, or with \"-\": to standard output");
  on_call(
      *command, exit_code,
      {"fit-evidence drive_1 drive_2 --vehicle demo --statistics series_77ghz --out my_radar.toml",
       "the weights were fitted",
       "no weights can be fitted: a drive has no labelled moving detection, or all are real or all false. Or the\n"
       "       weights are doubtful: more than one frame or line in a hundred was skipped, a radar is not in the\n"
       "       vehicle file, most scans with moving detections have no truth, or most scans have no ego motion.\n"
       "       They are written all the same"},
      [options, command] {
        if (options->json == "-" && (options->out.empty() || options->out == "-")) {
          throw UsageError("only one result can go to standard output; give --out FILE or --json FILE");
        }
        return FitEvidence(*options, *command).run();
      },
      &options->configuration);
}

}  // namespace boresight
