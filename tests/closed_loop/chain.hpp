// The cores one after the other, as the processes are.
#pragma once

#include <chrono>
#include <memory>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/detection_corrector/core/corrector.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/tracker/core/tracker.hpp"
#include "tests/simulator/drive.hpp"

namespace boresight::closed_loop {

class Chain {
 public:
  explicit Chain(const VehicleConfig& vehicle, const ghosts::Config& ghosts = {})
      : vehicle_(vehicle),
        estimator_(vehicle, {}),
        corrector_(vehicle, {}),
        ghost_filter_(ghosts::make_method(ghosts)),
        tracker_(vehicle, tracking::Config{}) {}

  /// Takes one event; true if it was a scan, whose results are then in the members below.
  bool take(const simulator::Event& event) {
    if (event.scan == nullptr) {
      const EgoMotion motion = simulator::to_message(event, vehicle_.ego);
      estimator_.add_ego_motion(motion);
      corrector_.add_ego_motion(motion);
      return false;
    }
    if (estimator_.add_scan(*event.scan) == alignment::ScanResult::kPublish) {
      AlignmentEstimate estimate{};
      static_cast<void>(estimator_.write(event.scan->header.source_id, estimate));
      estimate.header.source_id = event.scan->header.source_id;
      estimate.header.sequence = ++estimates_;
      estimate.header.measurement_time_ns = event.scan->header.measurement_time_ns;
      corrector_.add_alignment(estimate);
    }
    corrected->header = classified->header = tracks->header = event.scan->header;
    corrector_.correct(*event.scan, *corrected);
    const auto begin = std::chrono::steady_clock::now();
    ghost_filter_->classify(*corrected, *classified);
    ghost_filter_us = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
    tracker_.step(*classified);
    tracker_.write(*tracks);
    ghost_filter_->add_tracks(*tracks);
    return true;
  }

  std::unique_ptr<CorrectedScan> corrected = std::make_unique<CorrectedScan>();
  std::unique_ptr<ClassifiedScan> classified = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks = std::make_unique<TrackList>();
  double ghost_filter_us = 0.0;  ///< that the ghost filter took

 private:
  VehicleConfig vehicle_;
  alignment::Estimator estimator_;
  corrector::Corrector corrector_;
  std::unique_ptr<ghosts::Method> ghost_filter_;
  tracking::Tracker tracker_;
  std::uint64_t estimates_ = 0;
};

}  // namespace boresight::closed_loop
