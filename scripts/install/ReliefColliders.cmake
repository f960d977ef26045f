# Colliders as part of a build: CMake, Make and Ninja bake again exactly what changed.
#
#   relief_add_colliders(<target> RECIPE <recipe.toml> [OUTPUT_DIR <dir>])
#   relief_add_colliders(<target> MESHES <mesh>… [OPTIONS <option>…] [OUTPUT_DIR <dir>])
#
# Adds a target that is built by default. With RECIPE one command bakes all that the recipe lists. With MESHES one command
# a mesh bakes <dir>/<name of the mesh>.relief, with these options of `relief bake`; the target's property RELIEF_COLLIDERS
# lists them. <dir> is by default the current binary directory. The build also watches materials, buffers and other files
# that a mesh refers to, and `relief` itself. Warnings are printed, once each.
#
# Ninja runs RELIEF_BAKE_JOBS of these commands at a time, 2 by default: each of them uses all cores.

function(relief_add_colliders target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "RECIPE;OUTPUT_DIR" "MESHES;OPTIONS")
    if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES)
        message(FATAL_ERROR "relief_add_colliders(${target}): do not understand "
                            "'${arg_UNPARSED_ARGUMENTS}${arg_KEYWORDS_MISSING_VALUES}'")
    endif()
    if((arg_RECIPE AND (arg_MESHES OR arg_OPTIONS)) OR NOT (arg_RECIPE OR arg_MESHES))
        message(FATAL_ERROR "relief_add_colliders(${target}): give RECIPE, or MESHES and perhaps OPTIONS")
    endif()
    if(NOT TARGET Relief::relief)
        message(FATAL_ERROR "relief_add_colliders(${target}): the tool `relief` is not installed; "
                            "find_package(Relief REQUIRED COMPONENTS bake) says so at once")
    endif()
    set(folder ${CMAKE_CURRENT_BINARY_DIR})
    if(arg_OUTPUT_DIR)
        get_filename_component(folder ${arg_OUTPUT_DIR} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_BINARY_DIR})
    endif()
    file(MAKE_DIRECTORY ${folder})
    set(RELIEF_BAKE_JOBS 2 CACHE STRING "Commands of relief_add_colliders() that Ninja runs at a time")
    get_property(pools GLOBAL PROPERTY JOB_POOLS)
    if(NOT pools MATCHES "(^|;)relief_bakes=")
        set_property(GLOBAL APPEND PROPERTY JOB_POOLS relief_bakes=${RELIEF_BAKE_JOBS})
    endif()

    if(arg_RECIPE)
        get_filename_component(recipe ${arg_RECIPE} ABSOLUTE)
        set(stamp ${CMAKE_CURRENT_BINARY_DIR}/${target}.stamp)
        add_custom_command(
            OUTPUT ${stamp}
            COMMAND Relief::relief bake --recipe ${recipe} -o ${folder} --stamp ${stamp} --depfile ${stamp}.d
                    --warnings-only
            DEPENDS ${recipe} Relief::relief
            DEPFILE ${stamp}.d
            JOB_POOL relief_bakes
            COMMENT "Baking the colliders of ${arg_RECIPE}"
            VERBATIM)
        add_custom_target(${target} ALL DEPENDS ${stamp})
        return()
    endif()

    set(outputs)
    foreach(given IN LISTS arg_MESHES)
        get_filename_component(mesh ${given} ABSOLUTE)
        get_filename_component(name ${mesh} NAME_WLE)
        set(output ${folder}/${name}.relief)
        if(output IN_LIST outputs)
            message(FATAL_ERROR "relief_add_colliders(${target}): two meshes would be baked to ${output}")
        endif()
        list(APPEND outputs ${output})
        add_custom_command(
            OUTPUT ${output}
            COMMAND Relief::relief bake ${mesh} -o ${output} --depfile ${output}.d --warnings-only ${arg_OPTIONS}
            DEPENDS ${mesh} Relief::relief
            DEPFILE ${output}.d
            JOB_POOL relief_bakes
            COMMENT "Baking ${name}.relief"
            VERBATIM)
    endforeach()
    add_custom_target(${target} ALL DEPENDS ${outputs})
    set_property(TARGET ${target} PROPERTY RELIEF_COLLIDERS ${outputs})
endfunction()
