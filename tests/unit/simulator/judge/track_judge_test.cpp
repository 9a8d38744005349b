// Figures of hand-made drives, each known exactly.
#include "services/simulator/judge/track_judge.hpp"

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace boresight::judge {
namespace {

constexpr double kListPeriod_s = 0.1;

TrueObject true_car(std::uint32_t id, double x, double y, double heading_rad = 0.0) {
  TrueObject object{
      Object{id, {x, y}, {10.0 * std::cos(heading_rad), 10.0 * std::sin(heading_rad)}, heading_rad, 4.5, 1.8},
      ObjectClass::kCar, false, true};
  return object;
}

ScoredTrack track_of(std::uint32_t id, const TrueObject& object) {
  ScoredTrack track;
  track.id = id;
  track.confirmed = true;
  track.movement = MovementState::kMoving;
  track.position_m = object.box.position_m;
  track.velocity_mps = object.box.velocity_mps;
  track.heading_rad = object.box.heading_rad;
  track.length_m = object.box.length_m;
  track.width_m = object.box.width_m;
  track.position_covariance_m2 = 0.04 * Eigen::Matrix2d::Identity();
  return track;
}

ScoredTrack track_at(std::uint32_t id, double x, double y) {
  return track_of(id, true_car(0, x, y));
}

using TrackSet = std::vector<ScoredTrack>;
using ObjectSet = std::vector<TrueObject>;

/// `lists` lists, 0.1 s apart, whose content depends on their number.
FigureList judged(int lists, const std::function<void(int, TrackSet&, ObjectSet&)>& fill) {
  TrackJudge judge;
  for (int i = 0; i < lists; ++i) {
    TrackSet tracks;
    ObjectSet objects;
    fill(i, tracks, objects);
    judge.add(kListPeriod_s * i, tracks, objects);
  }
  judge.finish();
  FigureList figures;
  judge.write(figures);
  return figures;
}

TEST(TrackJudge, PerfectTracksHaveNoErrors) {
  const FigureList f = judged(50, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0), true_car(2, 45.0, 4.0, 0.5)};
    tracks = {track_of(7, objects[0]), track_of(8, objects[1])};
  });
  EXPECT_EQ(f.value("tracks.all.all_ranges.objects"), 2.0);
  EXPECT_EQ(f.value("tracks.car.all_ranges.objects_found"), 2.0);
  EXPECT_EQ(f.value("tracks.car.0_30m.objects"), 1.0);
  EXPECT_EQ(f.value("tracks.car.30_60m.tracked_share"), 1.0);
  EXPECT_EQ(f.value("tracks.all.all_ranges.delay_median_s"), 0.0);
  for (const char* const what : {"along_rms_m", "across_rms_m", "speed_rms_mps", "heading_rms_deg", "length_rms_m",
                                 "width_rms_m", "identity_switches", "fragmentations"}) {
    EXPECT_NEAR(f.value(std::string("tracks.all.all_ranges.") + what), 0.0, 1e-12) << what;
  }
  EXPECT_EQ(f.value("tracks.all.all_ranges.inside_95_share"), 1.0);
  EXPECT_EQ(f.value("tracks.false.all_ranges.tracks"), 0.0);
  EXPECT_NEAR(f.value("tracks.gospa.squared.total"), 0.0, 1e-6);
  EXPECT_NEAR(f.value("tracks.gospa.root.total"), 0.0, 1e-6);
}

TEST(TrackJudge, WhatHasNoDataIsNoNumber) {
  const FigureList f = judged(50, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    tracks = {track_of(7, objects[0])};
  });
  EXPECT_EQ(f.value("tracks.truck.all_ranges.objects"), 0.0);
  for (const char* const what : {"objects_found", "found_share", "tracked_share", "delay_median_s", "along_rms_m",
                                 "identity_switches", "inside_95_share"}) {
    EXPECT_TRUE(std::isnan(f.value(std::string("tracks.truck.all_ranges.") + what))) << what;
    EXPECT_TRUE(std::isnan(f.value(std::string("tracks.car.60_100m.") + what))) << what;
  }
  const FigureList nothing = judged(0, [](int, TrackSet&, ObjectSet&) {});
  for (const Figure& figure : nothing.all()) {
    EXPECT_EQ(std::isnan(figure.value), figure.name != "tracks.lists") << figure.name;
  }
}

TEST(TrackJudge, MissedObjectCostsTenAList) {
  const FigureList f = judged(30, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0), true_car(2, 40.0, 0.0)};
    tracks = {track_of(7, objects[0])};
  });
  EXPECT_EQ(f.value("tracks.all.all_ranges.objects_found"), 1.0);
  EXPECT_EQ(f.value("tracks.all.all_ranges.found_share"), 0.5);
  EXPECT_EQ(f.value("tracks.all.all_ranges.tracked_share"), 0.5);
  for (const char* const base : {"squared", "root"}) {
    EXPECT_NEAR(f.value(std::string("tracks.gospa.") + base + ".total"), 10.0, 1e-6);
    EXPECT_DOUBLE_EQ(f.value(std::string("tracks.gospa.") + base + ".missed"), 10.0);
  }
}

TEST(TrackJudge, TentativeTracksFindNothing) {
  const FigureList f = judged(30, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    tracks = {track_of(7, objects[0])};
    tracks[0].confirmed = false;
  });
  EXPECT_EQ(f.value("tracks.all.all_ranges.tracked_share"), 0.0);
  EXPECT_EQ(f.value("tracks.false.all_ranges.tracks"), 0.0);
}

TEST(TrackJudge, FalseTracksAreCountedByTheirLife) {
  // Of 40 lists, a track lives 31 lists (3.0 s), one 11 (1.0 s), one 3 (0.2 s).
  const FigureList f = judged(40, [](int i, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    tracks = {track_of(7, objects[0])};
    if (i < 31) tracks.push_back(track_at(8, 20.0, 10.0));
    if (i >= 10 && i < 21) tracks.push_back(track_at(9, 50.0, -10.0));
    if (i >= 30 && i < 33) tracks.push_back(track_at(10, 10.0, -10.0));
  });
  EXPECT_EQ(f.value("tracks.false.all_ranges.tracks"), 3.0);
  EXPECT_EQ(f.value("tracks.false.all_ranges.at_least_0.5_s"), 2.0);
  EXPECT_EQ(f.value("tracks.false.all_ranges.at_least_2_s"), 1.0);
  EXPECT_EQ(f.value("tracks.false.0_30m.at_least_0.5_s"), 1.0);
  EXPECT_EQ(f.value("tracks.false.30_60m.at_least_0.5_s"), 1.0);
  EXPECT_DOUBLE_EQ(f.value("tracks.false.all_ranges.mean_at_a_time"), 45.0 / 40.0);
  EXPECT_DOUBLE_EQ(f.value("tracks.gospa.root.false"), 10.0 * 45.0 / 40.0);
}

TEST(TrackJudge, TrackIsFalseOnlyIfItIsAtNoObjectForMostOfItsLife) {
  for (const int at_object : {19, 21}) {
    const FigureList f = judged(40, [at_object](int i, TrackSet& tracks, ObjectSet& objects) {
      objects = {true_car(1, 20.0, 0.0)};
      tracks = {i < at_object ? track_at(7, 20.0, 0.0) : track_at(7, 20.0, 12.0)};
    });
    EXPECT_EQ(f.value("tracks.false.all_ranges.tracks"), at_object == 19 ? 1.0 : 0.0);
  }
}

TEST(TrackJudge, TrackAtAHiddenOrFarObjectIsNotFalse) {
  const FigureList f = judged(40, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0), true_car(2, 101.0, 0.0)};
    objects[0].in_view = false;
    tracks = {track_of(7, objects[0]), track_at(8, 98.0, 0.0)};
  });
  EXPECT_EQ(f.value("tracks.false.all_ranges.tracks"), 0.0);
  EXPECT_EQ(f.value("tracks.all.all_ranges.objects"), 0.0);
  EXPECT_EQ(f.value("tracks.gospa.root.total"), 0.0);
}

TEST(TrackJudge, TrackAtAParkedObjectIsFalseUnlessItSaysThatItStands) {
  for (const MovementState movement : {MovementState::kMoving, MovementState::kStationary, MovementState::kStopped}) {
    const FigureList f = judged(40, [movement](int, TrackSet& tracks, ObjectSet& objects) {
      objects = {true_car(1, 20.0, 0.0)};
      objects[0].parked = true;
      tracks = {track_of(7, objects[0])};
      tracks[0].movement = movement;
    });
    EXPECT_EQ(f.value("tracks.false.all_ranges.tracks"), movement == MovementState::kMoving ? 1.0 : 0.0);
    EXPECT_EQ(f.value("tracks.gospa.root.total"), movement == MovementState::kMoving ? 10.0 : 0.0);
    EXPECT_EQ(f.value("tracks.all.all_ranges.objects"), 0.0);
  }
}

TEST(TrackJudge, SecondTrackAtAnObjectIsADuplicateAndNotFalse) {
  const FigureList f = judged(20, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    tracks = {track_of(7, objects[0]), track_at(8, 22.0, 0.0)};
  });
  EXPECT_EQ(f.value("tracks.false.all_ranges.tracks"), 0.0);
  EXPECT_DOUBLE_EQ(f.value("tracks.duplicates.mean_at_a_time"), 1.0);
  EXPECT_DOUBLE_EQ(f.value("tracks.gospa.root.false"), 10.0);
}

TEST(TrackJudge, NewTrackAtAnObjectIsAnIdentitySwitch) {
  const FigureList f = judged(40, [](int i, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    tracks = {track_of(i < 20 ? 7 : 8, objects[0])};
  });
  EXPECT_EQ(f.value("tracks.all.all_ranges.identity_switches"), 1.0);
  EXPECT_EQ(f.value("tracks.all.all_ranges.fragmentations"), 0.0);
}

TEST(TrackJudge, NearbyTrackDoesNotTakeAnObjectFromItsTrack) {
  // The second track fits better, but the first one is still at the object.
  const FigureList f = judged(40, [](int i, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    tracks = {track_at(7, 19.0, 0.0)};
    if (i >= 20) tracks.push_back(track_at(8, 20.0, 0.0));
  });
  EXPECT_EQ(f.value("tracks.all.all_ranges.identity_switches"), 0.0);
  EXPECT_NEAR(f.value("tracks.all.all_ranges.along_rms_m"), 1.0, 1e-12);
}

TEST(TrackJudge, ReturnAfterAGapIsAFragmentation) {
  const FigureList f = judged(40, [](int i, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    if (i < 10 || i >= 15) tracks = {track_of(7, objects[0])};
  });
  EXPECT_EQ(f.value("tracks.all.all_ranges.fragmentations"), 1.0);
  EXPECT_EQ(f.value("tracks.all.all_ranges.identity_switches"), 0.0);
  EXPECT_DOUBLE_EQ(f.value("tracks.all.all_ranges.tracked_share"), 35.0 / 40.0);
}

TEST(TrackJudge, PairsBeyondTheCapacityOfTheAssignmentAreCounted) {
  const auto not_considered = [](std::uint32_t tracks_in_both_cars) {
    const FigureList f = judged(1, [&](int, TrackSet& tracks, ObjectSet& objects) {
      objects = {true_car(1, 20.0, 0.0), true_car(2, 20.0, 1.0)};
      for (std::uint32_t id = 1; id <= tracks_in_both_cars; ++id) tracks.push_back(track_at(id, 20.0, 0.5));
    });
    return f.value("tracks.pairs_not_considered");
  };
  EXPECT_EQ(not_considered(100), 0.0);
  EXPECT_GT(not_considered(150), 0.0);
}

TEST(TrackJudge, DelayCountsFromFirstSightOfEachStay) {
  // In view from 0 s to 1.9 s with a track from 0.5 s on, and again from 4 s to 5.9 s with a track from 4.3 s on.
  const FigureList f = judged(60, [](int i, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    objects[0].in_view = i < 20 || i >= 40;
    if ((i >= 5 && i < 20) || i >= 43) tracks = {track_of(i < 20 ? 7 : 8, objects[0])};
  });
  EXPECT_EQ(f.value("tracks.car.all_ranges.stays"), 2.0);
  EXPECT_EQ(f.value("tracks.car.all_ranges.stays_found"), 2.0);
  EXPECT_NEAR(f.value("tracks.car.all_ranges.delay_median_s"), 0.4, 1e-9);
  EXPECT_NEAR(f.value("tracks.car.all_ranges.delay_max_s"), 0.5, 1e-9);
  EXPECT_EQ(f.value("tracks.car.all_ranges.objects"), 1.0);
  EXPECT_EQ(f.value("tracks.car.all_ranges.identity_switches"), 0.0) << "a new stay";
}

TEST(TrackJudge, ErrorsAreAlongAndAcrossTheTrueHeading) {
  const FigureList f = judged(20, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0, M_PI / 2.0)};
    tracks = {track_of(7, objects[0])};
    tracks[0].position_m += Eigen::Vector2d(-0.3, 0.8);  // heading to the left: 0.8 m ahead, 0.3 m to the left
    tracks[0].velocity_mps *= 0.9;
    tracks[0].heading_rad += 0.1 - 2.0 * M_PI;
    tracks[0].length_m += 0.5;
    tracks[0].width_m -= 0.2;
  });
  EXPECT_NEAR(f.value("tracks.all.all_ranges.along_rms_m"), 0.8, 1e-9);
  EXPECT_NEAR(f.value("tracks.all.all_ranges.across_rms_m"), 0.3, 1e-9);
  EXPECT_NEAR(f.value("tracks.all.all_ranges.speed_rms_mps"), 1.0, 1e-9);
  EXPECT_NEAR(f.value("tracks.all.all_ranges.heading_rms_deg"), 0.1 * 180.0 / M_PI, 1e-9);
  EXPECT_NEAR(f.value("tracks.all.all_ranges.length_rms_m"), 0.5, 1e-9);
  EXPECT_NEAR(f.value("tracks.all.all_ranges.width_rms_m"), 0.2, 1e-9);
}

TEST(TrackJudge, GaussianErrorsLieInTheirEllipseNinetyFiveTimesOfAHundred) {
  Eigen::Matrix2d covariance;
  covariance << 0.25, 0.1, 0.1, 0.09;
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  constexpr int kLists = 20'000;
  const auto drive = [&](double factor) {
    return judged(kLists, [&](int, TrackSet& tracks, ObjectSet& objects) {
      objects = {true_car(1, 20.0, 0.0)};
      tracks = {track_of(7, objects[0])};
      tracks[0].position_m += root * Eigen::Vector2d(normal(random), normal(random));
      tracks[0].position_covariance_m2 = factor * covariance;
    });
  };
  // Four standard deviations of the share: 4·√(0.95·0.05/20000) = 0.006.
  EXPECT_NEAR(drive(1.0).value("tracks.all.all_ranges.inside_95_share"), 0.95, 0.006);
  EXPECT_NEAR(drive(0.25).value("tracks.all.all_ranges.inside_95_share"), 1.0 - std::exp(-0.5 * 5.991464547 / 4.0),
              0.014);
}

TEST(TrackJudge, TracksWithoutCovarianceHaveNoShareInside) {
  const FigureList f = judged(20, [](int, TrackSet& tracks, ObjectSet& objects) {
    objects = {true_car(1, 20.0, 0.0)};
    tracks = {track_of(7, objects[0])};
    tracks[0].position_covariance_m2.setConstant(NAN);
  });
  EXPECT_TRUE(std::isnan(f.value("tracks.all.all_ranges.inside_95_share")));
}

TEST(TrackJudge, FiguresDoNotDependOnTheFrame) {
  const auto drive = [](double turn_rad) {
    return judged(30, [turn_rad](int i, TrackSet& tracks, ObjectSet& objects) {
      const Eigen::Rotation2Dd turn(turn_rad);
      objects = {true_car(1, 20.0 + 0.1 * i, 0.0, 0.4), true_car(2, 40.0, 10.0, -0.4)};
      tracks = {track_at(7, 20.5 + 0.1 * i, 0.4), track_at(8, 30.0, -20.0)};
      for (TrueObject& object : objects) {
        object.box.position_m = turn * object.box.position_m;
        object.box.velocity_mps = turn * object.box.velocity_mps;
        object.box.heading_rad += turn_rad;
      }
      for (ScoredTrack& track : tracks) {
        track.position_m = turn * track.position_m;
        track.velocity_mps = turn * track.velocity_mps;
        track.heading_rad += turn_rad;
      }
    });
  };
  const FigureList straight = drive(0.0), turned = drive(2.0);
  for (const Figure& figure : straight.all()) {
    const double other = turned.value(figure.name);
    if (std::isnan(figure.value)) {
      EXPECT_TRUE(std::isnan(other)) << figure.name;
    } else {
      EXPECT_NEAR(figure.value, other, 1e-6) << figure.name;
    }
  }
}

TEST(TrackJudge, ClassesOfTruthTablesAreKnown) {
  EXPECT_EQ(class_of_word("van"), ObjectClass::kCar);
  EXPECT_EQ(class_of_word("bus"), ObjectClass::kTruck);
  EXPECT_EQ(class_of_word("cyclist"), ObjectClass::kTwoWheeler);
  EXPECT_EQ(class_of_word("person"), ObjectClass::kPedestrian);
  EXPECT_EQ(class_of_word("horse"), ObjectClass::kUnknown);
}

}  // namespace
}  // namespace boresight::judge
