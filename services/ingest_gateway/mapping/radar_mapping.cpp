// Mapping files of kind "radar".
#include <string>
#include <utility>
#include <vector>

#include "services/ingest_gateway/mapping/detection_group.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "services/ingest_gateway/mapping/radar_parts.hpp"
#include "services/ingest_gateway/mapping/resolver.hpp"

namespace boresight::ingest {

namespace {

using dbc::CycleEnd;

/// Reads the cycle and its header; the detections are read separately.
class RadarReader {
 public:
  RadarReader(config::Reader root, const LoadDatabase& load)
      : root_(std::move(root)), names_(root_, "radar", load), radar_(names_) {}

  dbc::RadarMapping run() {
    std::string last_message;
    config::Reader cycle = root_.table("cycle");
    cycle.require("end");
    radar_.mapping().cycle_end = cycle.choice<CycleEnd>("end",
                                                        {{"all_messages", CycleEnd::kAllMessages},
                                                         {"last_message", CycleEnd::kLastMessage},
                                                         {"count", CycleEnd::kCount},
                                                         {"timeout", CycleEnd::kTimeout}},
                                                        CycleEnd::kTimeout);
    radar_.mapping().timeout_ns = cycle.integer("timeout_ms", {1, 1000}, 20) * 1'000'000;
    if (radar_.mapping().cycle_end == CycleEnd::kLastMessage) cycle.require("last_message");
    last_message = cycle.text("last_message", "");
    if (!last_message.empty() && radar_.mapping().cycle_end != CycleEnd::kLastMessage) {
      cycle.reject("last_message", "is allowed with end = \"last_message\" only");
    }
    if (root_.has("header")) read_header(root_.table("header"), last_message);
    if (radar_.mapping().cycle_end == CycleEnd::kCount && !radar_.has_counts()) {
      cycle.reject("end", "\"count\" needs a table header with counts");
    }
    root_.require("detections");
    for (config::Reader& group : root_.tables("detections")) read_detection_group(group, names_, radar_);
    if (radar_.mapping().cycle_end == CycleEnd::kLastMessage) {
      if (const dbc::Message* const last = names_.message(cycle, "last_message", last_message)) {
        radar_.entry(cycle, "last_message", *last).is_last = true;
      }
    }
    if (radar_.mapping().parts_of_slot.empty()) root_.reject("detections", "there are none");
    root_.finish();
    return radar_.finish();
  }

 private:
  void read_header(config::Reader table, const std::string& last_message) {
    table.require("message");
    const std::string name = table.text("message", "");
    Protection protection(table, 1);
    const std::vector<std::string> counts = table.texts("counts", {});
    const std::string counter = table.text("counter", "");
    const dbc::Message* const message = names_.message(table, "message", name);
    if (message == nullptr) return;
    dbc::RadarMessage& header = radar_.entry(table, "message", *message);
    header.is_header = true;
    protection.apply(header.frame, 0);
    // A header in the last message is a trailer.
    radar_.mapping().header_begins_cycle = name != last_message;
    if (!radar_.mapping().header_begins_cycle && radar_.mapping().cycle_end == CycleEnd::kCount) {
      table.reject("message", "a count must come before the detections");
    }
    for (const std::string& count : counts) {
      const dbc::Signal* const signal = names_.signal(table, "counts", *message, count);
      if (signal != nullptr) header.counts.push_back(map_signal(*message, *signal));
    }
    if (!counter.empty()) {
      if (const dbc::Signal* const signal = names_.signal(table, "counter", *message, counter)) {
        radar_.add_counter(table, header, *message, *signal);
      }
    }
  }

  config::Reader root_;
  Resolver names_;
  RadarParts radar_;
};

}  // namespace

dbc::RadarMapping read_radar_mapping(config::Reader root, const LoadDatabase& load) {
  return RadarReader(std::move(root), load).run();
}

}  // namespace boresight::ingest
