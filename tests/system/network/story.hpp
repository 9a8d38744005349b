// Common part of the tests in this folder: two hosts, a bus with a witness, gateways and servers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/system/harness/roudi.hpp"
#include "tests/system/harness/two_hosts.hpp"
#include "tests/system/network/offers.hpp"
#include "tests/system/network/witness.hpp"

namespace boresight::network {

inline constexpr const char* kGroupV4 = "224.244.224.245";
inline constexpr const char* kGroupV6 = "ff14::4:c0";
inline constexpr double kOfferCycle_s = 1.0;

/// The network and the bus are set up once for all tests.
class Story : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;
  void TearDown() override;

  static TwoHosts& hosts() { return shared_->hosts; }
  static Witness& witness() { return shared_->witness; }

  /// A vehicle of two radars and ego motion from the Boresight service at that address of the ECU.
  static void write_vehicle(const std::string& address, const std::string& discovery_group);
  static void write_vehicle_file(const std::string& content);
  void start_gateway();
  void stop_gateway();
  /// Both radars with `detections` in each scan, 20 times a second.
  void start_server(const std::string& address = kServerAddress, const std::vector<std::string>& options = {},
                    unsigned detections = 100);
  [[nodiscard]] static std::unique_ptr<harness::Child> start_replay(const std::vector<std::string>& options);
  void kill_server();
  void stop_server();

  /// Waits for scans of both radars that were received since `since_ns`. Returns the time of the later of the two first
  /// scans; 0 and a failure after the time-out.
  static std::int64_t wait_for_scans(std::int64_t since_ns, double seconds);
  /// Waits for the first offer and for scans after it; expects that they come within an offer cycle, prints the time.
  void expect_flow_after_offer(const std::string& what);
  /// Expects scans within the given time from now, and prints the time that it took.
  void expect_flow(const std::string& what, double seconds);
  /// True if no scan arrives during this time from now on.
  static bool is_silent(double seconds);
  /// Waits for the gateway's next status.
  static ServiceStatus status_after_now();

  std::unique_ptr<harness::Child> gateway_;
  std::unique_ptr<harness::Child> server_;
  std::unique_ptr<Offers> offers_;
  std::size_t first_scan_ = 0;  // of this test
  bool scans_are_synthetic_ = true;

 private:
  struct Shared {
    TwoHosts hosts;
    harness::Roudi roudi;
    Witness witness;
  };
  static std::unique_ptr<Shared> shared_;
};

}  // namespace boresight::network
