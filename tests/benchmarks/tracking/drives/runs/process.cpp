#include "tests/benchmarks/tracking/drives/runs/process.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace boresight::bench::tracking {

namespace {

std::string end_of(const std::filesystem::path& log) {
  constexpr std::size_t kMostCharacters = 2000;
  std::ifstream in(log);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return text.size() <= kMostCharacters ? text : text.substr(text.size() - kMostCharacters);
}

}  // namespace

int run_program(const std::vector<std::string>& words, const std::filesystem::path& log) {
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  constexpr mode_t kReadable = 0644;
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, kReadable);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw std::runtime_error(fmt::format("{}: cannot be started, error {}", words.front(), failure));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error(words.front() + ": cannot be waited for");
  }
  constexpr int kSignalled = 128;
  return WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status);
}

int run_program(const std::vector<std::string>& words, const std::filesystem::path& log,
                const std::vector<int>& allowed) {
  const int code = run_program(words, log);
  if (std::find(allowed.begin(), allowed.end(), code) != allowed.end()) return code;
  throw std::runtime_error(fmt::format("{}: exit code {}\n{}", fmt::join(words, " "), code, end_of(log)));
}

}  // namespace boresight::bench::tracking
