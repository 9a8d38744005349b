// What a simulated drive says about itself: the truth.csv beside its recordings.
#pragma once

#include <iosfwd>

#include "services/boresight/report/summary.hpp"

namespace boresight::report {

/// Lines "quantity,radar,value,unit" with quantities speed_scale and alignment_yaw (deg); others are for other readers.
/// What is not a number is left out, so the result may be empty (`known()` is false).
[[nodiscard]] Truth read_truth(std::istream& input);

}  // namespace boresight::report
