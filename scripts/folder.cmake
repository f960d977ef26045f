# SPDX-License-Identifier: Apache-2.0
# relief_folder(FOLDER [UNITY] [NUMBERS] [READER] [USES FOLDER…] [LINKS LIBRARY…] [PUBLIC LIBRARY…] [EXCEPT FILE…])
# Adds a library of every .cpp of FOLDER, except the files after EXCEPT. The target's name is FOLDER with _ for /.
#
# Its sources can include the headers of FOLDER, of the folders it USES, and of the folders that those use. Other includes do
# not compile: each folder has its own include root in the build tree, which contains only a link to that folder. USES accepts
# only folders declared earlier, so dependencies have no cycles.
#
# UNITY  joins sources (scripts/fast_build.cmake).
# NUMBERS  marks a folder whose tests take minutes without optimisation: sanitizer builds optimise only these folders.
# READER  marks a folder that reads untrusted bytes: RELIEF_SANITIZE=READERS instruments only these folders.
# LINKS  lists libraries that only the sources use.
# PUBLIC  lists libraries whose headers the folder's own headers include.
function(relief_folder folder)
    cmake_parse_arguments(ARG "UNITY;NUMBERS;READER" "" "USES;LINKS;PUBLIC;EXCEPT" ${ARGN})
    string(REPLACE / _ target ${folder})
    set(root ${PROJECT_BINARY_DIR}/folders/${target})
    cmake_path(GET folder PARENT_PATH parent)
    file(MAKE_DIRECTORY ${root}/${parent})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)

    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
    list(TRANSFORM ARG_EXCEPT PREPEND ${PROJECT_SOURCE_DIR}/${folder}/)
    list(REMOVE_ITEM sources ${ARG_EXCEPT})
    add_library(${target} STATIC ${sources})
    target_include_directories(${target} PUBLIC ${root})
    target_link_libraries(${target} PUBLIC relief_options ${ARG_PUBLIC} PRIVATE ${ARG_LINKS})
    set(kind)
    if(ARG_NUMBERS)
        set(kind NUMBERS)
    endif()
    if(ARG_READER)
        list(APPEND kind READER)
    endif()
    relief_compile_as(${target} ${kind})
    if(ARG_UNITY)
        relief_unity(${target})
    endif()
    foreach(used IN LISTS ARG_USES)
        string(REPLACE / _ used_target ${used})
        if(NOT TARGET ${used_target})
            message(FATAL_ERROR "${folder} uses ${used}, which is declared later or not at all")
        endif()
        target_link_libraries(${target} PUBLIC ${used_target})
    endforeach()
    # For tests/arrows.py, which explains forbidden includes; the compiler reports only a missing file.
    string(REPLACE ";" " " uses "${ARG_USES}")
    set_property(GLOBAL APPEND PROPERTY RELIEF_FOLDERS "${folder}: ${uses}")
endfunction()

# relief_folder_options(OUT [NUMBERS] [READER]): sets OUT to the compile options of a folder of this kind in a sanitizer build.
function(relief_folder_options out)
    set(options)
    if(RELIEF_SANITIZE AND "NUMBERS" IN_LIST ARGN)
        list(APPEND options -O1)
    endif()
    if(RELIEF_SANITIZE STREQUAL "READERS" AND "READER" IN_LIST ARGN)
        list(APPEND options ${RELIEF_SANITIZE_OPTIONS})
    endif()
    set(${out} "${options}" PARENT_SCOPE)
endfunction()

# relief_precompiled_folders(): adds a set of precompiled headers for each combination of options.
function(relief_precompiled_folders)
    relief_precompiled(relief_headers)
    if(NOT RELIEF_SANITIZE OR NOT RELIEF_PRECOMPILE)
        return()
    endif()
    foreach(kind NUMBERS READER "NUMBERS;READER")
        string(REPLACE ";" _ name "relief_headers_${kind}")
        relief_precompiled(${name})
        relief_folder_options(options ${kind})
        target_compile_options(${name} PRIVATE ${options})
    endforeach()
endfunction()

# relief_compile_as(TARGET [NUMBERS] [READER]): compiles TARGET with the options of a folder of this kind.
function(relief_compile_as target)
    relief_folder_options(options ${ARGN})
    target_compile_options(${target} PRIVATE ${options})
    set(headers relief_headers)
    if(RELIEF_SANITIZE AND ARGN)
        string(REPLACE ";" _ headers "relief_headers_${ARGN}")
    endif()
    relief_precompile(${target} ${headers})
endfunction()

# relief_unit(FOLDER FILE [LINKS LIBRARY…] [OPTIONS …])
# Adds FILE, which FOLDER excludes with EXCEPT, to FOLDER with its own libraries or options, which the other files must not use.
function(relief_unit folder file)
    cmake_parse_arguments(ARG "" "" "LINKS;OPTIONS" ${ARGN})
    string(REPLACE / _ target ${folder})
    cmake_path(GET file STEM stem)
    set(unit ${target}_${stem})
    add_library(${unit} OBJECT ${PROJECT_SOURCE_DIR}/${folder}/${file})
    target_include_directories(${unit} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
    target_compile_options(${unit} PRIVATE ${ARG_OPTIONS})
    target_link_libraries(${unit} PRIVATE relief_options ${ARG_LINKS})
    target_link_libraries(${target} PRIVATE ${unit})
endfunction()

# relief_archive(NAME FOLDER… [WITHIN FOLDER…])
# Adds one library of several folders, for other people's programs. All headers of these folders are public, except those of
# the folders after WITHIN, which only sources include.
function(relief_archive name)
    cmake_parse_arguments(ARG "" "" "WITHIN" ${ARGN})
    set(objects)
    set(roots)
    foreach(folder IN LISTS ARG_WITHIN)
        string(REPLACE / _ target ${folder})
        list(APPEND objects $<TARGET_OBJECTS:${target}>)
    endforeach()
    foreach(folder IN LISTS ARG_UNPARSED_ARGUMENTS)
        string(REPLACE / _ target ${folder})
        list(APPEND objects $<TARGET_OBJECTS:${target}>)
        list(APPEND roots $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/folders/${target}>)
    endforeach()
    add_library(${name} STATIC ${objects})
    set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX RELIEF_FOLDERS "${ARG_UNPARSED_ARGUMENTS}")
    target_include_directories(${name} INTERFACE ${roots})
endfunction()
