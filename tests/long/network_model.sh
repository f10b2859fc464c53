#!/bin/bash
# A network of every delay, loss and rate of a grid: ten minutes of session each, and all catch up
# build: flamewright_abi_tests
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/tests/flamewright_abi_tests"
folder=${FW_LONG_FOLDER:?set FW_LONG_FOLDER to a folder for results}

# run_cell DELAY LOSS RATE: unless an earlier run has its line.
run_cell() {
    local file="$folder/cell_$1_$2_$3" status=0
    [[ ! -s $file ]] || return 0
    FLAMEWRIGHT_NET_CELL="$1 $2 $3 600" "$binary" --gtest_also_run_disabled_tests \
        --gtest_filter=NetModel.DISABLED_OneCell >"$file.log" 2>&1 || status=$?
    {
        printf '%5s s %4s %9s B/s | ' "$1" "$2" "$3"
        if [[ $status -eq 0 ]]; then sed -n 's/^cell: //p' "$file.log"; else echo "FAILED ($status)"; fi
    } >"$file.part"
    mv "$file.part" "$file"
}

for delay in 0 0.05 0.2 0.5 1 2; do
    for loss in 0 0.05 0.2 0.4 0.6; do
        for rate in 5000 20000 100000 1000000; do
            while [[ $(jobs -r -p | wc -l) -ge $(nproc) ]]; do wait -n || true; done
            run_cell "$delay" "$loss" "$rate" &
        done
    done
done
wait
echo "  delay loss       rate | settled after | resyncs | overloaded | most behind | memory"
sort -k1,1n -k3,3n -k4,4n "$folder"/cell_*[0-9]
mapfile -t failed < <(grep -l FAILED "$folder"/cell_*[0-9])
[[ ${#failed[@]} -gt 0 ]] || exit 0
rm "${failed[@]}"  # so that they run again
echo "${#failed[@]} cells failed; their logs are in $folder"
exit 1
