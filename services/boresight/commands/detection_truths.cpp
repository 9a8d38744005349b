#include "services/boresight/commands/detection_truths.hpp"

#include <fstream>

namespace boresight {

std::optional<report::DetectionTruths> detection_truths_beside(const std::filesystem::path& truth_file) {
  const std::filesystem::path folder = truth_file.parent_path();
  std::ifstream detections(folder / "truth_detections.csv"), objects(folder / "truth_objects.csv");
  if (!detections || !objects) return std::nullopt;
  return report::DetectionTruths{judge::read_true_scans(detections), judge::TrueObjects(objects)};
}

}  // namespace boresight
