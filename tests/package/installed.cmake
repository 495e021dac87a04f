# find_package(ductile) from an install tree that was moved after it was installed.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix)
file(RENAME ${SCRATCH}/prefix ${SCRATCH}/moved)
set(outside ${CMAKE_CURRENT_LIST_DIR}/outside)
configure(${outside} ${SCRATCH}/build -D CMAKE_PREFIX_PATH=${SCRATCH}/moved
  -D ROOMS=section,joint,calibrate,files,pictures,design)
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/game)
run(${SCRATCH}/build/level)
run(${SCRATCH}/moved/bin/ductile --version)
if(NOT printed MATCHES "${VERSION}")
  message(FATAL_ERROR "ductile --version printed ${printed}")
endif()

# What is not there is refused: a room that no one built, a version of another minor number.
set(again ${CMAKE_COMMAND} -S ${outside} -B ${SCRATCH}/build)
refused("component cellar is not installed" ${again} -D ROOMS=cellar)
file(WRITE ${SCRATCH}/old/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(old LANGUAGES CXX)\n"
  "find_package(ductile 0.0.1 REQUIRED COMPONENTS joint)\n")
refused("0\\.0\\.1" ${CMAKE_COMMAND} -S ${SCRATCH}/old -B ${SCRATCH}/old/build -G ${GENERATOR}
  -D CMAKE_PREFIX_PATH=${SCRATCH}/moved -D CMAKE_CXX_COMPILER=${CXX})
