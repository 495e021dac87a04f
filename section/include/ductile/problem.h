// What is wrong with an input, said so that its author can mend it.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ductile {

/// One thing wrong with an input. Printed as `place: what; remedy`.
struct Problem {
  std::string place;   ///< where: "regions[0].outer[3]", "body 'girder', outline vertex 4"
  std::string what;    ///< what is wrong, with the numbers: "crosses edge 11 near (1.20, 0.35)"
  std::string remedy;  ///< what would be right: "a ring must not cross itself"
};

std::string to_string(const Problem& problem);

/// Thrown at load time by everything that takes a user's input; carries every problem found, never only the
/// first. `what()` is all of them, one a line.
class InvalidInput : public std::invalid_argument {
 public:
  explicit InvalidInput(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Runs `work`; what is wrong with its input is reported as being in `file`: `file:place`.
template <class Work>
auto in_file(const std::string& file, Work work) {
  try {
    return work();
  } catch (const InvalidInput& error) {
    auto problems = error.problems();
    for (Problem& problem : problems) problem.place = file + ":" + problem.place;
    throw InvalidInput(std::move(problems));
  }
}

}  // namespace ductile
