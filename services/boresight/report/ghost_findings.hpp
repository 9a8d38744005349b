// How the ghost filter and the tracker of a run classified and tracked every detection, from the tables of its run
// folder; compared with the truth where it is known.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/boresight/report/summary.hpp"
#include "services/simulator/judge/confusion.hpp"
#include "services/simulator/judge/false_tracks.hpp"
#include "services/simulator/judge/truth_files.hpp"

namespace boresight::report {

/// The truth of every detection of a simulated drive.
struct DetectionTruths {
  judge::TrueScans scans;
  judge::TrueObjects objects;
};

/// What was published at one instant: the latest scan of each radar, the latest track list.
struct PlanView {
  struct Detection {
    std::uint32_t radar;
    float x_m, y_m;  ///< vehicle frame at its scan's time
    float range_rate_over_ground_mps;
    float ghost_probability;
    Provenance label;
    bool rejected;  ///< by the corrector
    std::optional<Provenance> truth;
  };
  struct Sensor {
    std::uint32_t radar;
    float x_m, y_m;
    double age_s;  ///< of its scan, against the latest scan
  };
  struct Box {
    std::uint32_t tracking_id;
    float x_m, y_m, heading_rad, length_m, width_m;
  };
  std::int64_t time_ns = 0;  ///< of measurement, of the latest scan
  std::vector<Detection> detections;
  std::vector<Sensor> sensors;
  std::vector<ReflectorSegment> segments;  ///< of the latest scan
  std::vector<Box> tracks;                 ///< confirmed ones
  double tracks_age_s = 0.0;               ///< of the track list, against the latest scan
  std::vector<judge::Object> objects;      ///< true objects; empty where the truth is not known
};

struct GhostFindings {
  bool is_recorded = false;        ///< whether the folder holds scans.csv
  std::uint64_t scans = 0;         ///< with a track list each
  std::int64_t first_scan_ns = 0;  ///< of measurement, of the earliest
  std::string problem;             ///< why the tables could not be read to their end; the rest is missing below
  PlanView most_ghosts;            ///< where most detections were classified as ghosts; empty if none ever was
  // With truth only:
  std::optional<std::int64_t> truth_begin_ns;  ///< time 0 of the truth on the clock of the tables
  std::optional<judge::Confusion> confusion;   ///< truth × label of all scans that were matched to the truth
  std::uint64_t compared_scans = 0;            ///< matched scans with detections
  std::uint64_t unknown_scans =
      0;  ///< others with detections: the truth has no scan of that time and number of detections
  std::vector<judge::GhostTrack> ghost_tracks;  ///< times on the clock of the tables
  std::size_t other_false_tracks = 0;           ///< of clutter, or of the stationary world
  /// Where most labels differ from the truth. In the first moments of a drive neither reflectors nor tracks are known,
  /// so most labels would differ there; only this view skips them.
  PlanView most_mistakes;
  static constexpr double kFirstMoments_s = 2.0;
};

/// Reads scans.csv, detections.csv, reflectors.csv and tracks.csv; nothing where there is no scans.csv. `truth` is null
/// where it is not known. `look` is called now and then, and may end the reading by an exception.
[[nodiscard]] GhostFindings find_ghosts(const std::filesystem::path& folder, const DetectionTruths* truth,
                                        const std::function<void()>& look = {});

/// What a filter must reach on a drive with truth: the bars of the ghost filter's scenarios (docs/ghosts.md).
struct GhostBars {
  static constexpr double kMovingClassifiedMoving_percent = 97.0;
  static constexpr double kGhostsClassifiedGhosts_percent = 90.0;  ///< of each type
  static constexpr double kScansCompared_percent = 99.0;
};
/// Checks: the tables are whole, and their scans are those of the truth. The bars are aims, because one drive may miss
/// what the median of many drives reaches. Without truth only the first check; empty where nothing was recorded.
[[nodiscard]] std::vector<Check> ghost_checks(const GhostFindings& findings);

}  // namespace boresight::report
