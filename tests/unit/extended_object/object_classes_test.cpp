#include "services/common/extended_object/object_classes.hpp"

#include <gtest/gtest.h>

namespace boresight::extended_object {
namespace {

TEST(ObjectClassTable, DefaultsAreCompleteAndPlausible) {
  const ObjectClassTable table = object_class_table_defaults();
  double prior = 0.0;
  for (const ObjectClassModel& m : table) {
    prior += m.prior_share;
    EXPECT_GT(m.size.length_mean_m, 2.0 * m.size.length_std_m);
    EXPECT_GT(m.size.width_mean_m, 2.0 * m.size.width_std_m);
    EXPECT_GT(m.size.height_m, 1.0);
    EXPECT_GT(m.motion.largest_speed_mps, 2.0 * m.motion.typical_speed_mps);
    EXPECT_LT(m.motion.birth_speed_std_mps, m.motion.largest_speed_mps);
    EXPECT_GE(m.motion.along_acceleration_density_m2ps3, m.motion.across_acceleration_density_m2ps3 * 0.99);
    EXPECT_GT(m.motion.across_acceleration_density_m2ps3, 0.0);
    EXPECT_GT(m.count.mean_at_30m, 0.0);
    EXPECT_GT(m.count.dispersion_shape, 0.0);
    EXPECT_GT(m.places.decay_m, 0.0);
    for (const double share : {m.places.interior_share, m.micro_doppler.rear_share, m.micro_doppler.side_share,
                               m.micro_doppler.front_share, m.micro_doppler.large_share}) {
      EXPECT_GE(share, 0.0);
      EXPECT_LE(share, 1.0);
    }
    EXPECT_GE(m.places.scan_correlation, 0.0);
    EXPECT_LT(m.places.scan_correlation, 1.0);
    EXPECT_GT(m.strength.std_db, 0.0);
  }
  EXPECT_NEAR(prior, 1.0, 1e-12);
}

TEST(ObjectClassTable, LargerClassesAreLongerAndDetectedMoreOften) {
  const ObjectClassTable table = object_class_table_defaults();
  for (std::size_t i = 1; i < kRoadUserClasses; ++i) {
    EXPECT_GT(table[i].size.length_mean_m, table[i - 1].size.length_mean_m);
    EXPECT_GE(table[i].count.mean_at_30m, table[i - 1].count.mean_at_30m);
  }
}

TEST(ObjectClassTable, NamesAreInTheOrderOfConfigurationFiles) {
  EXPECT_EQ(name_of(RoadUserClass::kPedestrian), "pedestrian");
  EXPECT_EQ(name_of(RoadUserClass::kTwoWheeler), "two_wheeler");
  EXPECT_EQ(name_of(RoadUserClass::kTruck), "truck");
  const ObjectClassTable table = object_class_table_defaults();
  EXPECT_EQ(&model_of(table, RoadUserClass::kCar), &table[2]);
}

}  // namespace
}  // namespace boresight::extended_object
