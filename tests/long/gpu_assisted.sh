#!/bin/bash
# GPU-assisted validation of the whole GPU suite; 18 minutes at a time
# build: flamewright_gpu_tests
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/tests/flamewright_gpu_tests"
folder=${FW_LONG_FOLDER:?set FW_LONG_FOLDER to a folder for results}
export FLAMEWRIGHT_GPU_ASSISTED=1 FLAMEWRIGHT_TEST_OUT="$folder"

# A test suite is a part: its tests share what the driver compiles, which takes most of the time.
mapfile -t suites < <("$binary" --gtest_list_tests | sed -n 's/^\([^ ].*\.\).*/\1/p' | sort -u)
# run_suite NAME: unless an earlier run passed it.
run_suite() {
    local file="$folder/${1//\//_}"
    [[ ! -f ${file}passed && $SECONDS -lt 1080 ]] || return 0
    if timeout --kill-after=10 $((1190 - SECONDS)) "$binary" --gtest_filter="$1*" >"${file}log" 2>&1; then
        touch "${file}passed"
        echo "$1 $(tail -n 1 "${file}log")"
    elif [[ $SECONDS -lt 1180 ]]; then
        tail -n 60 "${file}log"
        touch "$folder/failed"
    fi
}
rm -f "$folder/failed"
for suite in "${suites[@]}"; do
    while [[ $(jobs -r -p | wc -l) -ge $(nproc) ]]; do wait -n || true; done
    run_suite "$suite" &
done
wait
passed=$(find "$folder" -name '*.passed' | wc -l)
echo "$passed of ${#suites[@]} test suites passed"
[[ ! -f $folder/failed ]] || exit 1
[[ $passed -eq ${#suites[@]} ]] || exit 75
