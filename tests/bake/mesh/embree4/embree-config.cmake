# SPDX-License-Identifier: Apache-2.0
# A package of Embree 4 to test with: include/embree4 says what it is.
find_library(EMBREE3_LIBRARY embree3 REQUIRED)
add_library(embree SHARED IMPORTED)
set_target_properties(embree PROPERTIES IMPORTED_LOCATION ${EMBREE3_LIBRARY}
                                        INTERFACE_INCLUDE_DIRECTORIES ${CMAKE_CURRENT_LIST_DIR}/include)
