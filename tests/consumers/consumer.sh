#!/bin/bash
# Builds and runs one consumer project the way a host would. Usage: consumer.sh NAME, with the build
# folder of the library in FW_BUILD_FOLDER. Status 0: the host built and ran.
set -euo pipefail
name=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder of the library}
work="$build/consumers/$name"
# Not the real prefix: a moved tree must work as well, so install here and rename.
prefix="$work/moved prefix"
rm -rf "$work"
mkdir -p "$work"
unset CMAKE_PREFIX_PATH PKG_CONFIG_PATH LD_LIBRARY_PATH

install_library() {
    cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
    mv "$work/prefix" "$prefix"
}

library_folder() {
    dirname "$(find "$prefix" -name libflamewright.so)"
}

build_project() {
    cmake -S "$here/$name" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@"
    cmake --build "$work/build"
}

case $name in
    installed_c | installed_cpp)
        install_library
        build_project "-DCMAKE_PREFIX_PATH=$prefix"
        "$work/build/consumer"
        ;;
    subdirectory)
        launcher=()
        command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
        CCACHE_BASEDIR=$(cd "$here/../.." && pwd)  # clones share what it holds
        export CCACHE_BASEDIR
        # Compiles each source separately and without precompiled headers, so that a missing include
        # fails here; Debug without debug information, because the whole library is compiled.
        build_project "-DFLAMEWRIGHT_SOURCE=$CCACHE_BASEDIR" -DCMAKE_BUILD_TYPE=Debug \
            -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DFW_BUILD_PORTABLE=ON \
            "${launcher[@]}"
        "$work/build/consumer"
        cmake --build "$work/build" --target flamewright_portable
        ;;
    pkg_config)
        install_library
        PKG_CONFIG_PATH=$(library_folder)/pkgconfig
        export PKG_CONFIG_PATH
        # pkg-config escapes the space in the prefix, so its answer is read as the shell would.
        declare -a flags
        eval "flags=($(pkg-config --cflags --libs flamewright))"
        cc -std=c11 -o "$work/consumer" "$here/common/host.c" "${flags[@]}"
        LD_LIBRARY_PATH=$(library_folder) "$work/consumer"
        ;;
    dlopen)
        install_library
        cc -std=c11 -Wall -Wextra -Wpedantic -Werror "-I$prefix/include" \
            -o "$work/consumer" "$here/dlopen/host.c" -ldl
        "$work/consumer" "$(library_folder)/libflamewright.so"
        ;;
    *)
        echo "consumer.sh: no consumer is named \"$name\"" >&2
        exit 2
        ;;
esac
