#!/bin/bash
# Builds flamewright_portable in one way, or takes that of the release build, and compares what it
# prints with sessions.txt.
# Usage: portable.sh ROW, with the release build in FW_BUILD_FOLDER for the rows that use it
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=../../third_party/setup.sh
source "$here/../../third_party/setup.sh"
row=${1:?give a row of the case below, such as gcc_O0}
folder="$fw_root/build/portable/$row"
mkdir -p "$folder"

need() {
    local tool
    for tool in "$@"; do
        command -v "$tool" >/dev/null || {
            echo "portable: $tool is not installed; third_party/install.sh --long installs it"
            exit 1
        }
    done
}

# build FLAGS [CMAKE ARGUMENT...]: into the row's folder.
build() {
    {
        cmake -S "$fw_root" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE= "-DCMAKE_CXX_FLAGS=$1" -DFW_UNITY=ON \
            -DFW_BUILD_{SAMPLES,TESTS,BENCH}=OFF -DFW_INSTALL=OFF -DFW_BUILD_PORTABLE=ON "${@:2}" &&
            cmake --build "$folder" --parallel "$(nproc)" --target flamewright_portable
    } >"$folder/log" 2>&1 || {
        cat "$folder/log"
        exit 1
    }
}

# cross SYSTEM PROCESSOR PREFIX SUFFIX: builds with the compilers PREFIX-gccSUFFIX and PREFIX-g++SUFFIX.
# A folder holds the headers that do not depend on the system.
cross() {
    local root="$folder/headers" name
    mkdir -p "$root/include" "$root/share/cmake"
    for name in include/{glm,vulkan,vk_video} share/cmake/glm; do ln -sfn "/usr/$name" "$root/$name"; done
    build -O2 "-DCMAKE_SYSTEM_NAME=$1" "-DCMAKE_SYSTEM_PROCESSOR=$2" "-DCMAKE_C_COMPILER=$3-gcc$4" \
        "-DCMAKE_CXX_COMPILER=$3-g++$4" "-DCMAKE_FIND_ROOT_PATH=$root" \
        -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER -DCMAKE_FIND_ROOT_PATH_MODE_{INCLUDE,PACKAGE}=ONLY
}

# of_build [FOLDER]: the program of the release build, or of a build in a folder of it.
of_build() { echo "${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}${1:-}/tests/portable/flamewright_portable"; }

program=("$folder/tests/portable/flamewright_portable")
case $row in
    inexact)  # a build with fast-math fails, and a process that rounds in another way gets a warning
        if c++ -std=c++20 -fsyntax-only -ffast-math -I "$fw_root/shaders" -include shared/types.h \
            -x c++ /dev/null 2>"$folder/errors" ||
            ! grep -q "error.*Fast-math changes" "$folder/errors"; then
            cat "$folder/errors"
            echo "portable: shaders/shared/types.h does not refuse -ffast-math"
            exit 1
        fi
        warnings=$("$(of_build)" upward)
        [[ $warnings == "log: This build is not exact"* ]] || {
            echo "portable: no warning of a process that rounds upward: \"$warnings\""
            exit 1
        }
        exit 0
        ;;
    release | old_processor | vulkan)
        program=("$(of_build)")
        [[ $row != vulkan ]] || program+=(vulkan)
        # The C library chooses its functions by processor: here those without fused multiplications.
        [[ $row != old_processor ]] || export GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2
        ;;
    gcc_O0)  # a host that compiles the library without optimization, assertions included
        program=("$(of_build /consumers/subdirectory/build/flamewright)")
        bash "$here/../consumers/consumer.sh" subdirectory >"$folder/log" 2>&1 || {
            tail -n 60 "$folder/log"
            exit 1
        }
        ;;
    gcc_O2) build -O2 ;;
    gcc_contract) build "-O3 -march=native -ffp-contract=fast" ;;
    gcc_v3) build "-O2 -march=x86-64-v3" ;;
    gcc_v4) build "-O2 -march=x86-64-v4" ;;
    clang)
        need clang++
        build -O2 -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++
        ;;
    aarch64)
        need qemu-aarch64 aarch64-linux-gnu-g++
        cross Linux aarch64 aarch64-linux-gnu ""
        program=(qemu-aarch64 -L /usr/aarch64-linux-gnu "${program[@]}")
        ;;
    windows)
        wine=/usr/lib/wine/wine64
        need "$wine" x86_64-w64-mingw32-g++-posix
        cross Windows x86_64 x86_64-w64-mingw32 -posix
        export WINEPREFIX="$folder/wine" WINEDEBUG=-all WINEDLLOVERRIDES=mscoree,mshtml=
        program=("$wine" "$folder/plugin/flamewright_portable.exe")
        ;;
    *)
        echo "portable: \"$row\" is no row"
        exit 2
        ;;
esac

# Hashes show a fused multiplication only where it rounds otherwise.
if [[ $row == gcc_* && $row != gcc_O* ]]; then
    fused=$(objdump -d --no-show-raw-insn "$folder/plugin/libflamewright.so" | grep -c -E '\bvfn?m(add|sub)' || true)
    [[ $fused == 0 ]] || { echo "portable: the library of $row has $fused fused multiplications" && exit 1; }
fi
if [[ $row == gcc_v4 ]] && ! grep -q -w avx512f /proc/cpuinfo; then
    echo "portable: the library of gcc_v4 has no fused multiplications; this processor cannot run it"
    exit 0
fi
status=0
"${program[@]}" 2>"$folder/errors" | tr -d '\r' >"$folder/sessions.txt" || status=$?
grep -v '^pcilib:\|^WARNING: lavapipe' "$folder/errors" || true
[[ $status -eq 0 ]] || { echo "portable: $row left with status $status" && exit 1; }
if ! diff "$here/sessions.txt" "$folder/sessions.txt" >"$folder/difference"; then
    head -n 20 "$folder/difference"
    echo "portable: $row differs from tests/portable/sessions.txt in" \
        "$(grep -c '^>' "$folder/difference") lines (the first are above): floating point decides" \
        "state there. $folder/sessions.txt holds all lines."
    exit 1
fi
echo "portable: $row equals the $(wc -l <"$here/sessions.txt") recorded lines"
