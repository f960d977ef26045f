# SPDX-License-Identifier: Apache-2.0
# `cpack` builds the .deb files for Debian 12, one per component: relief, librelief1, librelief-dev and python3-relief.
# See README.md in this folder.
set(RELIEF_MAINTAINER "Relief maintainers <maintainers@relief.example>" CACHE STRING
    "Maintainer of the packages that cpack builds: Name <address>")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/deb)
set(CPACK_STRIP_FILES ON)
# As in every Debian package, independent of the builder's umask.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
# Adds compressed pages, copyright and changelog, and removes debug information.
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debianise.cmake)
set(CPACK_RELIEF_SOURCE ${PROJECT_SOURCE_DIR})
set(CPACK_RELIEF_STRIP ${CMAKE_STRIP})

set(CPACK_COMPONENTS_ALL library development tools)
if(NOT RELIEF_BUILD_BAKE)
    list(REMOVE_ITEM CPACK_COMPONENTS_ALL tools)  # the package relief needs the baker
elseif(RELIEF_BUILD_PYTHON)
    list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)  # one package per component
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${RELIEF_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_SOURCE relief)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

# Baking needs no GL, simulating does. libepoxy loads it at run time, so shlibdeps does not find these packages.
set(gl "libegl1, libegl-mesa0, libgl1-mesa-dri, libgles2, libopengl0")
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME relief)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "${gl}")
set(CPACK_DEBIAN_TOOLS_DESCRIPTION "depth map colliders baked from meshes, and a particle player
Relief bakes the outer shape of a mesh into a few depth maps, and collides a
million particles with it in one fragment shader. This package contains `relief`,
which bakes, checks, slices and exports colliders, and `relief-sim`, which
simulates particle scenes without a window.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME librelief1)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "${gl}")
# The dependency of programs that link librelief.so, and the trigger that updates the linker cache.
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/library/shlibs "librelief 1 librelief1 (>= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/library/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/library/shlibs
                                               ${CMAKE_CURRENT_BINARY_DIR}/library/triggers)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "depth map colliders for particles, runtime library
Relief bakes the outer shape of a mesh into a few depth maps, and collides a
million particles with it in one fragment shader. This package contains the
shared library with a C API.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME librelief-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "librelief1 (= ${PROJECT_VERSION}), libepoxy-dev, libexpected-dev, libglm-dev, libxxhash-dev, libzstd-dev, pkgconf | pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS relief)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "depth map colliders for particles, development files
Relief bakes the outer shape of a mesh into a few depth maps, and collides a
million particles with it in one fragment shader. This package contains the
headers, the static libraries, the shaders, the files for CMake and
pkg-config, the documentation and the samples.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-relief)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
if(RELIEF_BUILD_BAKE AND RELIEF_BUILD_PYTHON)
    set(Python3_EXECUTABLE /usr/bin/python3)  # the version our module is built for
    find_package(Python3 REQUIRED COMPONENTS Interpreter)
    math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "${gl}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/postinst
                                              ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "depth map colliders baked from meshes, for Python
Relief bakes the outer shape of a mesh into a few depth maps, and collides a
million particles with it in one fragment shader. This package bakes and
queries colliders with numpy arrays, and simulates particle scenes.")
include(CPack)
