// A direction in the plane with its uncertainty.
#pragma once

namespace boresight::tracking {

struct Heading {
  double rad = 0.0;
  double variance_rad2 = 0.0;
};

}  // namespace boresight::tracking
