# SPDX-License-Identifier: Apache-2.0
# Speeds up builds without changing their results: the fastest available linker, ccache if it is installed, precompiled
# headers, and unity builds.
find_program(RELIEF_LINKER NAMES mold ld.lld)
if(RELIEF_LINKER AND NOT EMSCRIPTEN)
    cmake_path(GET RELIEF_LINKER FILENAME linker)
    string(REPLACE "ld.lld" "lld" linker ${linker})
    add_link_options(-fuse-ld=${linker})
endif()

# ccache supports precompiled headers only with these settings.
find_program(RELIEF_CCACHE ccache)
if(RELIEF_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}/..
        CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${RELIEF_CCACHE})
endif()

set(RELIEF_PRECOMPILED_HEADERS
    <algorithm> <array> <charconv> <chrono> <cmath> <cstddef> <cstdint> <cstring> <filesystem> <functional>
    <limits> <memory> <optional> <span> <string> <string_view> <utility> <vector>
    <glm/glm.hpp> <tl/expected.hpp>)

# relief_precompiled(NAME [LIBRARY…]): adds a target whose precompiled headers others reuse. They include GoogleTest if it is
# among the libraries.
function(relief_precompiled name)
    if(NOT RELIEF_PRECOMPILE)
        return()
    endif()
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "// For its precompiled headers.\n")
    add_library(${name} STATIC ${source})
    target_link_libraries(${name} PRIVATE relief_options glm::glm ${ARGN})
    target_precompile_headers(${name} PRIVATE ${RELIEF_PRECOMPILED_HEADERS})
    if("GTest::gtest" IN_LIST ARGN)
        target_precompile_headers(${name} PRIVATE <gtest/gtest.h>)
    endif()
endfunction()

# relief_precompile(TARGET FROM): compiles TARGET with the precompiled headers of FROM.
function(relief_precompile target from)
    if(NOT RELIEF_PRECOMPILE)
        return()
    endif()
    target_precompile_headers(${target} REUSE_FROM ${from})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # GCC 12 loses the system-header mark of precompiled headers, and warns about copies inside std::string that never
        # happen. scripts/nightly.sh headers builds without precompiled headers and with these warnings.
        target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
                                                 -Wno-stringop-overread)
    endif()
endfunction()

# relief_unity(TARGET): compiles up to eight sources as one, in about half the time. Use it for folders whose sources include
# the same headers or instantiate the same large templates (CLI11, nlohmann's JSON). Names in anonymous namespaces must be
# unique among the sources of the folder, and must not overload GLM functions.
function(relief_unity target)
    if(RELIEF_UNITY)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    endif()
endfunction()

# relief_unity_by_folder(TARGET): like relief_unity, but joins only sources of the same folder.
function(relief_unity_by_folder target)
    if(RELIEF_UNITY)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
        get_target_property(sources ${target} SOURCES)
        foreach(source IN LISTS sources)
            cmake_path(GET source PARENT_PATH folder)
            string(MAKE_C_IDENTIFIER "${folder}" group)
            set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
        endforeach()
    endif()
endfunction()
