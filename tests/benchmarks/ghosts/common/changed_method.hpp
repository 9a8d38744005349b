// A method with changed inputs or outputs, for the ablation.
#pragma once

#include <memory>
#include <optional>

#include "interfaces/messages/radar_scan.hpp"
#include "services/ghost_filter/core/method.hpp"

namespace boresight::bench {

struct Change {
  bool gets_tracks = true;           ///< false: the method runs without tracks; the tracker still runs and is judged
  bool gets_rcs = true;              ///< false: radars without RCS measurement; the corrector still used RCS
  bool passes_probabilities = true;  ///< false: the tracker gets labels as probabilities 0 and 1
  /// Detections with a smaller range rate over ground are stationary, whatever the corrector decided.
  std::optional<double> stationary_below_mps{};
};

class ChangedMethod final : public ghosts::Method {
 public:
  ChangedMethod(const ghosts::Config& config, const Change& change);
  void add_tracks(const TrackList& tracks) override;
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return method_->map_points(); }

 private:
  Change change_;
  std::unique_ptr<ghosts::Method> method_;
  [[nodiscard]] const CorrectedScan& changed(const CorrectedScan& scan);
  std::unique_ptr<CorrectedScan> scan_ = std::make_unique<CorrectedScan>();
};

}  // namespace boresight::bench
