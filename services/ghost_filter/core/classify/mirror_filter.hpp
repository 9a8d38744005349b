// The product's own method: what is a ghost must mirror something real, in place and range rate.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "services/ghost_filter/core/classify/filter_config.hpp"
#include "services/ghost_filter/core/classify/judge.hpp"
#include "services/ghost_filter/core/classify/mirror_trials.hpp"
#include "services/ghost_filter/core/classify/pace.hpp"
#include "services/ghost_filter/core/classify/predicted_object.hpp"
#include "services/ghost_filter/core/classify/recent_movers.hpp"
#include "services/ghost_filter/core/classify/source_map.hpp"
#include "services/ghost_filter/core/method.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

namespace boresight::ghosts {

class MirrorFilter final : public Method {
 public:
  explicit MirrorFilter(const MirrorConfig& config);

  void add_tracks(const TrackList& tracks) override;
  /// The probability of an origin is its share of the densities of all origins where the detection is.
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return map_.grid().size(); }

 private:
  /// Of the tracked vehicles on the map.
  void cast_shadows();
  void update_map(const CorrectedScan& scan, std::size_t count);
  void predict_objects(const CorrectedScan& scan);
  [[nodiscard]] bool is_on_moving(const Eigen::Vector2d& place_m) const;
  void gather_movers(const CorrectedScan& scan, std::size_t count);
  void judge_tracks();
  void try_mirrors();
  void learn_strength(const Densities& densities, const Measured& measured);
  void write_verdict(const Densities& densities, std::size_t i, ClassifiedScan& out) const;
  MirrorConfig config_;
  Odometry odometry_;
  ReflectorMap map_;
  RecentMovers movers_;
  DirectEchoes echoes_{kMaxDetections};
  std::vector<double> verdicts_;  ///< weights that the scan's movers have for those to come
  Judge judge_;
  MirrorTrials trials_;
  std::vector<Mirror> mirrors_;
  std::vector<Object> objects_;  // the own vehicle is the last
  SourceMap sources_;            // these, and the movers
  std::array<Kind, kMaxDetections> kinds_{};
  std::vector<Measured> measured_;  // the scan's detections that are not left out, at their places
  std::array<std::uint32_t, kMaxTracks> track_of_object_{};
  std::unique_ptr<TrackList> tracks_;  // a copy: the message leaves shared memory after the call
  std::array<TrackBelief, kMaxTracks> beliefs_{}, beliefs_before_{};
  std::size_t turn_ = 0;  // the track that is judged next
  std::size_t mirrors_turn_ = 0, faces_turn_ = 0;
  /// Four radars of 20 scans a second have all at once in each scan.
  static constexpr double kTurn_s = 0.0125;
  Pace tracks_pace_{16, kTurn_s}, mirrors_pace_{8, kTurn_s}, faces_pace_{8, kTurn_s};
  std::int64_t before_ns_ = 0;  // time of the scan before
  bool has_tracks_ = false;
  Viewpoint from_;  // of the scan in hand
};

}  // namespace boresight::ghosts
