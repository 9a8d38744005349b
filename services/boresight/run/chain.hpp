// The cores of the pipeline in one process, connected as the services are when they lose nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/alignment_estimator/core/estimator.hpp"
#include "services/boresight/run/counts.hpp"
#include "services/boresight/run/health_watch.hpp"
#include "services/boresight/run/results.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/detection_corrector/core/corrector.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/ingest_gateway/core/contradiction_config.hpp"
#include "services/tracker/core/config.hpp"
#include "services/tracker/core/multi_object_tracker.hpp"

namespace boresight::run {

/// Settings of the services.
struct Settings {
  alignment::Config estimator;
  corrector::Config corrector;
  ghosts::Config ghosts;
  tracking::Config tracker;
  health::Config health;
  ingest::ContradictionConfig contradiction;  ///< for the gateway before the chain
};

/// One thread, no clock: the same inputs give the same results. A scan is corrected with the ego motions and estimates
/// that came before it, and classified with the tracks of the scan before. The services do the same, because an
/// estimate or a track list arrives after the scan that it is made of has left the stage that needs it. All times are
/// those of the recording. Memory does not grow with the recording.
class Chain {
 public:
  /// `cpu_ns` is the thread's CPU clock for stage_times(); without it they stay 0. Throws std::invalid_argument for an
  /// unknown method.
  Chain(const VehicleConfig& vehicle, const Settings& settings, Listeners listeners = {},
        std::int64_t (*cpu_ns)() = nullptr);

  /// The time of the next input's arrival: judges the health up to it. Call it before add_ego() and add_scan().
  void advance(std::int64_t arrival_ns);
  /// Both write the header of the message.
  void add_ego(EgoMotion& motion, std::int64_t time_ns);
  /// `scan.header.source_id` is the radar's id; false if the vehicle does not have it.
  bool add_scan(RadarScan& scan, std::int64_t time_ns);
  /// End of the recording.
  void finish();

  /// The latest results.
  [[nodiscard]] const CorrectedScan& corrected() const { return *corrected_; }
  [[nodiscard]] const ClassifiedScan& classified() const { return *classified_; }
  [[nodiscard]] const TrackList& tracks() const { return *tracks_; }
  /// The ghost filter's evidence of the latest scan (Method::evidence()).
  [[nodiscard]] std::span<const ghosts::JudgedEvidence> evidence() const { return ghosts_->evidence(); }

  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const StageTimes& stage_times() const { return times_; }
  /// Time of the first measurement, and between the first and the latest one.
  [[nodiscard]] std::int64_t start_ns() const { return start_ns_; }
  [[nodiscard]] std::int64_t length_ns() const { return has_start_ ? latest_ns_ - start_ns_ : 0; }

  /// Messages that the ingest gateway accepted and rejected, by radar id. The caller that decodes the recording writes
  /// them; the health judgement reads them.
  std::array<SourceStatistics, kMaxRadars + 1> sources{};

 private:
  /// A time of the recording on the clock of the cores.
  [[nodiscard]] std::int64_t to_core(std::int64_t time_ns);
  void note_measurement(std::int64_t time_ns);
  void publish_estimate(const RadarScan& scan, std::int64_t time_ns);
  [[nodiscard]] HealthWatch::Report health_report();

  template <typename Work>
  void timed(std::int64_t& stage_ns, const Work& work) {
    const std::int64_t begin_ns = cpu_ns_ == nullptr ? 0 : cpu_ns_();
    work();
    if (cpu_ns_ != nullptr) stage_ns += cpu_ns_() - begin_ns;
  }

  VehicleConfig vehicle_;
  Listeners listeners_;
  std::int64_t (*cpu_ns_)();
  alignment::Estimator estimator_;
  corrector::Corrector corrector_;
  std::unique_ptr<ghosts::Method> ghosts_;
  std::unique_ptr<tracking::MultiObjectTracker> tracker_;
  HealthWatch health_;
  std::vector<Eigen::Matrix3d> nominal_;  // R(sensor→vehicle) by index of the radar
  std::unique_ptr<CorrectedScan> corrected_ = std::make_unique<CorrectedScan>();
  std::unique_ptr<ClassifiedScan> classified_ = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  Counts counts_;
  StageTimes times_;
  std::uint64_t scans_ = 0, estimates_ = 0;
  bool has_shift_ = false, has_start_ = false;
  std::int64_t shift_ns_ = 0;  // clock of the cores minus that of the recording
  std::int64_t start_ns_ = 0, latest_ns_ = 0;
  std::int64_t arrival_ns_ = 0;
};

}  // namespace boresight::run
