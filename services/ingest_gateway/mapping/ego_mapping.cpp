// Mapping files of kind "ego".
#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "services/ingest_gateway/mapping/resolver.hpp"

namespace boresight::ingest {

namespace {

class EgoReader {
 public:
  EgoReader(config::Reader root, const LoadDatabase& load) : root_(std::move(root)), names_(root_, "ego", load) {}

  dbc::EgoMapping run() {
    // The limits are those of a road vehicle.
    const bool has_speed = root_.has("speed"), has_pulses = root_.has("pulses");
    if (has_speed == has_pulses) root_.reject("", "needs either a table speed or a table pulses");
    if (has_speed) read_speed(root_.table("speed"));
    if (has_pulses) read_pulses(root_.table("pulses"));
    if (root_.has("yaw_rate")) {
      config::Reader table = root_.table("yaw_rate");
      read_quantity(table, Dimension::kAngularRate, "plausible_degps", kRadiansPerDegree, 120.0,
                    &dbc::EgoMessage::yaw_rate_radps);
    }
    if (root_.has("steering_angle")) {
      config::Reader table = root_.table("steering_angle");
      read_quantity(table, Dimension::kAngle, "plausible_deg", kRadiansPerDegree, 1080.0,
                    &dbc::EgoMessage::steering_angle_rad);
    }
    if (root_.has("reverse")) read_reverse(root_.table("reverse"));
    root_.finish();
    std::sort(mapping_.messages.begin(), mapping_.messages.end(),
              [](const auto& a, const auto& b) { return a.frame.key() < b.frame.key(); });
    mapping_.warnings = names_.warnings();
    return std::move(mapping_);
  }

 private:
  using Quantity = std::optional<dbc::EgoQuantity> dbc::EgoMessage::*;

  /// The entry of the message that a table names; nullptr with the error noted.
  dbc::EgoMessage* read_message(config::Reader& table, const dbc::Message*& message) {
    table.require("message");
    Protection protection(table, 1);
    const std::string name = table.text("message", "");
    message = names_.message(table, "message", name);
    if (message == nullptr) return nullptr;
    dbc::MappedMessage frame = names_.frame(table, "message", *message);
    protection.apply(frame, 0);
    const auto same = [&](const dbc::EgoMessage& m) { return m.frame.key() == frame.key(); };
    const auto found = std::find_if(mapping_.messages.begin(), mapping_.messages.end(), same);
    if (found == mapping_.messages.end()) {
      mapping_.messages.push_back({});
      mapping_.messages.back().frame = std::move(frame);
      return &mapping_.messages.back();
    }
    if (table.has("checksum") || table.has("e2e")) {
      table.reject("message", fmt::format("\"{}\" is named above; give its checksum and e2e there", name));
    }
    return &*found;
  }

  std::vector<const dbc::Signal*> read_signals(config::Reader& table, const dbc::Message* message) {
    table.require("signals");
    std::vector<const dbc::Signal*> signals;
    const std::vector<std::string> words = table.texts("signals", {});
    if (table.has("signals") && (words.empty() || words.size() > dbc::kMaxWheels)) {
      table.reject("signals", fmt::format("has {} elements; must have 1 … {}", words.size(), dbc::kMaxWheels));
      return signals;
    }
    for (const std::string& word : words) {
      if (message == nullptr) continue;
      if (const dbc::Signal* const found = names_.signal(table, "signals", *message, word)) signals.push_back(found);
    }
    return signals;
  }

  dbc::EgoMessage* read_quantity(config::Reader& table, Dimension dimension, std::string_view plausible_key,
                                 double plausible_unit, double plausible, Quantity quantity) {
    const dbc::Message* message = nullptr;
    dbc::EgoMessage* const entry = read_message(table, message);
    const Conversion conversion = read_conversion(table, dimension);
    dbc::EgoQuantity read;
    for (const dbc::Signal* signal : read_signals(table, message)) {
      read.signals.push_back(map_signal(*message, *signal, conversion, table));
    }
    read.sum = table.choice<bool>("combine", {{"mean", false}, {"sum", true}}, false);
    const std::vector<double> bounds = table.numbers(plausible_key, 2, {-1e4, 1e4}, {-plausible, plausible});
    if (bounds[0] >= bounds[1]) table.reject(plausible_key, "the first number must be less than the second");
    read.plausible_min = bounds[0] * plausible_unit;
    read.plausible_max = bounds[1] * plausible_unit;
    if (entry != nullptr) entry->*quantity = std::move(read);
    return entry;
  }

  void read_speed(config::Reader table) {
    const bool is_signed = table.boolean("signed", false);
    dbc::EgoMessage* const entry =
        read_quantity(table, Dimension::kSpeed, "plausible_mps", 1.0, 70.0, &dbc::EgoMessage::speed_mps);
    if (entry != nullptr) entry->speed_is_signed = is_signed;
  }

  void read_pulses(config::Reader table) {
    const dbc::Message* message = nullptr;
    dbc::EgoMessage* const entry = read_message(table, message);
    dbc::EgoPulses read;
    table.require("metres_per_pulse");
    read.metres_per_pulse = table.number("metres_per_pulse", {1e-4, 10.0}, 0.02);
    read.window_ns = table.integer("window_ms", {10, 1000}, 100) * 1'000'000;
    read.plausible_max_mps = table.number("plausible_max_mps", {1.0, 150.0}, 70.0);
    const auto wrap = static_cast<std::uint64_t>(table.integer("wrap", {2, 4294967296.0}, 2));
    for (const dbc::Signal* signal : read_signals(table, message)) {
      if (signal->kind != wire::SignalKind::kInteger || signal->is_signed || signal->length > 32) {
        table.reject("signals", fmt::format("\"{}\" must be an unsigned integer of at most 32 bits", signal->name));
        continue;
      }
      const std::uint64_t range = std::uint64_t{1} << signal->length;
      if (table.has("wrap") && wrap > range)
        table.reject("wrap", fmt::format("is beyond the range of \"{}\"", signal->name));
      read.signals.push_back(map_signal(*message, *signal));
      read.wraps.push_back(table.has("wrap") ? wrap : range);
    }
    if (entry != nullptr) entry->pulses = std::move(read);
  }

  void read_reverse(config::Reader table) {
    const dbc::Message* message = nullptr;
    dbc::EgoMessage* const entry = read_message(table, message);
    table.require("signal");
    const std::string name = table.text("signal", "");
    dbc::MappedState state = read_state(table);
    if (entry == nullptr || !table.has("signal")) return;
    const dbc::Signal* const signal = names_.signal(table, "signal", *message, name);
    if (signal == nullptr) return;
    state.signal = map_signal(*message, *signal);
    entry->reverse = std::move(state);
  }

  config::Reader root_;
  Resolver names_;
  dbc::EgoMapping mapping_;
};

}  // namespace

dbc::EgoMapping read_ego_mapping(config::Reader root, const LoadDatabase& load) {
  return EgoReader(std::move(root), load).run();
}

}  // namespace boresight::ingest
