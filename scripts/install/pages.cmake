# Writes an executable's manual pages and completions, from what it says of its own command line:
#   cmake -DTOOL=…/relief -DOUTPUT=DIR -P pages.cmake
function(dump format file)
    execute_process(COMMAND ${TOOL} --dump-cli ${format} OUTPUT_FILE ${OUTPUT}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

get_filename_component(name ${TOOL} NAME)
file(REMOVE_RECURSE ${OUTPUT})
file(MAKE_DIRECTORY ${OUTPUT}/man/man1 ${OUTPUT}/bash-completion/completions ${OUTPUT}/zsh/site-functions
     ${OUTPUT}/fish/vendor_completions.d)
dump(man man/man1/${name}.1)
execute_process(COMMAND ${TOOL} --dump-cli json OUTPUT_VARIABLE json COMMAND_ERROR_IS_FATAL ANY)
string(JSON count LENGTH "${json}" verbs)
if(count GREATER 0)
    math(EXPR last "${count} - 1")
    foreach(i RANGE ${last})
        string(JSON verb GET "${json}" verbs ${i} name)
        dump(man:${verb} man/man1/${name}-${verb}.1)
    endforeach()
endif()
dump(bash bash-completion/completions/${name})
dump(zsh zsh/site-functions/_${name})
dump(fish fish/vendor_completions.d/${name}.fish)
