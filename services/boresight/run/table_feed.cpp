#include "services/boresight/run/table_feed.hpp"

namespace boresight::run {

TableFeed::TableFeed(input::DriveReader& drive, input::EgoReader& ego, Chain& chain)
    : drive_(drive), ego_(ego), chain_(chain), has_motion_(ego.next(motion_, motion_s_)) {}

void TableFeed::add_ego() {
  const std::int64_t time_ns = ego_.time_ns();
  chain_.advance(time_ns);
  chain_.add_ego(motion_, time_ns);
  newest_ns_ = time_ns;
  has_motion_ = ego_.next(motion_, motion_s_);
}

bool TableFeed::next() {
  double scan_s = 0.0;
  if (!drive_.next(*scan_, scan_s)) {
    while (has_motion_) add_ego();
    return false;
  }
  const std::int64_t time_ns = drive_.time_ns();
  while (has_motion_ && newest_ns_ <= time_ns) add_ego();
  chain_.advance(time_ns);
  SourceStatistics& source = chain_.sources[scan_->header.source_id];
  ++source.messages;
  source.last_measurement_time_ns = time_ns;
  chain_.add_scan(*scan_, time_ns);
  return true;
}

}  // namespace boresight::run
