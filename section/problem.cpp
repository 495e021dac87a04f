#include "ductile/problem.h"

#include <utility>

namespace ductile {

std::string to_string(const Problem& problem) {
  return problem.place + ": " + problem.what + "; " + problem.remedy;
}

namespace {
std::string join(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "\n") + to_string(problem);
  return text;
}
}  // namespace

InvalidInput::InvalidInput(std::vector<Problem> problems)
    : std::invalid_argument(join(problems)), problems_(std::move(problems)) {}

}  // namespace ductile
