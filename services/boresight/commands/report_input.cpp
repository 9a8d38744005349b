#include "services/boresight/commands/report_input.hpp"

#include <stdexcept>

#include "services/boresight/commands/detection_truths.hpp"
#include "services/boresight/commands/run_command.hpp"

namespace boresight {

void read_run_folder(const std::filesystem::path& folder, const std::filesystem::path& truth_file,
                     report::ReportInput& input) {
  if (!std::filesystem::exists(folder)) throw std::runtime_error(folder.string() + ": No such file or directory");
  const std::string snapshots = (folder / "monitor.jsonl").string();
  InputFile lines(snapshots);
  monitor::DamagedLines damaged;
  input.snapshots = monitor::read_snapshots(lines, snapshots, damaged);
  const auto truths = truth_file.empty() ? std::nullopt : detection_truths_beside(truth_file);
  input.ghosts = report::find_ghosts(folder, truths ? &*truths : nullptr, stop_if_interrupted);
  const std::vector<report::Check> checks = report::ghost_checks(input.ghosts);
  input.more_checks.insert(input.more_checks.end(), checks.begin(), checks.end());
  input.more_checks.push_back(report::record_check("file monitor.jsonl", damaged));
}

}  // namespace boresight
