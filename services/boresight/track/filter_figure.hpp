// The figure of Liang and Guo 2016: one object over time, measured, filtered and true.
#pragma once

#include <string>
#include <string_view>

#include "services/boresight/track/filter_run.hpp"

namespace boresight::track {

/// Charts of range, azimuth and range rate over time, measured, filtered and, if it is known, true; and of their errors
/// with two standard deviations.
[[nodiscard]] std::string filter_svg(std::string_view filter, const RadarMeasurements& measurements,
                                     const FilterRun& run, double step_s);

}  // namespace boresight::track
