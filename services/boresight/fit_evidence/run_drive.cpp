#include "services/boresight/fit_evidence/run_drive.hpp"

#include <memory>
#include <optional>

#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "services/boresight/run/gateway_feed.hpp"
#include "services/boresight/run/table_feed.hpp"
#include "services/boresight/score/detection_truth.hpp"
#include "services/boresight/score/object_truth.hpp"
#include "services/boresight/score/truth_clock.hpp"
#include "services/common/recording/reader.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

namespace boresight::fit_evidence {

namespace {

double read_share(std::uint64_t position, std::uint64_t total) {
  return total == 0 ? -1.0 : static_cast<double>(position) / static_cast<double>(total);
}

class Labeller {
 public:
  Labeller(const LabelledDrive& drive, const VehicleConfig& vehicle, const run::Settings& settings)
      : clock_(drive.truth),
        origins_(drive.truth.detections, drive.truth.detections_are_labels),
        lanes_(settings.ghosts, origins_.has_objects() && !drive.truth.objects.empty()),
        chain_(std::make_unique<run::Chain>(
            vehicle, settings, run::Listeners{[this](const run::ScanResult& result) { add(result); }, {}, {}})) {
    if (origins_.has_objects() && !drive.truth.objects.empty()) {
      objects_.emplace(drive.truth.objects, drive.truth.objects_are_boxes, std::filesystem::path{});
    }
  }

  [[nodiscard]] run::Chain& chain() { return *chain_; }
  [[nodiscard]] DriveRun finish() {
    run_.scans_without_ego_motion = run::scans_without_ego_motion(chain_->counts());
    return std::move(run_);
  }

 private:
  void add(const run::ScanResult& result) {
    if (!clock_.has_begun()) clock_.begin(result.at.time_ns, 1e-6 * static_cast<double>(result.at.since_start_us()));
    const std::uint32_t radar = result.scan.header.source_id;
    const double t_s = clock_.measured_s(radar, result.at.time_ns);
    const bool has_moving = !chain_->evidence().empty();
    ++run_.scans;
    run_.moving_scans += has_moving ? 1 : 0;
    lanes_.classify(chain_->corrected());
    const std::size_t count = result.classified.number_of_valid_detections;
    const std::vector<score::TrueOrigin>* const origins = origins_.find(radar, t_s, result.number, count);
    if (origins == nullptr) {
      run_.scans_without_truth += has_moving ? 1 : 0;
      return;
    }
    truth_.clear();
    for (const score::TrueOrigin& origin : *origins) {
      simulator::DetectionTruth& each = truth_.emplace_back();
      each.provenance = origin.provenance;
      each.object_id = origin.object;
    }
    lanes_.label(t_s, truth_, chain_->evidence(), run_.evidence);
    if (!objects_ || !objects_->at(t_s, object_list_)) return;
    std::vector<judge::Object> moving;
    for (const judge::TrueObject& object : object_list_) {
      if (!object.parked) moving.push_back(object.box);
    }
    lanes_.add_objects(t_s, truth_, std::move(moving));
  }

  score::TruthClock clock_;
  score::DetectionTruth origins_;
  std::optional<score::ObjectTruth> objects_;
  Lanes lanes_;
  std::vector<simulator::DetectionTruth> truth_;  // of the scan in hand
  std::vector<judge::TrueObject> object_list_;    //
  DriveRun run_;
  std::unique_ptr<run::Chain> chain_;
};

void play_recordings(const LabelledDrive& drive, const VehicleConfig& vehicle,
                     const ingest::ContradictionConfig& contradiction, run::Chain& chain, input::Problems& problems,
                     const std::function<void(double)>& look) {
  const auto reader =
      recording::open_recordings(drive.recordings, [&](const std::string& problem) { problems.bad_line(problem); });
  run::GatewayFeed feed(chain);
  ingest::Gateway gateway(vehicle, feed, ingest::read_mappings(vehicle), contradiction);
  recording::Frame frame;
  for (std::uint64_t frames = 1; reader->next(frame); ++frames) {
    chain.advance(frame.stamp_ns);
    gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
    problems.good_line();
    constexpr std::uint64_t kFramesBetweenLooks = 256;
    if (frames % kFramesBetweenLooks != 0) continue;
    look(read_share(reader->progress().position_bytes, reader->progress().total_bytes));
  }
  gateway.finish();
}

std::uint64_t play_tables(const LabelledDrive& drive, const VehicleConfig& vehicle, run::Chain& chain,
                          input::Problems& problems, const std::function<void(double)>& look) {
  recording::ByteSource ego_source(drive.ego), drive_source(drive.detections);
  input::EgoReader ego(ego_source, vehicle.ego, problems);
  input::DriveReader detections(drive_source, vehicle, problems);
  run::TableFeed feed(detections, ego, chain);
  while (feed.next()) look(read_share(drive_source.position(), drive_source.total()));
  std::uint64_t lines = 0;
  for (const auto& [radar, of_radar] : detections.unknown_radars()) lines += of_radar;
  return lines;
}

}  // namespace

DriveRun run_drive(const LabelledDrive& drive, const VehicleConfig& vehicle, const run::Settings& settings,
                   input::Problems& problems, const std::function<void(double share)>& look) {
  Labeller labeller(drive, vehicle, settings);
  std::uint64_t lines_of_unknown_radars = 0;
  if (drive.has_tables()) {
    lines_of_unknown_radars = play_tables(drive, vehicle, labeller.chain(), problems, look);
  } else {
    play_recordings(drive, vehicle, settings.contradiction, labeller.chain(), problems, look);
  }
  DriveRun result = labeller.finish();
  result.lines_of_unknown_radars = lines_of_unknown_radars;
  return result;
}

}  // namespace boresight::fit_evidence
