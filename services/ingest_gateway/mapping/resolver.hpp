// Resolves names of a mapping file in a DBC file, for radars and ego motion. Every error is noted at its key.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/runtime/config/reader.hpp"
#include "services/ingest_gateway/dbc/mapping.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"

namespace boresight::ingest {

/// Physical dimension of a unit.
enum class Dimension : std::uint8_t { kNone, kLength, kSpeed, kAngle, kAngularRate, kRatio };

/// Conversion of a signal's physical value to the quantity's unit (m, m/s, rad, rad/s, 1).
struct Conversion {
  Dimension dimension = Dimension::kNone;
  std::optional<double> unit;  ///< of the mapping file; without it, the DBC file's unit applies
  double factor = 1.0;
  double offset = 0.0;
};

class Resolver {
 public:
  /// Reads the keys that all mapping files have: kind, dbc, id_offset.
  Resolver(config::Reader& root, std::string_view kind, const LoadDatabase& load);

  /// The message of that name, or nullptr with the error noted at `key`; nullptr for an empty name.
  [[nodiscard]] const dbc::Message* message(config::Reader& at, std::string_view key, const std::string& name) const;
  /// The signal of that name in one of the messages, or nullptr with the error noted; `found_in` becomes the index of
  /// the message. A name in several messages is an error.
  [[nodiscard]] const dbc::Signal* signal(config::Reader& at, std::string_view key,
                                          const std::vector<const dbc::Message*>& messages, const std::string& name,
                                          std::size_t& found_in) const;
  /// The same in one message.
  [[nodiscard]] const dbc::Signal* signal(config::Reader& at, std::string_view key, const dbc::Message& message,
                                          const std::string& name) const;

  [[nodiscard]] dbc::MappedMessage frame(config::Reader& at, std::string_view key, const dbc::Message& message) const;
  [[nodiscard]] std::vector<std::string> warnings() const { return database_.problems; }

 private:
  dbc::Database database_;
  bool is_loaded_ = false;  // otherwise no name can be resolved, which is one error
  std::uint32_t id_offset_ = 0;
};

/// Reads the keys unit, factor, offset of a table.
[[nodiscard]] Conversion read_conversion(config::Reader& table, Dimension dimension);
/// Without conversion, for raw values.
[[nodiscard]] dbc::MappedSignal map_signal(const dbc::Message& message, const dbc::Signal& signal);
/// Notes an error at `table` if neither file has a unit.
[[nodiscard]] dbc::MappedSignal map_signal(const dbc::Message& message, const dbc::Signal& signal,
                                           const Conversion& conversion, config::Reader& table);
[[nodiscard]] std::vector<dbc::SwitchCondition> map_conditions(const dbc::Message& message, const dbc::Signal& signal);

/// Reads the keys `is` or `is_not` of a condition on a signal's raw values.
[[nodiscard]] dbc::MappedState read_state(config::Reader& table);

/// Reads the keys `checksum` and `e2e` of a table for the messages of one pattern.
class Protection {
 public:
  Protection(config::Reader& table, std::size_t messages);
  /// The table has one of the keys.
  [[nodiscard]] bool is_stated() const {
    return checksum_ != dbc::Checksum::kNone || e2e_.profile != e2e::Profile::kNone;
  }
  /// Sets the protection of message number `index` of the pattern; notes an error if it does not fit.
  void apply(dbc::MappedMessage& message, std::size_t index);

 private:
  config::Reader table_;
  dbc::Checksum checksum_ = dbc::Checksum::kNone;
  e2e::Config e2e_;
  std::vector<std::uint32_t> data_ids_;
};

/// For lists in error texts: "A", "B".
[[nodiscard]] std::string quoted(const std::vector<std::string>& names);

}  // namespace boresight::ingest
