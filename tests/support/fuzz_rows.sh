#!/bin/bash
# Runs each fuzzer of tests/fuzz for some seconds, as many at a time as there are cores, on its seeds,
# its regressions and the corpus of earlier runs (build/fuzz/NAME). An input fails if it crashes, leaks,
# has undefined behaviour, takes over 5 s of processor time, or needs more memory than 256 MiB and 100
# times its size. Called by tests/run --fuzz SECONDS [NAME].
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=../../third_party/setup.sh
source "$here/../third_party/setup.sh"

seconds=${1:-}
named=${2:-}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || fw_usage_error "--fuzz needs a number of seconds"
[[ -z $named || -f $here/fuzz/$named.cpp ]] || fw_usage_error "--fuzz \"$named\" is no file of tests/fuzz"
"$fw_root/third_party/install.sh" --clang
fw_build fuzz flamewright_fuzz

program="$fw_root/build/fuzz/tests/flamewright_fuzz"
# An own folder for temporary files, in memory where there is such a place.
temporary=$(mktemp -d "$([[ -w /dev/shm ]] && echo /dev/shm || echo /tmp)/fw_fuzz_XXXXXX")
trap 'rm -rf "$temporary"' EXIT
export TMPDIR="$temporary" LSAN_OPTIONS="suppressions=$here/support/lsan.supp:print_suppressions=0"
export UBSAN_OPTIONS="print_stacktrace=1"

# run_fuzzer NAME: leaves its line in NAME/line, its status in NAME/status.
run_fuzzer() {
    local name=$1 folder="$fw_root/build/fuzz/$1" status=0 stat
    mkdir -p "$folder/corpus" "$folder/seeds" "$folder/failed"
    FLAMEWRIGHT_FUZZER=$name FLAMEWRIGHT_FUZZ_SEEDS="$folder/seeds" "$program" >"$folder/log" 2>&1 || status=$?
    rm -rf "$folder/regressions" && mkdir "$folder/regressions"
    find "$here/fuzz/regressions" -name "$name.*" -exec cp -t "$folder/regressions" {} +
    local before
    before=$(find "$folder/failed" -type f | wc -l)
    # Leaks are found at the end: a search after each input takes longer than the input.
    [[ $status -ne 0 ]] || FLAMEWRIGHT_FUZZER=$name "$program" -max_total_time="$seconds" -timeout=100 \
        -rss_limit_mb=4096 -report_slow_units=1000 -detect_leaks=0 -max_len=65536 -use_value_profile=1 \
        -print_final_stats=1 -artifact_prefix="$folder/failed/" "$folder/corpus" "$folder/seeds" \
        "$folder/regressions" >>"$folder/log" 2>&1 || status=$?
    stat=$(grep -E '^#[0-9]+.* cov: ' "$folder/log" | tail -n 1 || true)
    printf '%-12s %9s executions, %6s edges, %5s inputs in the corpus, %s crashes\n' "$name" \
        "$(sed -n 's/^stat::number_of_executed_units: *//p' "$folder/log")" \
        "$(sed -n 's/.* cov: \([0-9]*\).*/\1/p' <<<"$stat")" \
        "$(find "$folder/corpus" -type f | wc -l)" \
        $(($(find "$folder/failed" -type f | wc -l) - before)) >"$folder/line"
    echo "$status" >"$folder/status"
}

mapfile -t names < <("$program")
[[ -z $named ]] || names=("$named")
for name in "${names[@]}"; do
    while [[ $(jobs -r -p | wc -l) -ge $(nproc) ]]; do wait -n || true; done
    run_fuzzer "$name" &
done
wait

passed=0 failed=0
for name in "${names[@]}"; do
    folder="$fw_root/build/fuzz/$name"
    cat "$folder/line"
    if [[ $(cat "$folder/status") -eq 0 ]]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        tail -n 40 "$folder/log"
        echo "The input lies in $folder/failed. Mend the fault and add it as tests/fuzz/regressions/$name.SUBJECT"
    fi
done
echo "$passed passed, $failed failed, 0 skipped"
[[ $failed -eq 0 ]]
