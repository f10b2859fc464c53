# flamewright_warnings(target): our warning set, on our own targets only; never a global flag.
function(flamewright_warnings target)
    target_compile_options(${target} PRIVATE
        $<$<CXX_COMPILER_ID:GNU,Clang>:-Wall;-Wextra;-Wpedantic;-Wshadow>
        $<$<AND:$<CXX_COMPILER_ID:GNU,Clang>,$<BOOL:${FW_WARNINGS_AS_ERRORS}>>:-Werror>)
endfunction()
