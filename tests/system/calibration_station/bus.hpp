// The alignment estimator's partners on the bus: two radars in front of plates, and a reader of its estimates and
// status.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/service_status.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::calibration_station {

inline constexpr std::uint32_t kRadarAtPlate = 2;  ///< radar 1 sees a plate as well, which never moves

/// The radar's scene; the test changes it while the radar measures.
struct Scene {
  volatile double tilt_rad;
  volatile double yaw_rad, pitch_rad;  ///< of the radar, truth
  volatile bool is_plate_there;
  volatile bool has_maximum;       ///< otherwise the amplitude grows to both sides
  volatile double disturbance_db;  ///< added to every scan's amplitude
  volatile double speed_mps;       ///< of the vehicle, as signalled
};

/// Publishes scans of both radars and ego motion 100 times a second, in place of the gateway.
class PlateRadars {
 public:
  PlateRadars();
  [[nodiscard]] Scene& scene() { return *scene_; }
  [[nodiscard]] bool stop() { return process_->stop() == 0; }

 private:
  int run();
  harness::Shared<Scene> scene_;
  std::unique_ptr<harness::Child> process_;
};

/// The estimator's latest messages.
class Reader {
 public:
  Reader();
  [[nodiscard]] bool stop() { return process_->stop() == 0; }
  [[nodiscard]] ServiceStatus status() const { return log_->statuses[log_->number_of_statuses % 2]; }
  [[nodiscard]] std::size_t number_of_statuses() const { return log_->number_of_statuses; }
  [[nodiscard]] AlignmentEstimate estimate(std::uint32_t radar) const {
    return log_->estimates[radar][log_->number_of_estimates[radar] % 2];
  }
  [[nodiscard]] std::size_t number_of_estimates(std::uint32_t radar) const { return log_->number_of_estimates[radar]; }

 private:
  struct Log {
    volatile bool attached;
    volatile std::size_t number_of_statuses;
    std::array<volatile std::size_t, 3> number_of_estimates;
    std::array<ServiceStatus, 2> statuses;  // alternating, so that readers and writer use different ones
    std::array<std::array<AlignmentEstimate, 2>, 3> estimates;
  };
  int run();
  harness::Shared<Log> log_;
  std::unique_ptr<harness::Child> process_;
};

}  // namespace boresight::calibration_station
