#include "services/boresight/commands/report_input.hpp"

#include <stdexcept>
#include <utility>

#include "services/boresight/commands/detection_truths.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/report/run_snapshots.hpp"

namespace boresight {

void read_run_folder(const std::filesystem::path& folder, const std::filesystem::path& truth_file,
                     report::ReportInput& input) {
  if (!std::filesystem::exists(folder)) throw std::runtime_error(folder.string() + ": No such file or directory");
  const std::string snapshots = (folder / "monitor.jsonl").string();
  const bool is_live = std::filesystem::exists(snapshots);
  if (!is_live && !std::filesystem::exists(folder / "scans.csv")) {
    throw std::runtime_error(folder.string() + ": holds neither monitor.jsonl nor scans.csv, so it is no run folder");
  }
  if (is_live) {
    InputFile lines(snapshots);
    monitor::DamagedLines damaged;
    input.snapshots = monitor::read_snapshots(lines, snapshots, damaged);
    input.more_checks.push_back(report::record_check("file monitor.jsonl", damaged));
  } else {
    report::RunSnapshots of_run = report::snapshots_of_run(folder, input.vehicle, stop_if_interrupted);
    input.snapshots = std::move(of_run.snapshots);
    input.more_checks.push_back(report::run_check(of_run));
  }
  const auto truths = truth_file.empty() ? std::nullopt : detection_truths_beside(truth_file);
  input.ghosts = report::find_ghosts(folder, truths ? &*truths : nullptr, stop_if_interrupted);
  const std::vector<report::Check> checks = report::ghost_checks(input.ghosts);
  input.more_checks.insert(input.more_checks.end(), checks.begin(), checks.end());
}

}  // namespace boresight
