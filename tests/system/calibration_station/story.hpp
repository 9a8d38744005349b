// Common part of the tests in this folder: two hosts, a bus with radars in front of a plate, the estimator's process,
// and a capture of all traffic between ECU and station for other decoders.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/system/calibration_station/bus.hpp"
#include "tests/system/calibration_station/station.hpp"
#include "tests/system/harness/roudi.hpp"
#include "tests/system/harness/two_hosts.hpp"

namespace boresight::calibration_station {

inline constexpr double kDegree_rad = 0.017453292519943295;
inline constexpr std::size_t kVerdict = service::verdict::kState;  ///< offset of the state record in a verdict
inline constexpr double kPositioningTimeout_s = 1.5, kSilenceTimeout_s = 0.6;

class Story : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;
  void TearDown() override;

  static network::TwoHosts& hosts() { return shared_->hosts; }
  static Scene& scene() { return shared_->radars.scene(); }
  static Reader& reader() { return shared_->reader; }

  /// The shipped configuration, with the calibration service switched on or unchanged.
  static void write_configuration(bool enabled = true);
  void start_estimator();
  void stop_estimator();
  /// A station with the service's endpoint.
  [[nodiscard]] static Station station(std::uint16_t client = 0x17);
  /// Sends the start of a run with these tilts (hundredths of a degree), 10 scans each.
  static Answer start(Station& station);
  /// Brings the plate to the tilt, measures, and waits until the tilt is done; returns the state.
  static service::State measure(Station& station, std::size_t index);
  /// Measures all tilts from `first` on; returns the last verdict.
  static Answer finish(Station& station, std::size_t first = 0);
  /// Expects the scene's true values as result.
  static void expect_truth(const Answer& result);
  static ServiceStatus status_after_now();

  static inline const std::vector<std::int16_t> kTilts{-500, -400, -300, -200, -100, 0, 100, 200, 300, 400, 500};
  std::unique_ptr<harness::Child> estimator_;

 private:
  struct Shared {
    network::TwoHosts hosts;
    harness::Roudi roudi;
    PlateRadars radars;
    Reader reader;
    std::unique_ptr<harness::Child> capture;
  };
  static void judge_capture();
  static std::unique_ptr<Shared> shared_;
};

}  // namespace boresight::calibration_station
