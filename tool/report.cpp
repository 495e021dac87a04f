// ductile report: makes the page of errors and run times.
#include "ductile/report.h"

#include <filesystem>
#include <memory>
#include <string>

#include "command.h"
#include "progress.h"

namespace ductile::tool {

void add_report(CLI::App& app, std::string& output) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "Error against run time, stability, what was left out: a page with plots");
  command->add_option("--out", options->out, "folder of the page and its data")->required();
  command->add_flag("--quick", options->quick, "fewer sizes and shorter runs: a minute at most");
  command->add_option("--only", options->only, "one case alone")->check(CLI::IsMember(report_cases()));
  command->callback([options, &output] {
    if (std::filesystem::exists(options->out) && !std::filesystem::is_directory(options->out)) {
      throw InvalidInput({{"command line:--out", options->out.string() + " is no folder", "name a folder"}});
    }
    options->plotly = plotly_text();  // before the work, should it not be there
    Progress progress;
    options->progress = [&](const std::string& what, double share) { progress.show(share, what); };
    output = make_report(*options) + "\n" + (options->out / "index.html").string() + "\n";
  });
}

}  // namespace ductile::tool
