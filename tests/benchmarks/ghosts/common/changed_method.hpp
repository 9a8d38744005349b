// A method with something changed around it, for the ablation.
#pragma once

#include <memory>
#include <optional>

#include "interfaces/messages/radar_scan.hpp"
#include "services/ghost_filter/core/method.hpp"

namespace boresight::bench {

struct Change {
  bool gets_tracks = true;          ///< false: as when the tracker is not there; it tracks all the same, for the record
  bool gets_rcs = true;             ///< false: as of radars that measure none; the corrector had it all the same
  bool tells_probabilities = true;  ///< false: the tracker gets labels, as probabilities of 0 and 1
  /// What is slower over ground stands still, whatever the corrector found.
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
