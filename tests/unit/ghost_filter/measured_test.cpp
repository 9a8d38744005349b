#include "services/ghost_filter/core/classify/measured.hpp"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

namespace boresight::ghosts {

TEST(Measured, WhatTheCorrectorToldSaysHowADetectionIsJudged) {
  const auto scan = std::make_unique<CorrectedScan>();
  const auto kind = [&](std::uint16_t flags) {
    scan->detection_flags[3] = flags;
    return kind_of(*scan, 3);
  };
  EXPECT_EQ(kind(corrected_flag::kMoving), Kind::kMoving);
  EXPECT_EQ(kind(corrected_flag::kStationary | corrected_flag::kAmbiguous), Kind::kStationary);
  EXPECT_EQ(kind(0), Kind::kNotTold);
  for (const std::uint16_t rejected :
       {corrected_flag::kInvalid, corrected_flag::kOutsideRegion, corrected_flag::kWeak}) {
    EXPECT_EQ(kind(static_cast<std::uint16_t>(corrected_flag::kMoving | rejected)), Kind::kLeftOut);
  }
}

TEST(Measured, WhatIsNotKnownInThePlaneIsLeftOut) {
  const auto scan = std::make_unique<CorrectedScan>();
  scan->detection_flags[0] = corrected_flag::kMoving;
  for (DetectionColumn<float>* const column :
       {&scan->x_vehicle_m, &scan->y_vehicle_m, &scan->range_rate_over_ground_mps}) {
    for (const float not_finite : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      (*column)[0] = not_finite;
      EXPECT_EQ(kind_of(*scan, 0), Kind::kLeftOut);
    }
    (*column)[0] = 0.0F;
    EXPECT_EQ(kind_of(*scan, 0), Kind::kMoving);
  }
}

}  // namespace boresight::ghosts
