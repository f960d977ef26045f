# SPDX-License-Identifier: Apache-2.0
# A substitute for the Embree 4 package, described in include/embree4/rtcore.h.
find_library(EMBREE3_LIBRARY embree3 REQUIRED)
add_library(embree SHARED IMPORTED)
set_target_properties(embree PROPERTIES IMPORTED_LOCATION ${EMBREE3_LIBRARY}
                                        INTERFACE_INCLUDE_DIRECTORIES ${CMAKE_CURRENT_LIST_DIR}/include)
