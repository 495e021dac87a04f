# The window as a page of a browser, in one file: the program, the scenes and the font.
source_of(imgui imgui)
wasm_library(imgui SOURCES ${imgui}/imgui.cpp ${imgui}/imgui_draw.cpp ${imgui}/imgui_tables.cpp ${imgui}/imgui_widgets.cpp
  ${imgui}/misc/cpp/imgui_stdlib.cpp ${imgui}/backends/imgui_impl_glfw.cpp ${imgui}/backends/imgui_impl_opengl3.cpp INCLUDE ${imgui} ${imgui}/misc/cpp)
target_compile_definitions(imgui PUBLIC IMGUI_IMPL_OPENGL_ES3)

add_executable(ductile_page EXCLUDE_FROM_ALL ${desk} page.cpp)
set_target_properties(ductile_page PROPERTIES OUTPUT_NAME index SUFFIX .html)
target_link_libraries(ductile_page PRIVATE ductile_options ductile::workbench fmt::fmt nlohmann_json::nlohmann_json imgui)
set(shell ${CMAKE_CURRENT_SOURCE_DIR}/page.html)
target_link_options(ductile_page PRIVATE --shell-file ${shell} -sSINGLE_FILE -sMINIFY_HTML=0 -sENVIRONMENT=web
  -sUSE_GLFW=3 -sMIN_WEBGL_VERSION=2 -sMAX_WEBGL_VERSION=2 -sGL_SUPPORT_AUTOMATIC_ENABLE_EXTENSIONS=0 -sALLOW_MEMORY_GROWTH -sMAXIMUM_MEMORY=4GB
  -sEXPORTED_RUNTIME_METHODS=ccall -sEXPORTED_FUNCTIONS=_main,_page_state,_page_poses)

file(GLOB scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.scene.json ${PROJECT_SOURCE_DIR}/scenes/*.svg)
foreach(file IN LISTS scenes)
  cmake_path(GET file FILENAME name)
  target_link_options(ductile_page PRIVATE "SHELL:--embed-file ${file}@/scenes/${name}")
endforeach()
set(font /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf)
target_link_options(ductile_page PRIVATE "SHELL:--embed-file ${font}@${font}")
set_target_properties(ductile_page PROPERTIES LINK_DEPENDS "${shell};${scenes}")
add_custom_target(web DEPENDS ductile_page)
