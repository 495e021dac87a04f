# The libraries of Debian, for WebAssembly: header-only ones as they are installed, the others compiled from Debian's
# source packages, which ./dev has put into DUCTILE_SOURCES. find_package() finds what stands here.
set(DUCTILE_SOURCES ${PROJECT_BINARY_DIR}/sources CACHE PATH "unpacked source packages of Debian")

function(source_of variable package)
  file(GLOB found ${DUCTILE_SOURCES}/${package}-*/)
  if(NOT found)
    message(FATAL_ERROR "there are no sources of ${package} in ${DUCTILE_SOURCES}: ./dev npm brings them")
  endif()
  set(${variable} ${found} PARENT_SCOPE)
endfunction()

# wasm_library(NAME SOURCES… INCLUDE…): one that is compiled.
function(wasm_library name)
  cmake_parse_arguments(LIBRARY "" "" "SOURCES;INCLUDE" ${ARGN})
  file(GLOB sources ${LIBRARY_SOURCES})
  add_library(${name} STATIC ${sources})
  target_include_directories(${name} SYSTEM PUBLIC ${LIBRARY_INCLUDE})
  target_compile_options(${name} PRIVATE -w)  # other people's code
endfunction()

# Header-only ones: links to their folders alone, as /usr/include holds the headers of another C library.
set(headers ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${headers})
foreach(folder CGAL boost CLI fmt nlohmann)
  file(CREATE_LINK /usr/include/${folder} ${headers}/${folder} SYMBOLIC)
endforeach()
foreach(target Boost::headers CGAL::CGAL CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json Eigen3::Eigen)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${headers})
endforeach()
target_include_directories(Eigen3::Eigen SYSTEM INTERFACE /usr/include/eigen3)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
# Boost's numbers instead of GMP's; wasm rounds to nearest and no other way.
target_compile_definitions(CGAL::CGAL INTERFACE CGAL_DISABLE_GMP CGAL_ALWAYS_ROUND_TO_NEAREST CGAL_USE_BOOST_MP)

# sinf and cosf as glibc has them (ARM's optimized routines), so that Box2D turns bodies by the same bits as natively: those
# of Emscripten's musl round one value in three hundred differently. Of newlib, which has them without glibc's machinery.
source_of(newlib newlib)
set(rounding ${PROJECT_BINARY_DIR}/sinf)
foreach(file sinf.c cosf.c sincosf.h sincosf_data.c math_config.h)
  configure_file(${newlib}/newlib/libm/common/${file} ${rounding}/${file} COPYONLY)
endforeach()
file(CONFIGURE OUTPUT ${rounding}/fdlibm.h CONTENT "#include <math.h>\n")  # newlib's own asks for the rest of newlib
wasm_library(sinf SOURCES ${rounding}/*.c INCLUDE)
target_compile_definitions(sinf PRIVATE __OBSOLETE_MATH=0)
target_compile_options(sinf PRIVATE -fno-builtin)

source_of(box2d box2d)
wasm_library(box2d SOURCES ${box2d}/src/*/*.cpp INCLUDE ${box2d}/include ${box2d}/src)
target_link_libraries(box2d PUBLIC sinf)
add_library(box2d::box2d ALIAS box2d)

source_of(pugixml pugixml)
wasm_library(pugixml SOURCES ${pugixml}/src/*.cpp INCLUDE ${pugixml}/src)
add_library(pugixml::pugixml ALIAS pugixml)

source_of(zlib zlib)
wasm_library(zlib SOURCES ${zlib}/*.c INCLUDE ${zlib})
target_compile_definitions(zlib PRIVATE HAVE_UNISTD_H)  # lseek() without its prototype would be a trap
add_library(ZLIB::ZLIB ALIAS zlib)

source_of(glpk glpk)  # what its simplex method draws in
wasm_library(glpk SOURCES ${glpk}/src/api/advbas.c ${glpk}/src/api/prob*.c ${glpk}/src/api/wrmip.c
  ${glpk}/src/bflib/*.c ${glpk}/src/draft/*.c ${glpk}/src/env/*.c ${glpk}/src/intopt/*.c ${glpk}/src/misc/*.c
  ${glpk}/src/npp/*.c ${glpk}/src/proxy/*.c ${glpk}/src/simplex/*.c INCLUDE ${glpk}/src)
foreach(part amd api bflib colamd draft env intopt minisat misc mpl npp proxy simplex zlib)
  target_include_directories(glpk PRIVATE ${glpk}/src/${part})
endforeach()
set(GLPK_INCLUDE_DIR ${glpk}/src)
set(GLPK_LIBRARY glpk)

# SPQR with what it calls of SuiteSparse, in the version for `long`, and of LAPACK.
source_of(suitesparse suitesparse)
wasm_library(spqr
  SOURCES ${suitesparse}/SPQR/Source/*.cpp ${suitesparse}/CHOLMOD/Core/cholmod_*.c ${suitesparse}/CHOLMOD/Cholesky/cholmod_*.c
    ${suitesparse}/CHOLMOD/Supernodal/cholmod_super_symbolic.c ${suitesparse}/AMD/Source/*.c
    ${suitesparse}/COLAMD/Source/colamd.c ${suitesparse}/SuiteSparse_config/SuiteSparse_config.c
    ${CMAKE_CURRENT_LIST_DIR}/lapack.cpp
  INCLUDE ${suitesparse}/SuiteSparse_config ${suitesparse}/AMD/Include ${suitesparse}/COLAMD/Include
    ${suitesparse}/CHOLMOD/Include ${suitesparse}/SPQR/Include)
target_compile_definitions(spqr PRIVATE DLONG NPARTITION NTIMER)
target_link_libraries(spqr PRIVATE Eigen3::Eigen)
set(SUITESPARSE_INCLUDE_DIR ${suitesparse}/SPQR/Include)
set(SPQR_LIBRARY spqr)
set(CHOLMOD_LIBRARY spqr)

foreach(package Boost box2d CGAL CLI11 Eigen3 fmt nlohmann_json pugixml ZLIB)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}Config.cmake "")
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}ConfigVersion.cmake "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
endforeach()
