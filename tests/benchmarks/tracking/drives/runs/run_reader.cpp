#include "tests/benchmarks/tracking/drives/runs/run_reader.hpp"

#include <optional>
#include <utility>

#include "services/boresight/score/truth_source.hpp"
#include "services/common/estimation/unknown.hpp"

namespace boresight::bench::tracking {

namespace fs = std::filesystem;

namespace {

/// Time of the run at which the clock of the truth is 0.
std::int64_t truth_origin(const fs::path& run, const score::TruthSource& truth, const score::RunScan& first) {
  std::optional<std::int64_t> stated_ns;
  if (fs::exists(run / "run.json")) stated_ns = score::read_run_summary(run).truth_begin_ns;
  if (stated_ns) return *stated_ns;
  return score::truth_origin_ns(score::first_time_s(truth).value_or(0.0), first.time_ns, first.t_s);
}

}  // namespace

RunReader::RunReader(const fs::path& run, const fs::path& truth, std::string score_column)
    : car_(score::read_car_truth(score::find_truth(truth).drive)),
      lists_(run, std::move(score_column)),
      objects_(score::find_truth(truth).objects, score::find_truth(truth).objects_are_boxes,
               score::find_truth(truth).visibility) {
  has_list_ = lists_.next();
  if (has_list_) origin_ns_ = truth_origin(run, score::find_truth(truth), lists_.scan());
}

bool RunReader::next(Scene& scene) {
  for (; has_list_; has_list_ = lists_.next()) {
    scene.tracks = lists_.tracks();
    const score::RunScan& scan = lists_.scan();
    scene.t_s = 1e-9 * static_cast<double>(scan.time_ns - origin_ns_) - car_.stamp_offset_s(scan.radar);
    if (!objects_.at(scene.t_s, scene.objects)) continue;
    has_list_ = lists_.next();
    return true;
  }
  return false;
}

double tracker_ms_per_scan(const fs::path& run, std::size_t scans) {
  if (!fs::exists(run / "run.json") || scans == 0) return kNaN;
  for (const auto& [name, value] : score::read_run_summary(run).timing) {
    if (name == "cpu_s_by_stage.tracker") return 1e3 * value / static_cast<double>(scans);
  }
  return kNaN;
}

}  // namespace boresight::bench::tracking
