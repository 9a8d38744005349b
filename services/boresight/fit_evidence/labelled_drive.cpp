#include "services/boresight/fit_evidence/labelled_drive.hpp"

#include <algorithm>
#include <array>

#include "services/boresight/score/table.hpp"

namespace boresight::fit_evidence {

namespace fs = std::filesystem;

namespace {

bool is_recording(const fs::path& file) {
  constexpr std::array kExtensions = {".pcap", ".pcapng", ".log"};
  return std::find(kExtensions.begin(), kExtensions.end(), file.extension()) != kExtensions.end();
}

/// "drive" also for "drive/", "." and "..".
std::string name_of(const fs::path& folder) {
  const fs::path whole = fs::weakly_canonical(folder);
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

std::string seed_of(const fs::path& truth) {
  if (truth.empty()) return "";
  score::Table table(truth, {"quantity", "value"});
  while (table.next()) {
    if (table.text("quantity") == "seed") return std::string(table.text("value"));
  }
  return "";
}

}  // namespace

LabelledDrive find_labelled_drive(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw score::InputError(folder.string() +
                            (fs::exists(folder, error) ? ": is no folder of a drive" : ": No such file or directory"));
  }
  LabelledDrive drive{name_of(folder), "", folder, {}, {}, {}, {}};
  const fs::path detections = folder / "detections.csv", ego = folder / "ego.csv";
  if (fs::exists(detections) || fs::exists(ego)) {
    for (const fs::path& table : {detections, ego}) {
      if (!fs::exists(table)) throw score::InputError(table.string() + ": No such file or directory");
    }
    drive.detections = detections;
    drive.ego = ego;
  } else {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_regular_file() && is_recording(entry.path())) drive.recordings.push_back(entry.path());
    }
    if (drive.recordings.empty()) {
      throw score::InputError(folder.string() +
                              ": holds no drive; it needs recordings (*.pcap, *.pcapng, *.log), or detections.csv and "
                              "ego.csv");
    }
    std::sort(drive.recordings.begin(), drive.recordings.end());
  }
  drive.truth = score::find_truth(folder);
  if (drive.truth.detections.empty()) {
    throw score::InputError(folder.string() + ": is not labelled; it needs truth_detections.csv or labels.csv");
  }
  drive.seed = seed_of(drive.truth.drive);
  return drive;
}

}  // namespace boresight::fit_evidence
