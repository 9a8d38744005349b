// The cores of the pipeline in two halves, so that the ghost benchmark runs several ghost filters behind one corrector.
// The whole chain is run::Chain.
#pragma once

#include <memory>
#include <utility>

#include "services/alignment_estimator/core/estimator.hpp"
#include "services/detection_corrector/core/corrector.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/simulator/drive.hpp"
#include "services/tracker/core/make_tracker.hpp"

namespace boresight::closed_loop {

/// Alignment estimator and detection corrector: the stages before the ghost filter.
class Front {
 public:
  explicit Front(const VehicleConfig& vehicle, const corrector::Config& config = {})
      : ego_(vehicle.ego), estimator_(vehicle, {}), corrector_(vehicle, config) {}

  /// Takes one event; true if it was a scan, which is then in `corrected`.
  bool take(const simulator::Event& event) {
    if (event.scan == nullptr) {
      const EgoMotion motion = simulator::to_message(event, ego_);
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
    corrected->header = event.scan->header;
    corrector_.correct(*event.scan, *corrected);
    return true;
  }

  std::unique_ptr<CorrectedScan> corrected = std::make_unique<CorrectedScan>();

 private:
  EgoConfig ego_;
  alignment::Estimator estimator_;
  corrector::Corrector corrector_;
  std::uint64_t estimates_ = 0;
};

/// Ghost filter and tracker, whose tracks are fed back to the ghost filter.
class Back {
 public:
  Back(const VehicleConfig& vehicle, std::unique_ptr<ghosts::Method> method)
      : method_(std::move(method)), tracker_(tracking::make_tracker(tracking::Config{}.tracker, vehicle, {})) {}

  void take(const CorrectedScan& corrected) {
    classified->header = tracks->header = corrected.header;
    method_->classify(corrected, *classified);
    tracker_->step(*classified);
    tracker_->write(*tracks);
    method_->add_tracks(*tracks);
  }

  std::unique_ptr<ClassifiedScan> classified = std::make_unique<ClassifiedScan>();
  std::unique_ptr<TrackList> tracks = std::make_unique<TrackList>();

 private:
  std::unique_ptr<ghosts::Method> method_;
  std::unique_ptr<tracking::MultiObjectTracker> tracker_;
};

}  // namespace boresight::closed_loop
