// Where the page's plots come from.
#include <stdexcept>
#include <string>

#include "ductile/files.h"
#include "ductile/report.h"
#include "npm.h"
#include "report_page.h"

namespace ductile {

std::string plotly_text() {
  std::optional<std::string> file = report::run_with_cache(plotly_script);
  if (!file) throw std::runtime_error("no report without its plots (the reason stands above)");
  while (!file->empty() && file->back() == '\n') file->pop_back();
  return read_text(*file);
}

}  // namespace ductile
