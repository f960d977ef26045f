# SPDX-License-Identifier: Apache-2.0
# cpack runs this before it packs: adds the files that Debian's policy requires to the tree of each component.
# gzip -n makes the output reproducible.
find_program(gzip gzip REQUIRED)
set(file_mode OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    string(TOUPPER ${component} key)
    set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/usr)
    set(doc ${root}/share/doc/${CPACK_DEBIAN_${key}_PACKAGE_NAME})
    # Readable by everyone, independent of the builder's umask.
    file(MAKE_DIRECTORY ${doc})
    file(CHMOD ${root}/share ${root}/share/doc ${doc} PERMISSIONS ${file_mode} OWNER_EXECUTE GROUP_EXECUTE WORLD_EXECUTE)
    configure_file(${CPACK_RELIEF_SOURCE}/scripts/install/debian/copyright ${doc}/copyright COPYONLY
                   FILE_PERMISSIONS ${file_mode})
    configure_file(${CPACK_RELIEF_SOURCE}/scripts/install/debian/changelog.in ${doc}/changelog @ONLY
                   FILE_PERMISSIONS ${file_mode})
    file(GLOB pages ${root}/share/man/man1/*.1)
    run(${gzip} -9nf ${doc}/changelog ${pages})
    file(GLOB archives ${root}/lib/*.a ${root}/lib/*/*.a)
    if(archives)
        run(${CPACK_RELIEF_STRIP} --strip-debug --enable-deterministic-archives ${archives})
    endif()
endforeach()
