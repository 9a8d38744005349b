// The evidence of a drive's moving detections with their true origins. A ghost filter gets tracks in one of three ways.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/boresight/fit_evidence/base_rate.hpp"
#include "services/boresight/fit_evidence/fit_weights.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/simulator/judge/hidden.hpp"
#include "services/simulator/judge/true_tracks.hpp"

namespace boresight::fit_evidence {

/// How a filter gets tracks.
enum class Lane : std::uint8_t {
  kWithout,  ///< none
  kPerfect,  ///< the true objects that radars have detected (true_tracks.hpp)
  kChain,    ///< of the tracker behind the filter
};
inline constexpr std::size_t kLanes = 3;
inline constexpr std::array<std::string_view, kLanes> kLaneNames = {"without tracks", "perfect tracks", "in the chain"};

using EvidenceByLane = std::array<std::vector<LabelledEvidence>, kLanes>;

/// Place i of each lane is the same detection. Without true objects the lane kPerfect is empty.
struct DriveEvidence {
  EvidenceByLane lanes;
  std::vector<float> base_rates;  ///< of each detection (base_rate.hpp)

  [[nodiscard]] std::size_t detections() const { return base_rates.size(); }
  [[nodiscard]] std::size_t real_detections() const;
  [[nodiscard]] bool has_objects() const { return !lanes[static_cast<std::size_t>(Lane::kPerfect)].empty(); }
};

/// Collects the evidence of a drive. Holds the filters of the lanes that need no tracker; the chain has its own.
/// For each scan: classify(), label(), and add_objects() if the true objects are known.
class Lanes {
 public:
  /// `config`: of the chain's filter. `has_objects`: the true objects are known, else there is no lane kPerfect.
  Lanes(const ghosts::Config& config, bool has_objects)
      : without_(config), perfect_(config), has_objects_(has_objects) {}

  /// The filters classify the scan. Scans come in the order of their measurement.
  void classify(const CorrectedScan& scan);
  /// Adds the moving detections of the scan to `out`. `truth`: of its detections, by index; those beyond its end are
  /// false. `in_chain`: evidence of the chain's filter for this scan. `t_s`: time of measurement.
  void label(double t_s, std::span<const simulator::DetectionTruth> truth,
             std::span<const ghosts::JudgedEvidence> in_chain, DriveEvidence& out);
  /// The filter with perfect tracks gets the true objects at the time of the scan that are not parked. What is known
  /// after a scan is known in the next one.
  void add_objects(double t_s, const std::vector<simulator::DetectionTruth>& truth, std::vector<judge::Object> objects);

  /// The scan as the filters classified it.
  [[nodiscard]] const ClassifiedScan& without() const { return *without_.classified; }
  [[nodiscard]] const ClassifiedScan& perfect() const { return *perfect_.classified; }
  /// Since when an object is known to the filter with perfect tracks; negative: it is not known.
  [[nodiscard]] double age_s(std::uint32_t object, double t_s) const { return true_tracks_.age_s(object, t_s); }

 private:
  /// A filter without a tracker behind it.
  struct Alone {
    explicit Alone(const ghosts::Config& config) : method(ghosts::make_method(config)) {}
    std::unique_ptr<ghosts::Method> method;
    std::unique_ptr<ClassifiedScan> classified = std::make_unique<ClassifiedScan>();
  };

  Alone without_, perfect_;
  bool has_objects_;
  judge::LastSeen last_seen_;
  judge::TrueTracks true_tracks_;
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  BaseRate base_rate_;
};

/// Adds the evidence of all lanes, for a fit.
void append(const DriveEvidence& drive, std::vector<LabelledEvidence>& all);

}  // namespace boresight::fit_evidence
