# The public headers, and the README's program on them, as users compile them who ask for many warnings, with each compiler
# that is here: defs are written with designated initialisers, and a field that has no initialiser of its own is warned of.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(GLOB headers ${SOURCE}/*/include/ductile/*.h)
file(GLOB rooms ${SOURCE}/*/include)
list(TRANSFORM rooms PREPEND -I)
set(text "")
foreach(header IN LISTS headers)
  get_filename_component(name ${header} NAME)
  if(NOT name STREQUAL "section_cgal.h")  # for those who hold CGAL's polygons, and its headers
    string(APPEND text "#include <ductile/${name}>\n")
  endif()
endforeach()
file(WRITE ${SCRATCH}/user.cpp "${text}int main() {}\n")
file(READ ${SOURCE}/README.md page)
string(REGEX MATCH "```cpp\n([^`]*)```" found "${page}")
# Of every def that a scene is made of, one field.
string(REPLACE "int main() {" [[int main() {
  const ductile::SceneDef all{.gravity = {0, 0},
                              .bodies = {{.name = "wall", .joint = {.hold = true}}},
                              .joints = {{.a = "a", .b = "b", .drive = ductile::DriveDef{.cap = 1}}},
                              .supports = {{.fix_x = true}},
                              .loads = {{.moment = 1}},
                              .wheels = {{.frequency = 2}}};
  static_cast<void>(all);]] program "${CMAKE_MATCH_1}")
file(WRITE ${SCRATCH}/readme.cpp "${program}")
foreach(compiler g++ clang++)
  find_program(found_${compiler} ${compiler})
  if(NOT found_${compiler})
    message("${compiler} is not here")
    continue()
  endif()
  foreach(standard c++20 gnu++20)
    run(${found_${compiler}} -std=${standard} -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -pedantic-errors
      ${rooms} ${SCRATCH}/user.cpp ${SCRATCH}/readme.cpp)
  endforeach()
endforeach()
