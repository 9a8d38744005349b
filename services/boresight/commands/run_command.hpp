// What every subcommand shares: exit codes, errors, Ctrl-C, checked input files, help.
#pragma once

#include <fstream>
#include <functional>
#include <istream>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/common/runtime/exit_codes.hpp"
#include "services/common/runtime/options.hpp"

namespace CLI {
class App;
class Option;
class ParseError;
}  // namespace CLI

namespace boresight {

/// A command line that contradicts itself: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A result that the user has to look at, such as a service that failed: exit code 1.
class Finding : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// SIGINT (Ctrl-C) or SIGTERM ended the work before its result was complete: exit code 128 + signal.
struct Interrupted {};

/// Throws Interrupted if a signal has come.
void stop_if_interrupted();
/// The exit code of a command that runs until a signal stops it: `otherwise` after SIGTERM, 130 after Ctrl-C.
[[nodiscard]] int exit_code_after_signal(int otherwise);

/// What one exit code means for a command, and an example of its use; both for --help.
struct Help {
  std::string example;  ///< without "boresight"; several lines are several examples
  std::string success;  ///< meaning of exit code 0
  std::string finding;  ///< meaning of exit code 1; empty: the command does not return it
};

/// Sets what `command` does when it is called, and the end of its help. `run` returns the exit code. The signals SIGINT
/// and SIGTERM are noted during `run`, see stop_if_interrupted(). Exceptions become a line on standard error and an
/// exit code: UsageError, config::Error and std::invalid_argument 2, Finding 1, Interrupted 130 or 143, everything
/// else 3. `configuration`, which may be null, is named below errors of the configuration.
void on_call(CLI::App& command, int& exit_code, const Help& help, std::function<int()> run,
             const runtime::Configuration* configuration = nullptr);

/// Writes "boresight COMMAND: text" to standard error.
void report_problem(const CLI::App& command, const std::string& text);

/// Prints what is wrong with the command line and the nearest known word; returns the exit code.
int report_parse_error(const CLI::App& app, const CLI::ParseError& error);

/// "boresight calibrate plate".
[[nodiscard]] std::string full_name(const CLI::App& command);

/// Adds --json [FILE]; without FILE, or with "-", the JSON goes to standard output. `file` is empty if the option is
/// not given.
CLI::Option* add_json_option(CLI::App& command, std::string& file, const std::string& about);

/// --security DIRECTORY: identity and permissions in a secured DDS domain.
CLI::Option* add_security_option(CLI::App& command, std::string& directory);

/// A text file being read; a signal ends the reading with Interrupted.
class InputFile : public std::istream {
 public:
  /// Throws std::runtime_error, which names the file and the cause.
  explicit InputFile(const std::string& file);

 private:
  class Buffer : public std::filebuf {
   protected:
    int_type underflow() override;
  };
  Buffer buffer_;
};

}  // namespace boresight
