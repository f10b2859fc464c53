#!/bin/bash
# Runs the checks that are too long for every change, one row per script in tests/long. A script's
# first comment is its title; its line "# build: TARGET..." names its targets. A row has 20 minutes and
# a folder in FW_LONG_FOLDER for partial results; with status 75 it has more to do, and the next call
# goes on. Rows that passed for this tree are skipped, and an interrupted row resumes. Called by
# tests/run --long [ROW]; a named row that passed runs again.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck source=../../third_party/setup.sh
source "$here/../third_party/setup.sh"

named=${1:-}
[[ -z $named || -f $here/long/$named.sh ]] ||
    fw_usage_error "--long \"$named\" is none of: $(basename -s .sh "$here"/long/*.sh | paste -s -d ' ')"
"$fw_root/third_party/install.sh" --long
results="$fw_root/build/long"
tree=$(cd "$fw_root" && { git rev-parse HEAD && git diff HEAD || true; } 2>/dev/null | sha256sum)
if [[ ! -f $results/tree || $(cat "$results/tree") != "$tree" ]]; then
    rm -rf "$results"
    mkdir -p "$results"
    echo "$tree" >"$results/tree"
fi

passed=0 failed=0 skipped=0 table=
for script in "$here"/long/${named:-*}.sh; do
    row=$(basename -s .sh "$script")
    folder="$results/$row"
    [[ -z $named || ! -f $folder/verdict ]] || rm -rf "$folder"
    mkdir -p "$folder"
    if [[ ! -f $folder/verdict ]]; then
        echo "== $row: $(sed -n '2s/^# //p' "$script")"
        read -r -a targets < <(sed -n 's/^# build: //p' "$script") || true
        status=0 start=$SECONDS
        { [[ ${#targets[@]} -eq 0 ]] || fw_build release "${targets[@]}"; } || status=$?
        [[ $status -ne 0 ]] || FW_BUILD_FOLDER="$fw_root/build/release" FW_LONG_FOLDER="$folder" \
            timeout --kill-after=10 1200 bash "$script" 2>&1 | tee "$folder/log" || status=$?
        case $status in
            0) verdict=passed ;;
            75) verdict="unfinished (run it again)" ;;
            77) verdict=skipped ;;
            124 | 137) verdict="failed (stopped after 1200 s)" ;;
            *) verdict="failed (status $status)" ;;
        esac
        printf '%s|%d s\n' "$verdict" $((SECONDS - start)) >"$folder/verdict"
    fi
    verdict=$(cat "$folder/verdict")
    # A failed row runs again without the parts that passed.
    case $verdict in
        passed*) passed=$((passed + 1)) ;;
        skipped*) skipped=$((skipped + 1)) ;;
        unfinished*) skipped=$((skipped + 1)) && rm "$folder/verdict" ;;
        *) failed=$((failed + 1)) && rm "$folder/verdict" ;;
    esac
    table+=$(printf '%-20s %-32s %8s  %s' "$row" "${verdict%|*}" "${verdict#*|}" \
        "$(sed -n '2s/^# //p' "$script")")$'\n'
done
echo
printf '%s' "$table"
echo "$passed passed, $failed failed, $skipped skipped"
[[ $failed -eq 0 ]]
