// How likely each origin of a detection is: expected densities of detections at its place with its range rate and
// strength.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/classify/config.hpp"
#include "services/ghost_filter/core/classify/direct_echoes.hpp"
#include "services/ghost_filter/core/classify/measured.hpp"
#include "services/ghost_filter/core/classify/mirror_fan.hpp"
#include "services/ghost_filter/core/classify/object.hpp"
#include "services/ghost_filter/core/classify/recent_movers.hpp"
#include "services/ghost_filter/core/classify/source_map.hpp"
#include "services/ghost_filter/core/mirror/between_walls.hpp"
#include "services/ghost_filter/core/mirror/meeting.hpp"
#include "services/ghost_filter/core/mirror/mirror.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

namespace boresight::ghosts {

/// Expected number of detections for each m², m/s and dB.
struct Densities {
  double moving = 0.0, stationary = 0.0, type1 = 0.0, type2 = 0.0, clutter = 0.0;
  std::uint32_t object = kNobody;     ///< the one whose body, or image, it most likely is of
  std::uint32_t likeliest = kNobody;  ///< the one that contributes most to `moving`
  double of_body = 0.0;               ///< its part, if a mirror between did not hide it
  double of_tracks = 0.0;             ///< part of `moving` that is of tracked objects
  double of_images = 0.0;             ///< part of `type2` that is of tracks that are images themselves
  [[nodiscard]] double sum() const { return moving + stationary + type1 + type2 + clutter; }
};

/// What the detections of a scan are judged by.
struct Surroundings {
  Eigen::Vector2d sensor_m, sensor_velocity_mps;
  std::span<const Mirror> mirrors;
  std::span<const Object> objects;
  const SourceMap* sources;  ///< and where they are; weigh() needs the movers entered as well
  const Odometry* odometry;
  const RecentMovers* movers;  ///< of the scan itself, too
  const DirectEchoes* echoes;  ///< of the scan itself only
  const StationaryGrid* stationary;
};

class Judge {
 public:
  static constexpr std::size_t kMaxObjects = 129;
  explicit Judge(const ClassConfig& config);

  /// For a new scan; what is in `surroundings` is only referred to.
  void begin(const Surroundings& surroundings);
  /// As far from a mover as something may be that it is taken for, but for what that is known worse.
  [[nodiscard]] double reach_of_mover(const MovedMover& mover) const;
  /// Whether what the corrector found moving does, as probability, by its range rate and what is known to stand there.
  [[nodiscard]] double moves(const Measured& measured) const;
  /// `index` of the detection in the scan.
  [[nodiscard]] Densities weigh(const Measured& measured, std::uint32_t index);
  /// Expected density of ghosts where an object is, which is not considered itself, nor what is detected of it. What
  /// is less than `least` need not be told.
  [[nodiscard]] double images(const Measured& measured, std::uint32_t object, double least);
  /// As weigh(), but only what a detection that looks stationary can be: that, or of an object that is tracked.
  [[nodiscard]] Densities weigh_still(const Measured& measured);
  /// Whether there is a mirror in front of the detection, as probability. For the detections that weigh() is asked for
  /// later, in their order, so that the mirrors in front of each are found once.
  [[nodiscard]] double behind_mirror(const Measured& measured, std::uint32_t index);
  /// The tracked object that a detection lies on, and whether it has another range rate than its body.
  struct Owner {
    std::uint32_t object = kNobody;
    bool is_wheel = false;
    double real = 1.0;  ///< probability that no image is tracked here
  };
  [[nodiscard]] Owner owner_of(const Measured& measured) const;

 private:
  /// A mirror that the line of sight crosses.
  struct Crossing {
    const Mirror* mirror;
    Turn turn;
    double beyond;  ///< probability that the detection lies behind it, if it is there
    [[nodiscard]] double sure() const { return turn.probability * beyond; }
  };
  /// What would have to be where for a detection to be a ghost of it: something at `place_m` whose velocity v makes
  /// the range rate over ground q·v + known.
  struct Target {
    Eigen::Vector2d place_m;
    Eigen::Matrix2d covariance;
    Eigen::Vector2d q;
    double known_mps, noise_variance;
    Eigen::Vector2d lit_from_m, seen_from_m;
    Eigen::Vector2d sight;               ///< unit, along the last way to it: along that its place is known best
    Strength strength;                   ///< beside what it reflects directly
    double stretch;                      ///< square metres at the target for each one at the detection
    double turn_variance;                ///< of the direction to it, rad²
    const Mirror* mirror;                ///< the last one
    std::uint32_t other_body = kNobody;  ///< of another mirror on the way
    bool of_own = false;                 ///< the own vehicle may be the target
    bool silent = false;  ///< the target is not among what was detected: if it shows a range rate that is unlikely
  };
  void cross(const Measured& measured, std::uint32_t but_object);
  /// As cross(), of what behind_mirror() was asked for before.
  void cross_again(const Measured& measured, std::uint32_t index);
  /// Expected density of ghosts, if every object has one, of tracked objects and of what was detected lately.
  /// Of less than `least` it may tell nothing.
  [[nodiscard]] double ghosts_of(const Target& target, const Measured& measured, std::uint32_t but_object,
                                 std::uint32_t but_index, double least) const;
  /// The part of that by objects that are not tracked (yet) but have been detected at least; and what was detected is
  /// known better than a box. Nothing if it is not more than `least`.
  [[nodiscard]] double of_detected(const Target& target, const Measured& measured, std::uint32_t but_object,
                                   std::uint32_t but_index, double least) const;
  /// Of less than `least` nothing need be told, and of more than `enough` not how much it is.
  struct Telling {
    double least, enough;
  };
  /// Both types, of what is known; needs the crossings.
  void ghosts(const Measured& measured, std::uint32_t index, std::uint32_t but_object, const Telling& telling,
              Densities& densities);
  /// All that is no ghost; needs the crossings.
  void real(const Measured& measured, std::uint32_t index, bool is_hidden, Densities& densities) const;
  /// `looks_still`: of those that move, as likely as they do.
  void of_objects(const Measured& measured, bool looks_still, Densities& densities) const;
  /// The same of objects that are not tracked (yet) but were detected, in this scan or just before; and whether
  /// anything else was detected there that goes with it.
  struct Recent {
    double density;
    bool in_company;
  };
  [[nodiscard]] Recent of_movers(const Measured& measured, std::uint32_t index) const;
  /// The cell of the map in which something was detected before, or nullptr.
  [[nodiscard]] const StationaryGrid::Cell* known_still(const Measured& measured) const;
  /// Whether something was detected there before the object came: what has been there only since then may be of it.
  [[nodiscard]] bool was_before(const StationaryGrid::Cell& cell, const Measured& measured, const Object& object) const;
  /// `seen`: how often something was detected there, this time included.
  [[nodiscard]] double of_stationary(const Measured& measured, std::uint32_t seen) const;
  [[nodiscard]] double type1(const Measured& measured, std::uint32_t index, std::uint32_t but_object, double least);
  /// Whether it lies behind something so near that walls on both sides light it. Of the fronts that type1() found.
  [[nodiscard]] bool is_behind_alongside() const;
  void find_walls();
  /// Those whose way out is by one wall and then by another; needs the fronts that type1() found.
  [[nodiscard]] double type1_of_two(const Measured& measured, double least);
  /// The variance of a type-1 ghost's object along the line of sight, and what else is known of that object; the
  /// mirrors' own motion is not in it.
  [[nodiscard]] static double variance_along(const Measured& measured, const Meeting& met);
  [[nodiscard]] Target target_of(const Measured& measured, const Meeting& met, double along2,
                                 const Mirror& mirror) const;
  /// What a type-1 ghost may be of: an echo in front, or a tracked object that is not known to have sent one.
  struct Front {
    const DirectEcho* echo;
    double depth_m, reach_m;       ///< along the line of sight, and how far from there the target may be
    double same_spot, other_spot;  ///< densities across it, for each metre
    double most;                   ///< of the density of its ghosts
  };
  /// Fills `fronts_`.
  void find_fronts(const Measured& measured, std::uint32_t index);
  /// What of that a way may lead to: the most that the echoes may come to, and whether there is something without.
  struct Ahead {
    double most;
    bool silent;
  };
  /// However the way runs, but for what it stretches.
  [[nodiscard]] Ahead of_all_fronts() const;
  [[nodiscard]] Ahead ahead_on(const Approach& way, const Measured& measured, const Ahead& all) const;
  /// Density at the target of ghosts of the echoes in front; `along2` is the variance of its place along the line of
  /// sight.
  [[nodiscard]] double of_fronts(const Target& target, double along2, const Measured& measured) const;
  /// Variance of the range rate that a target of whatever speed would show.
  [[nodiscard]] static double noise_of_any(const Target& target);
  /// Densities if the target is what was detected in that direction with that range rate and strength: of an object's,
  /// or of nobody's.
  [[nodiscard]] double rate_fits(const Target& target, const Measured& measured, std::uint32_t object,
                                 const Eigen::Vector2d& direction, double rate_mps) const;
  /// `of_heard`: the likelihood beside a detection, which is the same for all of a target.
  [[nodiscard]] double strength_beside(const StrengthLikelihood& of_heard, const Target& target,
                                       const Measured& measured, double rcs_dbsm) const;
  [[nodiscard]] bool shows_rate(const Object& object) const;
  /// Whether a type-1 ghost may be of it without an echo in front.
  [[nodiscard]] bool may_be_unheard(const Object& object) const;
  [[nodiscard]] double hidden(const Measured& measured, std::uint32_t but_object, bool& is_hidden) const;
  [[nodiscard]] double type2(const Measured& measured, const Crossing& crossing, std::uint32_t index,
                             std::uint32_t but_object, double least) const;
  /// Those whose way out is by another mirror.
  [[nodiscard]] double type2_of_two(const Measured& measured, const Crossing& crossing, std::uint32_t index,
                                    std::uint32_t but_object, double least);
  [[nodiscard]] Target target_of(const Measured& measured, const Crossing& crossing, double rest_m,
                                 double metres_per_m) const;
  /// Whether there may be something that is reflected where a way leads along the ray; the variance across it is m².
  [[nodiscard]] bool may_be_at(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, const Approach& way,
                               const Measured& measured, double variance_across) const;
  [[nodiscard]] double image_of_stationary(const Target& target, const Measured& measured) const;
  [[nodiscard]] double rate_variance(const Measured& m) const;
  /// Share of what is explained already that it hardly matters whether something else adds to it.
  static constexpr double kLittle = 0.1;
  /// Of mirrors being there: less is not followed.
  static constexpr double kLeastChance = 0.05;
  static constexpr double kLeastPair = 0.15;  ///< of two
  ClassConfig config_;
  Surroundings s_{};
  MirrorFan fan_;
  std::vector<const Mirror*> likely_;  // mirrors, the likeliest one first
  std::vector<WaysBy> ways_;           // by them
  /// A wall, and where the sensor is beside it.
  struct Side {
    const Mirror* mirror;
    Eigen::Vector2d side_m;
  };
  std::vector<Side> sides_;
  std::vector<WaysBetween> walls_;  // that have the sensor between them, once they were asked for in the scan
  bool walls_are_found_ = false;
  std::vector<Crossing> crossings_;
  std::vector<Front> fronts_;
  double most_of_strength_;  ///< density of a type-1 ghost's strength, however it is bent back at its object
  /// Those of the detections that behind_mirror() was asked for, one after the other.
  struct Kept {
    std::uint32_t index, end;
  };
  std::vector<Crossing> kept_crossings_;
  std::vector<Kept> kept_;
  std::size_t next_kept_ = 0;
  bool has_slow_ = false;  ///< a tracked object whose images may look as if they stood
  SectorSet unmoved_ = 0;  ///< with tracked objects that show no range rate
  SectorSet unheard_ = 0;  ///< with those that may_be_unheard()
  /// Of two mirrors, that the detection in hand, and the scan, may still be followed over.
  std::size_t pairs_left_ = 0, pairs_left_of_scan_ = 0;
  std::size_t walls_left_of_scan_ = 0;  ///< pairs of them
};

}  // namespace boresight::ghosts
