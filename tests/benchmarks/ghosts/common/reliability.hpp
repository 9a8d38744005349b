// Calibration of the ghost probability: of all detections given 80 %, 80 % must truly be ghosts or clutter.
#pragma once

#include "services/simulator/judge/reliability.hpp"

namespace boresight::bench {

using judge::Reliability;

}  // namespace boresight::bench
