// Reads JSON texts from stdin, one a line; says of each whether the reader accepts its form.
#include <iostream>
#include <string>

#include "ductile/files.h"

int main(int argc, char** argv) {
  const bool section = argc > 1 && std::string(argv[1]) == "section";
  for (std::string line; std::getline(std::cin, line);) {
    try {
      section ? void(ductile::parse_section(line)) : void(ductile::parse_scene(line));
      std::cout << "accepted\n";
    } catch (const ductile::InvalidInput& error) {
      std::string what = error.what();
      std::cout << "refused: " << what.substr(0, what.find('\n')) << '\n';
    }
  }
}
