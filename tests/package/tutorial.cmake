# docs/games/bridge.md from an empty folder: its two files and its one command, by its text alone, against the
# ductile that joint_alone installed.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(READ ${SOURCE}/docs/games/bridge.md page)
string(REGEX MATCH "`(cmake -B [^`]*)`" found "${page}")
set(command "${CMAKE_MATCH_1}")
string(REGEX MATCH "```cmake\n([^`]*)```" found "${page}")
file(WRITE ${SCRATCH}/CMakeLists.txt "${CMAKE_MATCH_1}")
string(REGEX MATCH "```cpp\n([^`]*)```" found "${page}")
file(WRITE ${SCRATCH}/bridge.cpp "${CMAKE_MATCH_1}")

run(${CMAKE_COMMAND} -E chdir ${SCRATCH} ${CMAKE_COMMAND} -E env CMAKE_PREFIX_PATH=${SCRATCH}/../joint_alone/prefix
  CXX=${CXX} "CXXFLAGS=${CXX_FLAGS} -Wall -Wextra -Wpedantic -Wshadow -Werror" bash -ec "${command}")
if(NOT printed MATCHES "5 t: across\n.*creak.*crack.*60 t: down\n$")
  message(FATAL_ERROR "the page's level printed\n${printed}")
endif()
file(READ ${SCRATCH}/bridge_level.svg picture)
string(REGEX MATCHALL "<polygon" polygons "${picture}")
list(LENGTH polygons count)
if(NOT count EQUAL 29)  # two banks, a truck, and two halves of 13 bars
  message(FATAL_ERROR "the picture has ${count} polygons")
endif()
