#include "services/boresight/commands/detection_truths.hpp"

#include <filesystem>

#include "services/boresight/commands/run_command.hpp"

namespace boresight {

std::optional<report::DetectionTruths> detection_truths_beside(const std::filesystem::path& truth_file) {
  const std::filesystem::path folder = truth_file.parent_path();
  const std::filesystem::path detections_file = folder / "truth_detections.csv",
                              objects_file = folder / "truth_objects.csv";
  std::error_code ignored;
  if (!std::filesystem::exists(detections_file, ignored) || !std::filesystem::exists(objects_file, ignored)) {
    return std::nullopt;
  }
  InputFile detections(detections_file.string()), objects(objects_file.string());
  return report::DetectionTruths{judge::read_true_scans(detections), judge::TrueObjects(objects)};
}

}  // namespace boresight
