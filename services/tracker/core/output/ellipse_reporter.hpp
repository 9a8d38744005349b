// Tracks of scenarios: boxes around the ellipses of the extent.
#pragma once

#include <vector>

#include "services/tracker/core/output/reporter.hpp"

namespace boresight::tracking {

class EllipseReporter final : public Reporter {
 public:
  explicit EllipseReporter(double confirmed_existence);
  void clear() override { tracks_.clear(); }
  void take(std::span<const ObjectEstimate> objects, double elapsed_s) override;
  void write(TrackList& out) const override;

 private:
  double confirmed_existence_;
  std::vector<Track> tracks_;
};

}  // namespace boresight::tracking
