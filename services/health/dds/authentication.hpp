// Who may command: a tool proves that it knows the secret of the ECU, without sending it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace boresight::dds {

/// The secret; empty: nobody may command.
using CommandKey = std::vector<std::uint8_t>;
using Challenge = std::array<std::uint8_t, 16>;
using Authentication = std::array<std::uint8_t, 32>;

/// Reads the secret: a regular file of 32 to 4096 bytes that others than its owner and group cannot read. On failure
/// returns an empty key, and `problem` names the file and the reason.
[[nodiscard]] CommandKey read_command_key(const std::filesystem::path& file, std::string& problem);

/// Random and unpredictable. Throws std::runtime_error if the system has no randomness.
[[nodiscard]] Challenge new_challenge();

/// HMAC-SHA-256 with the key over challenge, number and trouble code, as fault_memory.idl describes.
[[nodiscard]] Authentication authentication_of(const CommandKey& key, const Challenge& challenge, std::uint64_t number,
                                               std::uint32_t dtc);

/// Compares in constant time. Always false with an empty key.
[[nodiscard]] bool is_authentic(const CommandKey& key, const Challenge& challenge, std::uint64_t number,
                                std::uint32_t dtc, const Authentication& given);

}  // namespace boresight::dds
