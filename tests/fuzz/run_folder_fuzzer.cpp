// Any text as the files of a run folder, as `boresight score` reads them. The input is the texts of two files: those of
// scans.csv and of another one. The first byte chooses the other one, a line feed and a zero byte end the first text.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "interfaces/messages/header.hpp"
#include "services/boresight/score/run_folder.hpp"
#include "services/boresight/score/truth_source.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace {

using namespace boresight;

/// The files of a run folder in memory.
struct Folder {
  fuzz::MemoryFolder folder;
  fuzz::MemoryFile scans, detections, tracks, alignment, health, run;
  Folder() {
    folder.link(scans, "scans.csv");
    folder.link(detections, "detections.csv");
    folder.link(tracks, "tracks.csv");
    folder.link(alignment, "alignment.csv");
    folder.link(health, "health.jsonl");
    folder.link(run, "run.json");
  }
};

/// Reads scans.csv and the rows of `Reader` that belong to each scan.
template <typename Reader, typename Row>
void read_with_scans(const std::filesystem::path& folder) {
  score::RunScans scans(folder);
  Reader reader(folder);
  score::RunScan scan;
  std::vector<Row> rows;
  while (scans.next(scan)) {
    fuzz::require(scan.radar >= 1 && scan.radar <= kMaxRadars && scan.detections <= kMaxDetections);
    static_cast<void>(score::truth_origin_ns(0.0, scan.time_ns, scan.t_s));
    reader.take(scan, rows);
  }
}

void read_alignment(const std::filesystem::path& folder) {
  score::RunAlignment alignment(folder);
  judge::AlignmentSample sample;
  for (std::int64_t time_ns = 0; alignment.next(sample, time_ns);) {
    fuzz::require(sample.radar >= 1 && sample.radar <= kMaxRadars && sample.rotation.allFinite());
    fuzz::require(std::isfinite(sample.speed_scale));
  }
}

void read_health(const std::filesystem::path& folder) {
  score::RunHealth health(folder);
  score::RunVerdicts verdicts;
  while (health.next(verdicts)) {
    fuzz::require(std::isfinite(verdicts.t_s));
    for (const auto& radar : verdicts.radars) fuzz::require(radar.radar >= 1 && radar.radar <= kMaxRadars);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static Folder files;
  const std::span<const std::uint8_t> texts(data + 1, size - 1);
  const auto middle = std::find(texts.begin(), texts.end(), 0);
  const auto length = static_cast<std::size_t>(middle - texts.begin());
  const std::span<const std::uint8_t> other = texts.subspan(std::min(length + 1, texts.size()));
  try {
    switch (data[0] % 5) {
      case 0:
        files.scans.fill(texts.first(length));
        files.detections.fill(other);
        read_with_scans<score::RunDetections, score::RunDetection>(files.folder.path());
        break;
      case 1:
        files.scans.fill(texts.first(length));
        files.tracks.fill(other);
        read_with_scans<score::RunTracks, judge::ScoredTrack>(files.folder.path());
        break;
      case 2:
        files.alignment.fill(texts);
        read_alignment(files.folder.path());
        break;
      case 3:
        files.health.fill(texts);
        read_health(files.folder.path());
        break;
      default:
        files.run.fill(texts);
        static_cast<void>(score::read_run_summary(files.folder.path()));
        break;
    }
  } catch (const score::InputError&) {
  }
  return 0;
}
