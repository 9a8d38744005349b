// The box of a track.
#include "services/tracker/core/extent.hpp"

#include <limits>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "tests/unit/tracker/scene.hpp"

namespace boresight::tracking {
namespace {

TEST(Extent, HidesWhatLiesBehindIt) {
  Extent car;
  car.heading_rad = 90.0 * kRadiansPerDegree;
  car.length_m = 4.0;
  car.width_m = 2.0;
  const Eigen::Vector2d centre(10.0, 0.0);
  EXPECT_TRUE(car.hides(centre, {0.0, 0.0}, {20.0, 0.0}));
  EXPECT_TRUE(car.hides(centre, {0.0, 1.9}, {20.0, 1.9})) << "it is 4 m wide across";
  EXPECT_FALSE(car.hides(centre, {0.0, 2.1}, {20.0, 2.1})) << "beside";
  EXPECT_FALSE(car.hides(centre, {0.0, 0.0}, {8.0, 0.0})) << "before";
  EXPECT_FALSE(car.hides(centre, {0.0, 0.0}, {10.0, 0.5})) << "in it";
  EXPECT_FALSE(car.hides(centre, {15.0, 0.0}, {20.0, 0.0})) << "behind both";
}

TEST(Extent, KnowsWhichFacesAreSeen) {
  const Extent car{.heading_rad = 0.0, .length_m = 4.0, .width_m = 2.0};
  const Eigen::Vector2d centre(30.0, 0.0);
  const VisibleFaces from_behind = car.visible_faces(centre, {0.0, 0.0});
  EXPECT_EQ(from_behind.end, -1.0);
  EXPECT_EQ(from_behind.side, 0.0);
  const VisibleFaces from_aside = car.visible_faces(centre, {0.0, 20.0});
  EXPECT_EQ(from_aside.end, -1.0);
  EXPECT_EQ(from_aside.side, 1.0);
  const VisibleFaces from_inside = car.visible_faces(centre, centre);
  EXPECT_EQ(from_inside.end, 0.0);
  EXPECT_EQ(from_inside.side, 0.0);
}

TEST(Extent, OfWhatIsNearbyEachScanShowsAPieceOnly) {
  Extent near{.heading_rad = 0.0, .length_m = 16.0, .width_m = 2.5}, far = near;
  const Eigen::Vector2d centre(0.0, -3.5), velocity(20.0, 0.0);
  Cluster cluster{};
  cluster.strongest_dbsm = std::numeric_limits<double>::quiet_NaN();
  cluster.number_on_outline = 2;
  cluster.outline[0] = {3.0, -2.2};
  cluster.outline[1] = {7.0, -2.2};
  for (int i = 0; i < 100; ++i) {
    std::ignore = near.update(cluster, centre, velocity, {0.0, 0.0}, false);
    std::ignore = far.update(cluster, centre, velocity, {0.0, 40.0}, false);
  }
  EXPECT_GT(near.length_m, 14.0) << "alongside";
  EXPECT_LT(far.length_m, 12.0);
}

TEST(Extent, GrowsToWhatIsSeenBeyondItsEnd) {
  const Extent before{.heading_rad = M_PI / 2, .length_m = 10.0, .width_m = 2.0};
  const Eigen::Vector2d centre(5.0, 20.0), beside(0.0, 20.0);
  Cluster cluster{};
  cluster.number_on_outline = 1;
  cluster.outline[0] = {4.0, 28.0};  // 3 m beyond the front
  Extent box = before;
  Eigen::Vector2d place = centre;
  for (int i = 0; i < 50; ++i) place += box.grow_to(cluster, place, beside, 1.0);
  EXPECT_NEAR(box.length_m, 12.0, 1e-3);
  EXPECT_NEAR(place.y() - 0.5 * box.length_m, 15.0, 1e-9) << "the rear stays where it is";
  EXPECT_NEAR(place.x(), 5.0, 1e-9);
  box = before;
  EXPECT_EQ(box.grow_to(cluster, centre, {5.0, 0.0}, 1.0), Eigen::Vector2d(0.0, 0.0)) << "its ghost, from behind";
  EXPECT_EQ(box.grow_to(cluster, centre, beside, 4.0), Eigen::Vector2d(0.0, 0.0)) << "as the place is not known";
  EXPECT_EQ(box.length_m, 10.0);
  Extent car{.heading_rad = M_PI / 2, .length_m = 4.5, .width_m = 1.8};
  EXPECT_EQ(car.grow_to(cluster, centre, beside, 1.0), Eigen::Vector2d(0.0, 0.0)) << "the next car";
  cluster.outline[0] = {4.0, centre.y() + 3.35};
  EXPECT_EQ(car.grow_to(cluster, centre, {4.0, -20.0}, 0.3), Eigen::Vector2d(0.0, 0.0)) << "its ghost, at a slant";
  place = centre;
  for (int i = 0; i < 50; ++i) place += car.grow_to(cluster, place, beside, 0.3);
  EXPECT_NEAR(car.length_m, 5.3, 1e-3) << "a van that passed: its front was known, and now its rear is";
  for (int i = 0; i < 50; ++i) {
    cluster.outline[0] = {4.0, place.y() + 0.5 * car.length_m + 1.4};
    place += car.grow_to(cluster, place, beside, 0.3);
  }
  EXPECT_LE(car.length_m, 6.5) << "and no truck, with the car behind that closes up";
}

TEST(Extent, WhoWasTakenForAVehicleThatPassedIsSmallAgain) {
  const auto hear = [](Extent& extent, double dbsm) {
    for (int i = 0; i < 30; ++i) extent.hear(dbsm, 1.4);
  };
  Extent person, car;
  hear(person, -5.0);
  EXPECT_TRUE(person.is_small);
  hear(person, 12.0);
  EXPECT_FALSE(person.is_small);
  EXPECT_EQ(person.length_m, Extent::kCarLength_m);
  hear(person, 1.0);
  EXPECT_FALSE(person.is_small) << "not at the first doubt";
  hear(person, -5.0);
  EXPECT_TRUE(person.is_small);
  EXPECT_LT(person.length_m, 1.5);
  // What began as a vehicle and is hardly seen any more stays one.
  hear(car, 12.0);
  hear(car, -5.0);
  EXPECT_FALSE(car.is_small);
}

TEST(Extent, WhoseSideIsWeakAndShortIsNoVehicle) {
  const Eigen::Vector2d velocity(0.0, 1.4), sensor(0.0, 0.0);
  Cluster cluster{};
  cluster.number_of_detections = cluster.number_on_outline = 3;
  const auto see = [&](Extent& box, double dbsm, double length_m) {
    cluster.strongest_dbsm = dbsm;
    for (int i = 0; i < 60; ++i) {
      cluster.outline = {{{8.0, -0.5 * length_m}, {8.0, 0.0}, {8.0, 0.5 * length_m}}};
      std::ignore = box.update(cluster, {8.5, 0.0}, velocity, sensor, false);
    }
  };
  // Something strong was near when they came into sight.
  const auto begun = [] {
    Extent box{.heading_rad = M_PI / 2};
    box.hear(10.0, 1.4);
    return box;
  };
  Extent person = begun(), car = begun(), end_of_a_car = begun(), long_one = begun();
  see(person, -9.0, 0.5);
  EXPECT_TRUE(person.is_small);
  EXPECT_LT(person.length_m, 1.3);
  see(car, 8.0, 0.5);
  EXPECT_FALSE(car.is_small) << "of a strong side only a part was seen";
  EXPECT_GT(car.length_m, 2.5);
  see(long_one, -9.0, 4.0);
  EXPECT_FALSE(long_one.is_small) << "weak, but as long as a car";
  end_of_a_car.heading_rad = 0.0;
  see(end_of_a_car, -9.0, 0.5);
  EXPECT_FALSE(end_of_a_car.is_small) << "its side was not seen";
}

TEST(Extent, GrowsAwayFromTheFacesThatAreSeen) {
  Extent box{.heading_rad = 0.4, .length_m = 4.0, .width_m = 1.8};
  const Eigen::Vector2d centre(20.0, 5.0), velocity(10.0, 0.0), sensor(0.0, 0.0);
  const VisibleFaces faces = box.visible_faces(centre, sensor);
  ASSERT_NE(faces.end, 0.0);
  ASSERT_NE(faces.side, 0.0);
  const auto corner = [&](const Eigen::Vector2d& middle) -> Eigen::Vector2d {
    return middle + box.from_body({0.5 * faces.end * box.length_m, 0.5 * faces.side * box.width_m});
  };
  Cluster cluster{};
  cluster.strongest_dbsm = 10.0;
  cluster.number_on_outline = 2;
  cluster.outline[0] = corner(centre);
  cluster.outline[1] = cluster.outline[0] - box.from_body({faces.end * 7.0, 0.0});
  const Eigen::Vector2d before = corner(centre);
  Eigen::Vector2d middle = centre;
  for (int i = 0; i < 10; ++i) middle += box.update(cluster, middle, velocity, sensor, false);
  EXPECT_GT(box.length_m, 6.0);
  EXPECT_LT((corner(middle) - before).norm(), 1e-9) << "the corner that is seen stays where it is";
}

TEST(Extent, GrowsWithWhatIsSeenAndKeepsWhatIsNot) {
  Extent extent;
  Cluster cluster{};
  cluster.number_of_detections = cluster.number_on_outline = 2;
  cluster.outline[0] = {20.0, -0.9};
  cluster.outline[1] = {20.0, 0.9};
  for (int i = 0; i < 300; ++i) std::ignore = extent.update(cluster, {22.0, 0.0}, {10.0, 0.0}, {0.0, 0.0}, true);
  EXPECT_NEAR(extent.length_m, 4.5, 1e-9) << "from behind the length is not seen";
  EXPECT_NEAR(extent.width_m, 1.8, 0.01);
  cluster.outline[1] = {28.0, -0.9};
  for (int i = 0; i < 20; ++i) std::ignore = extent.update(cluster, {24.0, 0.0}, {10.0, 0.0}, {0.0, -20.0}, true);
  EXPECT_NEAR(extent.length_m, 8.0, 0.05);
  EXPECT_EQ(extent.object_class(), ObjectClass::kTruck);
  cluster.outline[1] = {22.0, -0.9};
  for (int i = 0; i < 20; ++i) std::ignore = extent.update(cluster, {24.0, 0.0}, {10.0, 0.0}, {0.0, -20.0}, true);
  EXPECT_GT(extent.length_m, 7.0) << "a few scans that show a part of it";
  for (int i = 0; i < 2000; ++i) std::ignore = extent.update(cluster, {24.0, 0.0}, {10.0, 0.0}, {0.0, -20.0}, true);
  EXPECT_NEAR(extent.length_m, 2.0, 0.1);
}

TEST(Extent, IsAPersonsAsLongAsItReflectsAndMovesAsOne) {
  Extent person;
  person.hear(-6.0, 1.4);
  EXPECT_LT(person.length_m, 2.0);
  EXPECT_LT(person.width_m, 1.0);
  for (int i = 0; i < 5; ++i) person.hear(-14.0, 1.4);
  EXPECT_TRUE(person.is_small) << "limbs only";
  Cluster two{};
  two.number_of_detections = two.number_on_outline = 2;
  two.outline[0] = {10.0, -2.0};
  two.outline[1] = {10.0, 2.0};
  for (int i = 0; i < 20; ++i) std::ignore = person.update(two, {10.0, 0.0}, {0.0, 1.4}, {0.0, 0.0}, false);
  EXPECT_LE(person.length_m, 2.0) << "no longer than a cycle, whoever is beside";
  person.hear(5.0, 1.4);
  EXPECT_TRUE(person.is_small) << "one strong echo";
  for (int i = 0; i < 20; ++i) person.hear(10.0, 1.4);
  EXPECT_FALSE(person.is_small) << "a car that showed its wheels first";
  EXPECT_EQ(person.length_m, 4.5);
  EXPECT_EQ(person.width_m, 1.8);

  for (const auto& [dbsm, speed_mps] : {std::pair{8.0, 1.4}, std::pair{-6.0, 12.0}, std::pair{-20.0, 1.4},
                                        std::pair{std::numeric_limits<double>::quiet_NaN(), 1.4}}) {
    Extent vehicle;
    vehicle.hear(dbsm, speed_mps);
    EXPECT_EQ(vehicle.length_m, 4.5) << dbsm << " dBsm, " << speed_mps << " m/s";
  }
}

TEST(Extent, ShowsItsSideToWhoStandsBesideItsTrack) {
  const Extent box{.heading_rad = M_PI / 2, .length_m = 4.0, .width_m = 2.0};
  const Eigen::Vector2d centre(5.0, 10.0);
  EXPECT_FALSE(box.shows_side(centre, {5.0, -30.0}));
  EXPECT_FALSE(box.shows_side(centre, {6.9, -30.0})) << "its own lane";
  EXPECT_TRUE(box.shows_side(centre, {7.1, -30.0}));
  EXPECT_TRUE(box.shows_side(centre, {2.9, 10.0}));
}

TEST(Extent, IsAsWideAsVehiclesAre) {
  Extent wide{.heading_rad = 0.0, .length_m = 4.5, .width_m = 1.9}, narrow = wide;
  const Eigen::Vector2d centre(20.0, 0.0), velocity(10.0, 0.0), sensor(3.6, 0.0);
  Cluster cluster{};
  cluster.strongest_dbsm = std::numeric_limits<double>::quiet_NaN();
  cluster.number_on_outline = 3;
  for (int i = 0; i < 400; ++i) {
    cluster.outline[0] = {18.0, -2.5};
    cluster.outline[1] = {18.0, 2.5};
    cluster.outline[2] = {22.0, 0.0};
    std::ignore = wide.update(cluster, centre, velocity, sensor, false);
    cluster.outline[0] = {18.0, -0.1};
    cluster.outline[1] = {18.0, 0.1};
    std::ignore = narrow.update(cluster, centre, velocity, sensor, false);
  }
  EXPECT_NEAR(wide.width_m, 2.6, 1e-6);
  EXPECT_NEAR(narrow.width_m, 1.6, 1e-6);
}

TEST(Extent, IsNoWiderFarAheadWhereNoiseSpreadsWhatIsSeen) {
  // The rear of a car, 1.8 m wide, 80 m ahead: 0.8 m of noise across.
  std::mt19937 random(5);
  std::normal_distribution<double> noise_m(0.0, 0.8);
  std::uniform_real_distribution<double> on_rear_m(-0.9, 0.9);
  Extent extent;
  double sum_m = 0.0;
  for (int i = 0; i < 400; ++i) {
    Cluster cluster{};
    cluster.weight = 4.0;
    cluster.covariance_m2 = Eigen::Vector2d(0.01, 0.64 / 4.0).asDiagonal();
    for (int k = 0; k < 4; ++k) {
      cluster.outline[cluster.number_on_outline++] = {80.0, on_rear_m(random) + noise_m(random)};
    }
    std::ignore = extent.update(cluster, {82.25, 0.0}, {2.0, 0.0}, {3.6, 0.0}, false);
    sum_m += i < 100 ? 0.0 : extent.width_m / 300.0;
  }
  EXPECT_NEAR(sum_m, 1.8, 0.3);
}

TEST(Extent, LengthensToReachAnother) {
  Extent rear{.heading_rad = M_PI / 2, .length_m = 4.0, .width_m = 2.0};
  const Extent front{.heading_rad = M_PI / 2, .length_m = 3.0, .width_m = 2.0};
  const Eigen::Vector2d centre(5.0, 10.0), ahead(5.3, 15.0);
  EXPECT_TRUE(rear.in_file(centre, front, ahead, 2.0));
  EXPECT_FALSE(rear.in_file(centre, front, ahead, 1.0));
  EXPECT_FALSE(rear.in_file(centre, front, {6.5, 15.0}, 2.0)) << "beside its track";
  const Eigen::Vector2d moved = rear.lengthen(centre, ahead);
  EXPECT_NEAR(rear.length_m, 7.0, 1e-12);
  EXPECT_NEAR(moved.y(), 11.5, 1e-12);
  EXPECT_NEAR(moved.x(), 5.0, 1e-12);
  const Eigen::Vector2d back = rear.lengthen(moved, {5.0, 2.0}, 1.0);
  EXPECT_NEAR(rear.length_m, 8.0, 1e-12) << "no more than that";
  EXPECT_NEAR(back.y(), 11.0, 1e-12);
}

}  // namespace
}  // namespace boresight::tracking
