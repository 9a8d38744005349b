// `boresight catalogue`: the system on one page, as text, as documentation, or as RouDi's memory pools.
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "deploy/catalogue/catalogue_text.hpp"
#include "deploy/roudi/pools.hpp"
#include "services/boresight/commands/commands.hpp"

namespace boresight {

void add_catalogue_command(CLI::App& app, int& exit_code) {
  struct Options {
    bool markdown = false;
    bool roudi = false;
    bool deployed = false;
  };
  CLI::App* const command = app.add_subcommand("catalogue", "every topic: type, writers, readers, period, deadline");
  auto options = std::make_shared<Options>();
  auto* const markdown =
      command->add_flag("--markdown", options->markdown, "as a table and a picture for documentation");
  auto* const roudi = command->add_flag("--roudi", options->roudi, "as RouDi's memory pools (one segment)");
  command->add_flag("--deployed", options->deployed, "with one segment and writer group per service")->needs(roudi);
  markdown->excludes(roudi);
  command->callback([options, &exit_code] {
    if (options->roudi) {
      std::cout << roudi::to_toml(options->deployed ? roudi::segment_per_writer() : roudi::single_segment());
    } else {
      std::cout << (options->markdown ? catalogue::to_markdown() : catalogue::to_table());
    }
    exit_code = std::cout.flush() ? 0 : 1;
  });
}

}  // namespace boresight
