# Sourced by samples/run, tests/run and .ci/run: installs, configures and builds. Not run by itself.
# shellcheck shell=bash

fw_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Prints "name: text" on stderr and leaves with status 2, for wrong arguments.
fw_usage_error() {
    echo "$(basename "$(dirname "$0")")/$(basename "$0"): $1" >&2
    exit 2
}

# fw_build PRESET TARGET...: configures (quietly, unless it fails) and builds into build/PRESET.
# The environment variable FW_WARNINGS_AS_ERRORS (ON or OFF) passes through to CMake,
# and so does FW_UNITY (OFF: what a file changes compiles sooner, everything later).
# FW_ASSERTIONS=ON checks the library's invariants; unset, the preset or the folder decides.
# FW_TESTS=OFF leaves out the tests and the bench, whose packages samples do without. A folder that has
# them keeps them: without them for one run, the run after it would build them again.
fw_build() {
    local preset=$1
    shift
    local log="$fw_root/build/$preset-configure.log"
    local parts=()
    if [[ $preset == release ]]; then
        local tests=${FW_TESTS:-ON}
        ! grep -q -s -w flamewright_unit_tests "$fw_root/build/$preset/build.ninja" || tests=ON
        parts=("-DFW_BUILD_TESTS=$tests" "-DFW_BUILD_BENCH=$tests")
    fi
    [[ -z ${FW_ASSERTIONS:-} ]] || parts+=("-DFW_ASSERTIONS=$FW_ASSERTIONS")
    mkdir -p "$fw_root/build"
    if ! (cd "$fw_root" && cmake --preset "$preset" \
        "-DFW_WARNINGS_AS_ERRORS=${FW_WARNINGS_AS_ERRORS:-OFF}" \
        "-DFW_UNITY=${FW_UNITY:-ON}" "${parts[@]}") >"$log" 2>&1; then
        cat "$log" >&2
        echo "configuring build/$preset failed (output above)" >&2
        return 1
    fi
    cmake --build "$fw_root/build/$preset" --parallel "$(nproc)" --target "$@"
}
