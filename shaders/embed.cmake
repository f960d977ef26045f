# SPDX-License-Identifier: Apache-2.0
# relief_embed_shaders(OUTPUT): generates OUTPUT, a C++ file with the text of all shaders and the constants that C++
# shares with them (shader_sources.h).
#
# Constants are only defined in C++, in the headers below. `inline constexpr int kTileSide = 16;` becomes
# RELIEF_TILE_SIDE in GLSL; members of a struct or enum class are prefixed with its name: RELIEF_CONTACT_STOPPED.
if(NOT CMAKE_SCRIPT_MODE_FILE)
    function(relief_embed_shaders output)
        set(folder ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
        file(GLOB_RECURSE files CONFIGURE_DEPENDS ${folder}/*.comp ${folder}/*.frag ${folder}/*.glsl ${folder}/*.vert)
        # Exclude the folders of disabled layers. (The web build has all layers.)
        foreach(layer air bodies events live picture)
            string(TOUPPER ${layer} upper)
            if(NOT RELIEF_LAYER_${upper})
                list(FILTER files EXCLUDE REGEX "/shaders/${layer}/")
            endif()
        endforeach()
        if(NOT RELIEF_LAYER_LIVE)
            list(FILTER files EXCLUDE REGEX "/shaders/depth_maps/")
        endif()
        if(EMSCRIPTEN)
            list(FILTER files EXCLUDE REGEX "[.]comp$")
        endif()
        file(GLOB headers CONFIGURE_DEPENDS ${folder}/*/constants.h)
        list(APPEND headers ${PROJECT_SOURCE_DIR}/formats/texel.h ${PROJECT_SOURCE_DIR}/formats/depth_map.h
             ${PROJECT_SOURCE_DIR}/formats/normal_index.h)
        add_custom_command(
            OUTPUT ${output}
            COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DFOLDER=${folder} "-DFILES=${files}" "-DHEADERS=${headers}"
                    -P ${folder}/embed.cmake
            DEPENDS ${files} ${headers} ${folder}/embed.cmake
            VERBATIM)
    endfunction()
    return()
endif()

set(constants)
foreach(header IN LISTS HEADERS)
    file(READ ${header} text)
    string(REGEX MATCHALL "(enum class|enum|struct|inline) [A-Za-z]+|[ {]k[A-Z][A-Za-z0-9]* =[ \n]+[^;,}\n]+" tokens "${text}")
    set(prefix)
    foreach(token IN LISTS tokens)
        if(token MATCHES "^(enum class|struct) (.*)")
            set(prefix ${CMAKE_MATCH_2})
        elseif(token MATCHES "^(enum|inline) ")
            set(prefix)
        else()
            string(REGEX MATCH "k([A-Za-z0-9]+) =[ \n]+(.*)" _ "${token}")
            string(REGEX REPLACE "([a-z0-9])([A-Z])" "\\1_\\2" name "${prefix}${CMAKE_MATCH_1}")
            string(TOUPPER ${name} name)
            string(REGEX MATCH "k[A-Za-z0-9]+ =[ \n]+(.*)" _ "${token}")
            string(REGEX REPLACE "([0-9.])F" "\\1" value "${CMAKE_MATCH_1}")
            string(STRIP "${value}" value)
            # Single words stay without parentheses: GLSL ES does not allow expressions in layout(…).
            if(value MATCHES "^-| ")
                set(value "(${value})")
            endif()
            string(APPEND constants "#define RELIEF_${name} ${value}\n")
        endif()
    endforeach()
endforeach()

set(text "// Generated from shaders/ by embed.cmake.\n#include \"shaders/shader_sources.h\"\n\nnamespace relief {\n\n")
string(APPEND text "std::string_view shaderConstants() {\n    return R\"GLSL(${constants})GLSL\";\n}\n\n")
string(APPEND text "std::string_view shaderSource(std::string_view name) {\n")
foreach(file IN LISTS FILES)
    file(RELATIVE_PATH name ${FOLDER} ${file})
    file(READ ${file} source)
    string(REGEX REPLACE "^// SPDX-[^\n]*\n" "" source "${source}")
    string(APPEND text "    if (name == \"${name}\") {\n        return R\"GLSL(${source})GLSL\";\n    }\n")
endforeach()
string(APPEND text "    return {};\n}\n\n}  // namespace relief\n")
file(WRITE ${OUTPUT} "${text}")
