# SPDX-License-Identifier: Apache-2.0
# relief_view_page(OUTPUT): writes the page of `relief view`, without data: as .html, or as .cpp that embeds it
# (runtime/page/page.h).
#
# A page opened from disk cannot import files, so all modules become one script. Imports and the word `export` are removed,
# so top-level names must be unique across modules.
if(NOT CMAKE_SCRIPT_MODE_FILE)
    function(relief_view_page output)
        set(folder ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
        file(GLOB parts CONFIGURE_DEPENDS ${folder}/*.js ${folder}/*.css ${folder}/*.html)
        add_custom_command(
            OUTPUT ${output}
            COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -P ${folder}/page.cmake
            DEPENDS ${parts} ${folder}/page.cmake
            VERBATIM)
    endfunction()
    return()
endif()

# Each module follows the modules that its top-level code uses.
set(modules math colors gl quality page_data page_collider patches cells ray_shader body_shaders body view camera map_images particles bodies
            panel world_panel main)
set(folder ${CMAKE_CURRENT_LIST_DIR})
file(READ ${folder}/index.html html)
file(READ ${folder}/style.css style)
string(REPLACE "/* style.css */" "${style}" html "${html}")
string(FIND "${html}" "/* main.js */" at)
string(SUBSTRING "${html}" 0 ${at} page)
string(SUBSTRING "${html}" ${at} -1 end)
string(REPLACE "/* main.js */\n" "" end "${end}")
set(literals "R\"PAGE(${page})PAGE\"")
foreach(module IN LISTS modules)
    file(READ ${folder}/${module}.js text)
    string(REGEX REPLACE "^// SPDX-[^\n]*\n" "" text "${text}")
    string(REGEX REPLACE "\nimport [^;]*;" "" text "${text}")
    string(REPLACE "\nexport " "\n" text "${text}")
    string(APPEND page "${text}")
    string(APPEND literals ",\n    R\"PAGE(${text})PAGE\"")
endforeach()
if(OUTPUT MATCHES "[.]html$")
    file(WRITE ${OUTPUT} "${page}${end}")
    return()
endif()
# Compilers limit the length of one literal.
file(WRITE ${OUTPUT} "// Generated from runtime/web/view by page.cmake.
#include \"runtime/page/page.h\"

namespace relief {

std::string viewPage() {
    std::string page;
    for (const char* part : {${literals},
    R\"PAGE(${end})PAGE\"}) {
        page += part;
    }
    return page;
}

}  // namespace relief
")
