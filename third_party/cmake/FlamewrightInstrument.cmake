# Applies FW_SANITIZE and FW_COVERAGE to every target of this project, and to nothing of a host that
# adds us as a subdirectory: options are scoped to our directories, never put in a global flag.
if(FW_SANITIZE)
    add_compile_options(-fsanitize=${FW_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    # The runtime has no RTTI, which the vptr check needs.
    if(FW_SANITIZE MATCHES "undefined")
        add_compile_options(-fno-sanitize=vptr)
    endif()
    add_link_options(-fsanitize=${FW_SANITIZE})
endif()
if(FW_COVERAGE)
    add_compile_options(--coverage)
    add_link_options(--coverage)
endif()
