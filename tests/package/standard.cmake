# joint/ as compilers without GNU's extensions take it: C++20 and nothing else, and two doubles where those have vectors.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(GLOB sources ${SOURCE}/joint/*.cpp)
list(TRANSFORM sources REPLACE "(.+)" "#include \"\\1\"\n")
list(JOIN sources "" text)
file(WRITE ${SCRATCH}/joint.cpp "${text}")
find_path(eigen Eigen/Core PATHS /usr/include /usr/local/include PATH_SUFFIXES eigen3 REQUIRED)
run(${CXX} -std=c++20 -fsyntax-only -Wpedantic -pedantic-errors -DDUCTILE_STANDARD_CPP -I${SOURCE}/joint -I${SOURCE}/joint/include
  -isystem ${eigen} ${SCRATCH}/joint.cpp)
