#include "services/boresight/commands/run_command.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/common/text/near_names.hpp"

namespace boresight {

namespace {

std::string footer_of(const Help& help) {
  std::string text = "Examples:\n";
  std::istringstream lines(help.example);
  for (std::string line; std::getline(lines, line);) text += "  boresight " + line + "\n";
  if (help.example.find('\n') == std::string::npos) text.replace(0, 9, "Example:");
  text += fmt::format("\nExit codes:\n  0    {}\n", help.success);
  if (!help.finding.empty()) text += fmt::format("  1    {}\n", help.finding);
  text +=
      "  2    wrong command line or configuration\n"
      "  3    an input cannot be read, or an output cannot be written\n"
      "  130  ended by Ctrl-C";
  return text;
}

/// The innermost subcommand that the command line names.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App* each) { return each->get_name().empty(); })) {
    const std::vector<std::string> more = option_names(*group);
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* each : command.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); })) {
    names.push_back(each->get_name());
  }
  return names;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::vector<std::string> near = near_names(word, known);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near.front());
}

/// What is wrong with the first word that `command` does not know; empty if it knows them all.
std::string problem_of_unknown_word(const CLI::App& command) {
  const std::vector<std::string> unknown = command.remaining(true);
  if (unknown.empty()) return {};
  const auto option = std::find_if(unknown.begin(), unknown.end(),
                                   [](const std::string& word) { return word.starts_with("-") && word.size() > 1; });
  if (option != unknown.end()) {
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("unknown option '{}'{}", name, did_you_mean(name, option_names(command)));
  }
  const std::vector<std::string> commands = command_names(command);
  if (commands.empty()) return fmt::format("unexpected argument '{}'", unknown.front());
  return fmt::format("unknown command '{}'{}\ncommands: {}", unknown.front(), did_you_mean(unknown.front(), commands),
                     fmt::join(commands, ", "));
}

int run_and_catch(const CLI::App& command, const std::function<int()>& run,
                  const runtime::Configuration* configuration) {
  runtime::install_stop_signals();
  try {
    return run();
  } catch (const Interrupted&) {
    std::fprintf(stderr, "%s: interrupted\n", full_name(command).c_str());
    return exit_code::kSignalBase + runtime::stop_signal();
  } catch (const terminal::ReaderGone&) {
    return exit_code::kInputOutput;
  } catch (const terminal::OutputError& error) {
    report_problem(command, error.what());
    return exit_code::kInputOutput;
  } catch (const config::Error& error) {
    report_problem(command, error.what());
    if (configuration != nullptr) {
      std::fprintf(stderr, "configuration: %s\n", configuration->directory.c_str());
    }
    return exit_code::kUsage;
  } catch (const std::exception& error) {
    if (runtime::stop_signalled()) return exit_code::kSignalBase + runtime::stop_signal();
    report_problem(command, error.what());
    if (dynamic_cast<const Finding*>(&error) != nullptr) return exit_code::kFinding;
    const bool is_usage = dynamic_cast<const UsageError*>(&error) != nullptr ||
                          dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
    return is_usage ? exit_code::kUsage : exit_code::kInputOutput;
  }
}

}  // namespace

void stop_if_interrupted() {
  if (runtime::stop_signalled()) throw Interrupted{};
}

int exit_code_after_signal(int otherwise) {
  return runtime::stop_signal() == SIGINT ? exit_code::kSignalBase + SIGINT : otherwise;
}

std::string full_name(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

void report_problem(const CLI::App& command, const std::string& text) {
  std::fprintf(stderr, "%s: %s\n", full_name(command).c_str(), text.c_str());
}

void on_call(CLI::App& command, int& exit_code, const Help& help, std::function<int()> run,
             const runtime::Configuration* configuration) {
  command.footer(footer_of(help));
  command.callback([&command, &exit_code, run = std::move(run), configuration] {
    exit_code = run_and_catch(command, run, configuration);
  });
}

int report_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {  // --help and --version
    std::ostringstream text;
    app.exit(error, text, std::cerr);
    try {
      terminal::print(text.str());
    } catch (const terminal::OutputError& failure) {
      report_problem(command, failure.what());
      return exit_code::kInputOutput;
    }
    return exit_code::kSuccess;
  }
  std::string problem = problem_of_unknown_word(command);
  if (problem.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
      command.get_require_subcommand_min() > 0) {
    problem = fmt::format("a command is missing; commands: {}", fmt::join(command_names(command), ", "));
  }
  report_problem(command, problem.empty() ? error.what() : problem);
  std::fprintf(stderr, "'%s --help' lists what is allowed\n", full_name(command).c_str());
  return exit_code::kUsage;
}

CLI::Option* add_json_option(CLI::App& command, std::string& file, const std::string& about) {
  return command.add_option("--json", file, about)->expected(0, 1)->default_str("-")->option_text("[FILE]");
}

CLI::Option* add_security_option(CLI::App& command, std::string& directory) {
  return command
      .add_option("--security", directory,
                  "Folder with the files of DDS Security: identity, permissions; deploy/dds_security makes it")
      ->type_name("DIRECTORY");
}

InputFile::InputFile(const std::string& file) : std::istream(nullptr) {
  errno = 0;
  if (buffer_.open(file, std::ios::in) == nullptr) throw std::runtime_error(file + ": " + std::strerror(errno));
  rdbuf(&buffer_);
  exceptions(std::ios::badbit);
  // A folder can be opened, but not be read.
  try {
    peek();
  } catch (const std::exception&) {
    throw std::runtime_error(file + ": " + std::strerror(errno != 0 ? errno : EIO));
  }
  clear();
}

InputFile::Buffer::int_type InputFile::Buffer::underflow() {
  stop_if_interrupted();
  return std::filebuf::underflow();
}

}  // namespace boresight
