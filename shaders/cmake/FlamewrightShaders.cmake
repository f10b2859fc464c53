# Compiles GLSL to SPIR-V words and gathers them in one object library.
# Not a shader language front end: glslangValidator does the work and writes the dependency files.

find_program(FW_GLSLANG glslangValidator REQUIRED)

# flamewright_shaders(target function entry...)
# function: returns all shaders; "embeddedShaders" is declared in embedded_shaders.h
# An entry is one string:
#   "burn/arrival.comp"                                  -> name "arrival.comp"
#   "burn/arrival.comp AS arrival_rim.comp A=1 B"  -> a variant compiled with -DA=1 -DB
function(flamewright_shaders target function)
    set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
    file(MAKE_DIRECTORY ${generated})
    set(includes "")
    set(rows "")
    set(headers "")
    set(names "")
    foreach(entry IN LISTS ARGN)
        separate_arguments(words UNIX_COMMAND "${entry}")
        list(POP_FRONT words path)
        get_filename_component(name ${path} NAME)
        if(words)
            list(POP_FRONT words as name)
            if(NOT as STREQUAL "AS" OR NOT name)
                message(FATAL_ERROR "shader entry \"${entry}\": expected \"path [AS name [DEFINE...]]\"")
            endif()
        endif()
        if(name IN_LIST names)
            message(FATAL_ERROR "shader entry \"${entry}\": the name ${name} is already taken")
        endif()
        list(APPEND names ${name})
        set(source ${CMAKE_CURRENT_SOURCE_DIR}/${path}.glsl)
        if(NOT EXISTS ${source})
            message(FATAL_ERROR "shader entry \"${entry}\": ${source} does not exist")
        endif()
        if(NOT path MATCHES "\\.(comp|vert|frag)$")
            message(FATAL_ERROR "shader entry \"${entry}\": the stage is none of comp, vert, frag")
        endif()
        set(stage ${CMAKE_MATCH_1})
        list(TRANSFORM words PREPEND "-D")
        string(MAKE_C_IDENTIFIER "k_${name}" variable)
        set(header ${generated}/${name}.inc)
        # Every shader begins with this. Its own text is included, so that errors name its lines.
        set(begin ${generated}/${name}.glsl)
        # FW_VARYING declares what passes from the vertex to the fragment stage, for both.
        set(varying in)
        if(stage STREQUAL vert)
            set(varying out)
        endif()
        file(CONFIGURE OUTPUT ${begin} CONTENT
"#version 450
#extension GL_GOOGLE_include_directive : require
#define FW_VARYING ${varying}
#include \"${path}.glsl\"
")
        add_custom_command(
            OUTPUT ${header}
            COMMAND ${FW_GLSLANG} --quiet -V --target-env vulkan1.0 -S ${stage}
                    -I${CMAKE_CURRENT_SOURCE_DIR} -I${CMAKE_CURRENT_SOURCE_DIR}/shaders
                    -I${PROJECT_SOURCE_DIR}/shaders -I${PROJECT_SOURCE_DIR}/runtime ${words}
                    --vn ${variable} --depfile ${header}.d -o ${header} ${begin}
            DEPENDS ${begin} ${source}
            DEPFILE ${header}.d
            COMMENT "Shader ${name}"
            VERBATIM)
        list(APPEND headers ${header})
        string(APPEND includes "#include \"${name}.inc\"\n")
        string(APPEND rows "    {\"${name}\", ${variable}},\n")
    endforeach()

    set(FW_SHADER_FUNCTION ${function})
    string(REGEX REPLACE "([A-Z])" "_\\1" FW_SHADER_HEADER ${function}.h)
    string(TOLOWER ${FW_SHADER_HEADER} FW_SHADER_HEADER)
    set(FW_SHADER_INCLUDES "${includes}")
    set(FW_SHADER_ROWS "${rows}")
    list(LENGTH names FW_SHADER_COUNT)
    configure_file(${PROJECT_SOURCE_DIR}/shaders/cmake/embedded_shaders.cpp.in
                   ${generated}/embedded_shaders.cpp @ONLY)
    configure_file(${PROJECT_SOURCE_DIR}/shaders/cmake/embedded_shaders.h.in
                   ${generated}/${FW_SHADER_HEADER} @ONLY)
    add_library(${target} OBJECT ${generated}/embedded_shaders.cpp ${headers})
    target_include_directories(${target} PUBLIC ${generated} ${PROJECT_SOURCE_DIR}/shaders)
    set_target_properties(${target} PROPERTIES
        POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
