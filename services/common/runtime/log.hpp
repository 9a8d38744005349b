// Logging by spdlog behind a small interface: to the terminal, or to the journal (with priorities) under systemd.
// Never called per scan: the data path counts faults, and the heartbeat logs them.
#pragma once

#include <string_view>

#include <fmt/core.h>

namespace boresight::runtime::log {

enum class Level { kDebug, kInfo, kWarning, kError };

/// Sets the name at the start of every line. Level from $BORESIGHT_LOG_LEVEL (debug, info, warning, error).
void initialise(std::string_view process_name);
/// Writes one line. Names and texts may come from outside: control characters and bytes that are not UTF-8 appear as ?.
void write(Level level, std::string_view text);
/// Before the process ends without the destructors of static objects.
void flush();

template <typename... Args>
void debug(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::kDebug, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void warning(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::kWarning, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void error(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::kError, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace boresight::runtime::log
