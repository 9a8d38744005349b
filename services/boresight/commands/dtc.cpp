// `boresight dtc`: the fault memory of the health service, over DDS or from its file.
#include <chrono>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "services/boresight/bounded/joined.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/diagnostics/fault_text.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/state_file.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/common/text/printable.hpp"
#include "services/health/config.hpp"
#include "services/health/core/faults/codec.hpp"
#include "services/health/dds/fault_memory_client.hpp"
#include "services/health/dds/fault_memory_server.hpp"

namespace boresight {

namespace {

struct DtcOptions {
  runtime::Configuration configuration;
  std::string state;  ///< file; empty: DDS
  std::string code;
  std::string key;
  std::string security;  ///< folder; empty: as health.toml says
  std::string json;
  double seconds = 10.0;  ///< discovery takes some 20 ms, and seconds more if a datagram was lost
};

using Client = bounded::Joined<dds::FaultMemoryClient>;
using Records = std::vector<diagnostics::FaultRecord>;

struct FaultList {
  Records records;
  std::string head;
};

dds::Config dds_of(const DtcOptions& options) {
  dds::Config config = health::read_config(config::Reader::open(options.configuration.service_file("health"))).dds;
  if (!options.key.empty()) config.command_key_file = options.key;
  if (!options.security.empty()) config.security = dds::secured_by(options.security);
  return config;
}

Client join(const dds::Config& config, dds::FaultMemoryClient::Use use) {
  return Client(
      fmt::format("DDS domain {}", config.domain),
      [config, use] { return std::make_unique<dds::FaultMemoryClient>(config, use); },
      [] { return runtime::stop_signalled(); });
}

/// Polls until `is_done`; false after the time of --seconds.
template <typename IsDone>
bool wait_for(const DtcOptions& options, const Client& client, const IsDone& is_done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  while (std::chrono::steady_clock::now() < end) {
    stop_if_interrupted();
    client->poll();
    if (is_done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

std::string head_of(const std::string& vehicle, std::uint32_t cycle, std::uint32_t stored) {
  return fmt::format("{}: operation cycle {}, {} stored", vehicle, cycle, stored);
}

/// Why the time of --seconds was not enough.
[[noreturn]] void report_absence(const DtcOptions& options, std::uint32_t domain, const Client& client,
                                 const std::string& missing) {
  if (!client->state()) {
    throw Finding(fmt::format("no health service answered on DDS domain {} within {} s", domain, options.seconds));
  }
  throw Finding(fmt::format("the health service on DDS domain {} answered, but {} within {} s", domain, missing,
                            options.seconds));
}

FaultList list_by_dds(const DtcOptions& options) {
  const dds::Config config = dds_of(options);
  const Client client = join(config, dds::FaultMemoryClient::Use::kRead);
  if (!wait_for(options, client, [&] { return client->is_complete(); })) {
    report_absence(options, config.domain, client,
                   fmt::format("only {} of {} codes arrived", client->stored_records(),
                               client->state() ? client->state()->stored() : 0));
  }
  FaultList list;
  const diagnostics::FaultMemoryState& state = *client->state();
  list.head = head_of(state.vehicle_name(), state.operation_cycle(), state.stored());
  for (const auto& [dtc, record] : client->records()) list.records.push_back(record);
  return list;
}

FaultList list_of_file(const DtcOptions& options) {
  const VehicleConfig vehicle = options.configuration.vehicle();
  health::FaultMemory memory(vehicle, {});
  std::vector<std::uint8_t> bytes(health::kMaxFaultMemoryBytes + 1);
  const runtime::StateBytes read = runtime::read_state_file(options.state, bytes);
  if (read.kind == runtime::StateBytes::Kind::kMissing)
    throw std::runtime_error(options.state + ": No such file or directory");
  if (read.kind == runtime::StateBytes::Kind::kUnreadable) throw std::runtime_error(options.state + ": " + read.reason);
  const auto verdict = health::decode_fault_memory(std::span(bytes).first(read.size), memory);
  if (verdict != health::StoredFaults::kTaken) {
    throw std::runtime_error(options.state + ": the fault memory is " + health::describe(verdict));
  }
  FaultList list;
  list.head = head_of(vehicle.name, memory.cycle(), memory.stored());
  for (const health::FaultRecord& record : memory.records()) {
    if (record.status.is_stored()) list.records.push_back(dds::to_fault_record(record, vehicle));
  }
  return list;
}

FaultList list_of(const DtcOptions& options) {
  return options.state.empty() ? list_by_dds(options) : list_of_file(options);
}

std::uint32_t dtc_of(const std::string& code) {
  const std::optional<std::uint32_t> dtc = health::dtc_from_text(code);
  if (!dtc) throw UsageError("'" + code + "' is no trouble code; one is written as C1A02-87");
  return *dtc;
}

int run_list(const DtcOptions& options) {
  const FaultList list = list_of(options);
  if (options.json.empty()) {
    terminal::print(diagnostics_text::fault_list(list.records, list.head));
    return exit_code::kSuccess;
  }
  terminal::OutputFile output(options.json);
  for (const diagnostics::FaultRecord& record : list.records) output.write(diagnostics_text::to_json(record));
  output.commit();
  return exit_code::kSuccess;
}

int run_show(const DtcOptions& options) {
  const std::uint32_t dtc = dtc_of(options.code);
  for (const diagnostics::FaultRecord& record : list_of(options).records) {
    if (record.dtc() != dtc) continue;
    terminal::print(diagnostics_text::fault_page(record));
    return exit_code::kSuccess;
  }
  throw Finding(options.code + " is not stored");
}

int run_clear(const DtcOptions& options) {
  const std::uint32_t dtc = options.code.empty() ? dds::kAllDtcs : dtc_of(options.code);
  const dds::Config config = dds_of(options);
  if (config.command_key_file.empty()) {
    throw UsageError("no secret: give --key FILE, or set dds.command_key_file in health.toml");
  }
  std::string problem;
  const dds::CommandKey key = dds::read_command_key(config.command_key_file, problem);
  if (!problem.empty()) throw UsageError(problem);
  const Client client = join(config, dds::FaultMemoryClient::Use::kCommand);
  if (!wait_for(options, client, [&] { return client->state() && client->can_command(); })) {
    report_absence(options, config.domain, client, "took no commands");
  }
  const std::uint64_t number = std::random_device{}();
  // The service may discover this tool later than the tool the service: the command is repeated until the reply.
  constexpr std::chrono::milliseconds kRepetition{300};
  auto next = std::chrono::steady_clock::now();
  const bool is_answered = wait_for(options, client, [&] {
    if (client->reply(number) != nullptr) return true;
    if (std::chrono::steady_clock::now() < next) return false;
    client->clear(dtc, number, key);
    next = std::chrono::steady_clock::now() + kRepetition;
    return false;
  });
  if (!is_answered) report_absence(options, config.domain, client, "did not reply to the command");
  const diagnostics::CommandReply& reply = *client->reply(number);
  if (!reply.is_accepted()) throw Finding("refused: " + text::printable(reply.reason()));
  terminal::print(options.code.empty() ? "all codes cleared\n" : options.code + " cleared\n");
  return exit_code::kSuccess;
}

CLI::App* add(CLI::App& parent, const char* name, const char* about, DtcOptions& options) {
  CLI::App* const command = parent.add_subcommand(name, about);
  runtime::add_config_option(*command, options.configuration);
  command->add_option("--seconds", options.seconds, "Time to wait for the health service")
      ->check(CLI::PositiveNumber)
      ->type_name("S")
      ->capture_default_str();
  add_security_option(*command, options.security);
  return command;
}

void add_state_option(CLI::App& command, DtcOptions& options) {
  command.add_option("--state", options.state, "Reads the file of the fault memory instead of asking over DDS")
      ->type_name("FILE");
  runtime::add_vehicle_option(command, options.configuration, "Vehicle of the file of --state")
      ->envname("BORESIGHT_VEHICLE");
}

}  // namespace

void add_dtc_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("dtc", "Lists, shows and clears the trouble codes of the fault memory.");
  command->require_subcommand(1);
  command->footer("'boresight dtc list --help' and so on describe the options.");

  auto list = std::make_shared<DtcOptions>();
  CLI::App* const list_command = add(*command, "list", "Lists the stored trouble codes.", *list);
  add_state_option(*list_command, *list);
  add_json_option(*list_command, list->json,
                  "A line of JSON for each code; without FILE, or with \"-\": standard output");
  on_call(
      *list_command, exit_code, {"dtc list", "the list is printed", "no health service answered"},
      [list] { return run_list(*list); }, &list->configuration);

  auto show = std::make_shared<DtcOptions>();
  CLI::App* const show_command = add(*command, "show", "Shows one code with its freeze frames.", *show);
  show_command->add_option("CODE", show->code, "Trouble code as `dtc list` prints it")->required();
  add_state_option(*show_command, *show);
  on_call(
      *show_command, exit_code,
      {"dtc show C1D02-78", "the code is printed", "the code is not stored, or no health service answered"},
      [show] { return run_show(*show); }, &show->configuration);

  auto clear = std::make_shared<DtcOptions>();
  CLI::App* const clear_command =
      add(*command, "clear", "Clears one code, or all. Needs the secret of the ECU.", *clear);
  clear_command->add_option("CODE", clear->code, "Trouble code; default: all codes");
  clear_command->add_option("--key", clear->key, "File with the secret; default: dds.command_key_file of health.toml")
      ->type_name("FILE");
  on_call(
      *clear_command, exit_code,
      {"dtc clear --key /etc/boresight/command.key", "the code is cleared",
       "the health service refused, or did not answer"},
      [clear] { return run_clear(*clear); }, &clear->configuration);

  CLI::App* const table_command = command->add_subcommand("table", "Prints all trouble codes as a Markdown table.");
  on_call(*table_command, exit_code, {"dtc table", "the table is printed", ""}, [] {
    terminal::print(diagnostics_text::dtc_table());
    return exit_code::kSuccess;
  });
}

}  // namespace boresight
