#include "tests/benchmarks/tracking/drives/perfect/perfect_run.hpp"

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/boresight/run/chain.hpp"
#include "services/boresight/run/gateway_feed.hpp"
#include "services/boresight/run/settings.hpp"
#include "services/boresight/run/writer.hpp"
#include "services/boresight/score/truth_clock.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"
#include "services/tracker/core/make_tracker.hpp"
#include "tests/benchmarks/tracking/drives/perfect/true_origins.hpp"

namespace boresight::bench::tracking {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTimesFile = "step_times.csv";
constexpr double kMillisecondsPerNanosecond = 1e-6;

/// What the truth says about the scans of a run.
class OriginsOfScans {
 public:
  explicit OriginsOfScans(const fs::path& truth)
      : source_(score::find_truth(truth)),
        clock_(source_),
        origins_(source_.detections, source_.detections_are_labels) {}

  void set(const run::ScanResult& result, ClassifiedScan& scan) {
    if (!clock_.has_begun()) clock_.begin(result.at.time_ns, 1e-6 * static_cast<double>(result.at.since_start_us()));
    const std::uint32_t radar = result.scan.header.source_id;
    const double t_s = clock_.measured_s(radar, result.at.time_ns);
    const auto* const origins = origins_.find(radar, t_s, result.number, scan.number_of_valid_detections);
    if (origins == nullptr) throw std::runtime_error(fmt::format("radar {}, scan {}: no truth", radar, result.number));
    set_true_origins(*origins, scan);
  }

 private:
  score::TruthSource source_;
  score::TruthClock clock_;
  score::DetectionTruth origins_;
};

class PerfectRun {
 public:
  PerfectRun(const VehicleConfig& vehicle, const run::Settings& settings, const fs::path& truth, const fs::path& out)
      : vehicle_(vehicle),
        origins_(truth),
        tracker_(boresight::tracking::make_tracker(settings.tracker.tracker, vehicle, settings.tracker)),
        out_(out),
        scans_(out / "scans.csv"),
        tracks_file_(out / "tracks.csv"),
        times_(out / kTimesFile),
        writer_([this](run::File file, std::string_view text) { put(file, text); }, vehicle),
        chain_(std::make_unique<run::Chain>(
            vehicle, settings, run::Listeners{[this](const run::ScanResult& result) { add(result); }, {}, {}},
            runtime::thread_cpu_time_ns)) {
    fmt::print(times_, "filtered_ms,perfect_ms\n");
  }

  void play(const std::vector<fs::path>& recordings) {
    const auto reader =
        recording::open_recordings(recordings, [](const std::string& problem) { throw std::runtime_error(problem); });
    run::GatewayFeed feed(*chain_);
    ingest::Gateway gateway(vehicle_, feed, ingest::read_mappings(vehicle_));
    for (recording::Frame frame; reader->next(frame);) {
      chain_->advance(frame.stamp_ns);
      gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
    }
    gateway.finish();
    chain_->finish();
    finish();
  }

 private:
  void put(run::File file, std::string_view text) {
    if (file == run::File::kScans) scans_ << text;
    if (file == run::File::kTracks) tracks_file_ << text;
  }

  void add(const run::ScanResult& result) {
    *scan_ = result.classified;
    origins_.set(result, *scan_);
    const std::int64_t begin_ns = runtime::thread_cpu_time_ns();
    static_cast<void>(tracker_->step(*scan_));
    tracker_->write(*tracks_);
    const std::int64_t step_ns = runtime::thread_cpu_time_ns() - begin_ns;
    const std::int64_t filtered_ns = chain_->stage_times().tracker;
    tracks_->header = result.tracks.header;
    writer_.write(run::ScanResult{result.at, result.number, result.scan, *scan_, *tracks_});
    fmt::print(times_, "{:.6f},{:.6f}\n", kMillisecondsPerNanosecond * static_cast<double>(filtered_ns - filtered_ns_),
               kMillisecondsPerNanosecond * static_cast<double>(step_ns));
    perfect_ns_ += step_ns;
    filtered_ns_ = filtered_ns;
  }

  void finish() {
    writer_.flush();
    for (std::ofstream* const file : {&scans_, &tracks_file_, &times_}) {
      file->close();
      if (!*file) throw std::runtime_error(out_.string() + ": cannot be written");
    }
    json::Value summary;
    summary["vehicle"] = vehicle_.name;
    summary["recording_s"] = 1e-9 * static_cast<double>(chain_->length_ns());
    summary["timing"]["cpu_s_by_stage"]["tracker"] = 1e-9 * static_cast<double>(perfect_ns_);
    std::ofstream(out_ / "run.json") << json::document(summary);
  }

  const VehicleConfig& vehicle_;
  OriginsOfScans origins_;
  std::unique_ptr<boresight::tracking::MultiObjectTracker> tracker_;
  fs::path out_;
  std::ofstream scans_, tracks_file_, times_;
  run::Writer writer_;
  std::unique_ptr<ClassifiedScan> scan_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  std::int64_t filtered_ns_ = 0, perfect_ns_ = 0;
  std::unique_ptr<run::Chain> chain_;
};

}  // namespace

void run_with_true_origins(const std::vector<fs::path>& recordings, const fs::path& truth,
                           const runtime::Configuration& configuration, const fs::path& out) {
  fs::create_directories(out);
  const VehicleConfig vehicle = configuration.vehicle();
  PerfectRun(vehicle, run::read_settings(configuration, vehicle), truth, out).play(recordings);
}

StepTimes read_step_times(const fs::path& run) {
  constexpr double kLongest_ms = 1e6;
  StepTimes times;
  score::Table table(run / kTimesFile, {"filtered_ms", "perfect_ms"});
  while (table.next()) {
    times.filtered_ms.push_back(table.number("filtered_ms", 0.0, kLongest_ms));
    times.perfect_ms.push_back(table.number("perfect_ms", 0.0, kLongest_ms));
  }
  return times;
}

}  // namespace boresight::bench::tracking
