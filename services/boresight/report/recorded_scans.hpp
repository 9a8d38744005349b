// The scans of a run folder (config/schema/run.md) as messages, with their detections, reflectors and confirmed tracks.
#pragma once

#include <filesystem>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/boresight/score/run_folder.hpp"

namespace boresight::report {

/// The four tables together. All members throw score::InputError.
class RecordedScans {
 public:
  explicit RecordedScans(const std::filesystem::path& folder);
  /// The next scan and the confirmed tracks after it. Fields that the tables do not contain are 0.
  [[nodiscard]] bool next(ClassifiedScan& scan, TrackList& tracks);

 private:
  score::RunScans scans_;
  score::RunDetections detections_;
  score::RunReflectors reflectors_;
  score::RunTracks tracks_;
  std::vector<score::RunDetection> detection_rows_;
  std::vector<ReflectorSegment> reflector_rows_;
  std::vector<score::RunTrack> track_rows_;
};

}  // namespace boresight::report
