#include "services/common/runtime/log.hpp"

#include <cstdlib>
#include <memory>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/systemd_sink.h>
#include <spdlog/spdlog.h>

#include "services/common/text/printable.hpp"

namespace boresight::runtime::log {

namespace {

spdlog::level::level_enum to_spdlog(Level level) {
  switch (level) {
    case Level::kDebug:
      return spdlog::level::debug;
    case Level::kInfo:
      return spdlog::level::info;
    case Level::kWarning:
      return spdlog::level::warn;
    case Level::kError:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

}  // namespace

void initialise(std::string_view process_name) {
  // systemd sets JOURNAL_STREAM if stderr is connected to the journal; only its own protocol carries priorities.
  std::shared_ptr<spdlog::sinks::sink> sink;
  if (std::getenv("JOURNAL_STREAM") != nullptr) {
    sink = std::make_shared<spdlog::sinks::systemd_sink_mt>(std::string(process_name));
    sink->set_pattern("%v");
  } else {
    sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    sink->set_pattern("%H:%M:%S.%e %^%-7l%$ %n: %v");
  }
  auto logger = std::make_shared<spdlog::logger>(std::string(process_name), std::move(sink));
  logger->flush_on(spdlog::level::info);
  if (const char* level = std::getenv("BORESIGHT_LOG_LEVEL")) logger->set_level(spdlog::level::from_str(level));
  spdlog::set_default_logger(std::move(logger));
}

void write(Level level, std::string_view text) {
  spdlog::default_logger_raw()->log(to_spdlog(level), text::printable(text));
}

void flush() {
  spdlog::default_logger_raw()->flush();
}

}  // namespace boresight::runtime::log
