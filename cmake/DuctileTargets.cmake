include(GNUInstallDirs)
set(DUCTILE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ductile)

# Our own code is built with warnings as errors when ductile itself is what is being built; a project that adds
# ductile keeps its own flags.
add_library(ductile_options INTERFACE)
set(DUCTILE_PIC ON)  # so that shared libraries can take the rooms in
if(EMSCRIPTEN)
  set(DUCTILE_PIC OFF)  # in WebAssembly, where there are none, it costs
endif()
target_compile_features(ductile_options INTERFACE cxx_std_20)
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(ductile_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Werror
    -Wno-missing-field-initializers   # designated initialisers leave the rest at its default on purpose
    $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>  # which GCC's -Wconversion leaves out in C++
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # false alarm of GCC 12 in std::string operator+ (GCC bug 105651)
endif()

# ductile_room(NAME SOURCES... [PUBLIC libs...] [PRIVATE libs...]): one room of the house, as ductile::NAME.
# Its public headers are in NAME/include/ductile. Installed, it is a component of the package of its own, so that a game
# with precomputed capacities can have joint alone.
function(ductile_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(ductile_${name} STATIC ${ROOM_SOURCES})
  add_library(ductile::${name} ALIAS ductile_${name})
  set_target_properties(ductile_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ${DUCTILE_PIC})
  target_include_directories(ductile_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(ductile_${name} PUBLIC cxx_std_20)
  # Position-independent code is inlined as any other instead of being kept replaceable by the loader, as Clang does it.
  target_compile_options(ductile_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
  target_link_libraries(ductile_${name} PUBLIC ${ROOM_PUBLIC}
    PRIVATE $<BUILD_INTERFACE:ductile_options> ${ROOM_PRIVATE})
  if(DUCTILE_INSTALL)
    install(TARGETS ductile_${name} EXPORT ductile-${name})
    install(DIRECTORY include/ductile DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(EXPORT ductile-${name} NAMESPACE ductile:: DESTINATION ${DUCTILE_CMAKE_DIR})
  endif()
endfunction()

# A room whose results have the same bits on processors that fuse multiplications and additions.
function(ductile_same_bits name)
  target_compile_options(ductile_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>)
endfunction()
