#include "deploy/broker/judgement/thread_activity.hpp"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include "deploy/broker/judgement/mutex_wait.hpp"

namespace boresight::broker {

namespace {

/// The rest of the line that begins with `key`; nothing without such a line.
std::optional<std::string_view> value_of(std::string_view text, std::string_view key) {
  std::size_t at = text.starts_with(key) ? 0 : text.find("\n" + std::string(key));
  if (at == std::string_view::npos) return std::nullopt;
  if (at > 0) ++at;
  at = text.find_first_not_of(" \t", at + key.size());
  if (at == std::string_view::npos) return std::nullopt;
  return text.substr(at, text.find('\n', at) - at);
}

template <typename Number>
std::optional<Number> leading_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

ThreadState state_of(char letter) {
  switch (letter) {
    case 'R':
      return ThreadState::kRunnable;
    case 'D':
      return ThreadState::kOnDisk;
    case 'T':
    case 't':
      return ThreadState::kStopped;
    default:
      return ThreadState::kSleeping;
  }
}

std::string content_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

std::optional<ThreadActivity> parse_activity(std::string_view status, std::string_view schedstat) {
  const auto name = value_of(status, "Name:");
  const auto state = value_of(status, "State:");
  const auto switches = value_of(status, "voluntary_ctxt_switches:");
  if (!name || !state || state->empty() || !switches) return std::nullopt;
  const auto number = leading_number<std::uint64_t>(*switches);
  if (!number) return std::nullopt;
  return ThreadActivity{.name = std::string(*name),
                        .voluntary_switches = *number,
                        .processor_time_ns = leading_number<std::int64_t>(schedstat).value_or(0),
                        .state = state_of(state->front())};
}

std::vector<ThreadActivity> read_activity(pid_t pid) {
  std::vector<ThreadActivity> threads;
  std::error_code error;
  const std::filesystem::path tasks = "/proc/" + std::to_string(pid) + "/task";
  for (std::filesystem::directory_iterator task(tasks, error), end; !error && task != end; task.increment(error)) {
    auto activity = parse_activity(content_of(task->path() / "status"), content_of(task->path() / "schedstat"));
    if (!activity) continue;
    if (activity->state == ThreadState::kSleeping) activity->wait = wait_of(pid, content_of(task->path() / "syscall"));
    threads.push_back(*activity);
  }
  return threads;
}

}  // namespace boresight::broker
