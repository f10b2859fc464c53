# Compiles through ccache when it is there, in a build of our own and where nobody chose a launcher.
if(PROJECT_IS_TOP_LEVEL)
    find_program(FW_CCACHE ccache)
    if(FW_CCACHE)
        foreach(language C CXX)
            if(NOT CMAKE_${language}_COMPILER_LAUNCHER)
                # ccache takes files that use a precompiled header only when both are set: its own
                # sloppiness and GCC's option. With a base folder, and __FILE__ relative to it,
                # clones share what it holds.
                set(CMAKE_${language}_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
                    CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}
                    ${FW_CCACHE})
                add_compile_options($<$<COMPILE_LANG_AND_ID:${language},GNU>:-fpch-preprocess>
                    $<$<COMPILE_LANG_AND_ID:${language},GNU,Clang>:-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=>)
            endif()
        endforeach()
    endif()
endif()
