// The product's own method: what is a ghost must mirror something real, in place and range rate.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "services/ghost_filter/core/classify/filter_config.hpp"
#include "services/ghost_filter/core/classify/judge.hpp"
#include "services/ghost_filter/core/classify/mirror_trials.hpp"
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
  /// `ghost_probability` is the probability that a detection is no direct reflection: a ghost or clutter.
  void classify(const CorrectedScan& scan, ClassifiedScan& out) override;
  [[nodiscard]] std::size_t map_points() const override { return map_.grid().size(); }

 private:
  /// How much a track looks like the image of something else, over time, how strongly it reflects and whether it
  /// mirrors.
  struct Image {
    std::uint32_t tracking_id = 0;
    double log_odds = 0.0;
    std::uint32_t judgements = 0;
    double rcs_dbsm = kUsualRcs_dbsm, rcs_std_db = kUsualRcsStd_db;  ///< of its parts, as far as they were heard
    double mirrors = 0.0;                                            ///< log-odds gained, that its faces do
  };
  void update_map(const CorrectedScan& scan, std::size_t count);
  void predict_objects(const CorrectedScan& scan);
  [[nodiscard]] bool is_on_moving(const Eigen::Vector2d& place_m) const;
  void gather_movers(const CorrectedScan& scan, std::size_t count);
  void judge_tracks();
  void try_mirrors(const CorrectedScan& scan, std::size_t count);
  void learn_strength(const Densities& densities, const Measured& measured);
  [[nodiscard]] Measured measured(const CorrectedScan& scan, std::size_t i) const;
  /// Of the range rate over ground of what stands: by what is not known of its elevation.
  [[nodiscard]] double still_variance_by_height(const CorrectedScan& scan, std::size_t i,
                                                const Measured& measured) const;
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
  std::vector<Object> objects_;     // the own vehicle is the last
  SourceMap sources_;               // these, and the movers
  std::vector<Measured> measured_;  // the scan's usable detections, at their places
  std::array<std::uint32_t, kMaxTracks> track_of_object_{};
  std::unique_ptr<TrackList> tracks_;  // a copy: the message leaves shared memory after the call
  std::array<Image, kMaxTracks> images_{}, images_before_{};
  std::size_t turn_ = 0;  // the track that is judged next
  std::size_t mirrors_turn_ = 0, faces_turn_ = 0;
  bool has_tracks_ = false;
  Eigen::Vector2d sensor_m_{0.0, 0.0}, sensor_velocity_mps_{0.0, 0.0};
  double ego_speed_std_mps_ = 0.0, mounting_std_rad_ = 0.0;
  double sensor_height_m_ = 0.0, tilt_variance_m2ps2_ = 0.0;
};

}  // namespace boresight::ghosts
