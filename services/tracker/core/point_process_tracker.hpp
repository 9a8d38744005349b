// A tracker of three parts: the model of the world, a multi-object filter, and the reporter of its objects.
#pragma once

#include <memory>

#include "services/tracker/core/filter.hpp"
#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/multi_object_tracker.hpp"
#include "services/tracker/core/output/reporter.hpp"

namespace boresight::tracking {

class PointProcessTracker final : public MultiObjectTracker {
 public:
  PointProcessTracker(std::unique_ptr<Model> model, std::unique_ptr<Filter> filter, std::unique_ptr<Reporter> reporter);

  StepResult step(const ClassifiedScan& scan) override;
  void write(TrackList& out) const override;

 private:
  /// How much later than any scan before this one is; 0 out of order.
  double advance(const ScanStart& start);

  std::unique_ptr<Model> model_;
  std::unique_ptr<Filter> filter_;
  std::unique_ptr<Reporter> reporter_;
  StepResult result_;
  double behind_s_ = 0.0;    // of the scan, in measurement time, behind the newest one
  std::uint32_t flags_ = 0;  // of the scan
};

}  // namespace boresight::tracking
