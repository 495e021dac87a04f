# Games against the ductile that joint_alone installed.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
configure(${CMAKE_CURRENT_LIST_DIR}/games ${SCRATCH}/build -D CMAKE_PREFIX_PATH=${SCRATCH}/../joint_alone/prefix)
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${CMAKE_CTEST_COMMAND} --test-dir ${SCRATCH}/build --output-on-failure)
