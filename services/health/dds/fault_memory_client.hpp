// A tool's view of the fault memory over DDS, and its commands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "generated/fault_memory.h"
#include "services/health/dds/authentication.hpp"
#include "services/health/dds/config.hpp"

namespace boresight::dds {

class FaultMemoryClient {
 public:
  /// A secured domain may permit a participant to read, and not to command.
  enum class Use : std::uint8_t { kRead, kCommand };

  /// Joins the domain; throws std::runtime_error if that is impossible.
  FaultMemoryClient(const Config& config, Use use);
  ~FaultMemoryClient();

  /// Takes what has been received.
  void poll();
  /// Received records by trouble code.
  [[nodiscard]] const std::map<std::uint32_t, diagnostics::FaultRecord>& records() const { return records_; }
  /// Nothing until the health service was found.
  [[nodiscard]] const std::optional<diagnostics::FaultMemoryState>& state() const { return state_; }
  /// Number of received records that are stored, that is pending or confirmed.
  [[nodiscard]] std::size_t stored_records() const;
  /// True when as many stored records as the state counts were received.
  [[nodiscard]] bool is_complete() const;

  /// Whether a command would arrive: the service reads commands, and its replies are read here. Needs Use::kCommand,
  /// as clear() does.
  [[nodiscard]] bool can_command() const;
  /// Sends a command with the answer to the latest challenge; state() must be known.
  void clear(std::uint32_t dtc, std::uint64_t number, const CommandKey& key);
  /// The reply to that command, if it was received.
  [[nodiscard]] const diagnostics::CommandReply* reply(std::uint64_t number) const;

 private:
  class Entities;
  std::unique_ptr<Entities> entities_;
  std::map<std::uint32_t, diagnostics::FaultRecord> records_;
  std::optional<diagnostics::FaultMemoryState> state_;
  std::set<std::uint64_t> asked_;  ///< numbers of the commands
  std::map<std::uint64_t, diagnostics::CommandReply> replies_;
};

}  // namespace boresight::dds
