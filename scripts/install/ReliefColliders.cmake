# SPDX-License-Identifier: Apache-2.0
# Bakes colliders in a build: Make and Ninja rebake only what changed.
#
#   relief_add_colliders(<target> RECIPE <recipe.toml> [OUTPUT_DIR <dir>])
#
# Adds a target that is built by default. One command bakes the whole recipe into <dir> (default: the current binary directory).
# The build also depends on the materials, buffers and other files that a mesh refers to, and on `relief`. Each warning is
# printed once.
#
# Ninja runs RELIEF_BAKE_JOBS of these commands at a time (default: 2), because each of them uses all cores.

function(relief_add_colliders target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "RECIPE;OUTPUT_DIR" "")
    if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES OR NOT arg_RECIPE)
        message(FATAL_ERROR "relief_add_colliders(${target}): expected RECIPE and optionally OUTPUT_DIR, not "
                            "'${arg_UNPARSED_ARGUMENTS}${arg_KEYWORDS_MISSING_VALUES}'")
    endif()
    if(NOT TARGET Relief::relief)
        message(FATAL_ERROR "relief_add_colliders(${target}): the tool `relief` is not installed; "
                            "require it with find_package(Relief REQUIRED COMPONENTS bake)")
    endif()
    set(folder ${CMAKE_CURRENT_BINARY_DIR})
    if(arg_OUTPUT_DIR)
        get_filename_component(folder ${arg_OUTPUT_DIR} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
    endif()
    file(MAKE_DIRECTORY ${folder})
    set(RELIEF_BAKE_JOBS 2 CACHE STRING "Number of relief_add_colliders() commands that Ninja runs at a time")
    get_property(pools GLOBAL PROPERTY JOB_POOLS)
    if(NOT pools MATCHES "(^|;)relief_bakes=")
        set_property(GLOBAL APPEND PROPERTY JOB_POOLS relief_bakes=${RELIEF_BAKE_JOBS})
    endif()
    get_filename_component(recipe ${arg_RECIPE} ABSOLUTE)
    set(stamp ${CMAKE_CURRENT_BINARY_DIR}/${target}.stamp)
    add_custom_command(
        OUTPUT ${stamp}
        COMMAND Relief::relief bake --recipe ${recipe} -o ${folder} --stamp ${stamp} --depfile ${stamp}.d --warnings-only
        DEPENDS ${recipe} Relief::relief
        DEPFILE ${stamp}.d
        JOB_POOL relief_bakes
        COMMENT "Baking the colliders of ${arg_RECIPE}"
        VERBATIM)
    add_custom_target(${target} ALL DEPENDS ${stamp})
endfunction()
