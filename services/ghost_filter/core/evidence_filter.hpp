// The product's own method: additive evidence, without and with the tracks of the step before.
//
// Per scan: the stationary detections go to the map of reflectors; each moving detection gets counts, the expected
// intensity of known objects and of their mirror images, and levels; weights make them a likelihood ratio and a
// probability. The name of a false detection's origin is the largest explanation, after the probability is fixed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "services/ghost_filter/core/evidence/config.hpp"
#include "services/ghost_filter/core/evidence/counts.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/ghost_filter/core/odometry.hpp"
#include "services/ghost_filter/core/origins/expected.hpp"
#include "services/ghost_filter/core/origins/known_objects.hpp"
#include "services/ghost_filter/core/origins/mirror.hpp"
#include "services/ghost_filter/core/origins/mirror_images.hpp"
#include "services/ghost_filter/core/reflectors/reflector_map.hpp"

namespace boresight::ghosts {

class EvidenceFilter final : public Method {
 public:
  explicit EvidenceFilter(const EvidenceConfig& config);

  void add_tracks(const TrackList& tracks) override;
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return map_.points(); }
  [[nodiscard]] std::span<const JudgedEvidence> evidence() const override { return judged_; }

 private:
  /// Whether tracks are known and young enough; sets the scan's flags.
  [[nodiscard]] bool has_tracks(std::int64_t time_ns, ClassifiedScan& out) const;
  void gather(const CorrectedScan& scan, std::size_t count, ClassifiedScan& out);
  void expect(const CorrectedScan& scan, bool has_tracks);
  void judge(const CorrectedScan& scan, bool has_tracks, ClassifiedScan& out);
  [[nodiscard]] const EvidenceWeights& weights_of(std::uint32_t radar_id) const;

  EvidenceConfig config_;
  Odometry odometry_;
  Counter counter_;
  ReflectorMap map_;
  ExpectedDetections expecting_;
  std::unique_ptr<TrackList> tracks_;  // a copy: the message leaves shared memory after the call
  bool has_list_ = false;
  // Of the scan in hand, each with the capacity of a scan.
  std::vector<JudgedEvidence> judged_;
  std::vector<Candidate> candidates_;
  std::vector<Counts> counts_;
  std::vector<SeenDetection> seen_;
  std::vector<Expected> expected_;
  std::vector<Mirror> mirrors_;
  std::vector<KnownObject> objects_;
  std::vector<MirrorImage> images_;
};

}  // namespace boresight::ghosts
