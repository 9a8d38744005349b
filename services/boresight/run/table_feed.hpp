// Hands the rows of tables to the chain in the order of time: config/schema/tables.md.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "services/boresight/run/chain.hpp"

namespace boresight::run {

/// A scan comes after the ego motions up to the first one that is newer, so that its own motion is interpolated: in the
/// vehicle the list of a radar arrives later than the ego motion of its measurement, too.
class TableFeed {
 public:
  /// All arguments must outlive the feed.
  TableFeed(input::DriveReader& drive, input::EgoReader& ego, Chain& chain);

  /// Hands over the next scan with the ego motions before it; false at the end, when the rest of them is read.
  bool next();

 private:
  void add_ego();

  input::DriveReader& drive_;
  input::EgoReader& ego_;
  Chain& chain_;
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  EgoMotion motion_{};
  double motion_s_ = 0.0;
  bool has_motion_;
  std::int64_t newest_ns_ = std::numeric_limits<std::int64_t>::min();  // of the motions handed over
};

}  // namespace boresight::run
