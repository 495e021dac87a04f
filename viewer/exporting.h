// A scene for other programs and people. Knows no window.
#pragma once

#include <span>
#include <string>

#include "workbench.h"

namespace ductile::viewer {

struct ExportFormat {
  const char *name, *ending, *what;             ///< "C++ source", ".cpp", a sentence
  std::string (*text)(const Workbench& bench);  ///< throws InvalidInput where the format has no room for it
};

std::span<const ExportFormat> export_formats();

/// The scene as one text, with the outlines of its drawings in place. Throws InvalidInput of a level.
std::string link_text(const Workbench& bench);

}  // namespace ductile::viewer
