// `boresight catalogue`: the system on one page, as text, as documentation, or as RouDi's memory pools.
#include <memory>

#include <CLI/CLI.hpp>

#include "deploy/catalogue/catalogue_text.hpp"
#include "deploy/roudi/pools.hpp"
#include "services/boresight/commands/commands.hpp"
#include "services/boresight/commands/run_command.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "services/health/dds/topic_page.hpp"

namespace boresight {

void add_catalogue_command(CLI::App& app, int& exit_code) {
  struct CatalogueOptions {
    bool markdown = false;
    bool dds = false;
    bool roudi = false;
    bool deployed = false;
  };
  CLI::App* const command = app.add_subcommand(
      "catalogue", "Lists every topic of the system with its type, writers, readers, period and deadline.");
  auto options = std::make_shared<CatalogueOptions>();
  auto* const markdown =
      command->add_flag("--markdown", options->markdown, "As a Markdown table and a diagram, for documentation");
  auto* const roudi = command->add_flag("--roudi", options->roudi,
                                        "As the configuration of RouDi's memory pools, one segment for all services");
  command->add_flag("--deployed", options->deployed, "For --roudi: one segment and one writer group for each service")
      ->needs(roudi);
  auto* const dds =
      command->add_flag("--dds", options->dds, "The topics off the ECU instead, as the Markdown table of docs/dds.md");
  markdown->excludes(roudi);
  dds->excludes(markdown)->excludes(roudi);
  on_call(*command, exit_code, {"catalogue --markdown", "the list is printed", ""}, [options] {
    terminal::print(options->roudi
                        ? roudi::to_toml(options->deployed ? roudi::segment_per_writer() : roudi::single_segment())
                    : options->dds      ? dds::topics_as_markdown()
                    : options->markdown ? catalogue::to_markdown()
                                        : catalogue::to_table());
    return exit_code::kSuccess;
  });
}

}  // namespace boresight
