#!/bin/bash
# flamewright-check finds the recorded burn hashes on both backends and no validation message. It
# notices a hash that differs, and a machine without a device still gets a report.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
check="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/tests/flamewright-check"
if [[ ! -x $check ]]; then
    echo "skipped: this build has no flamewright-check"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    echo "$1"
    exit 1
}

! ldd "$check" | grep -E 'OpenImageIO|glfw|freetype|libpng|libz\.' ||
    fail "flamewright-check links what a bundle's target may not have"
"$check" "$work/out" --data "$here" --steps conformance || fail "the hashes differ here"
grep -q '"complete": true' "$work/out/report.json" || fail "report.json is not complete"
! grep -E -o '(src|href)="[^d][^"]*"' "$work/out/report.html" || fail "report.html needs other files"

mkdir "$work/changed"
sed 's/^\(walk 8 \).*/\10123456789abcdef/' "$here/recorded.hashes" >"$work/changed/recorded.hashes"
status=0
VK_DRIVER_FILES=none VK_ICD_FILENAMES=none \
    "$check" "$work/none" --data "$work/changed" --steps conformance || status=$?
[[ $status -eq 1 ]] || fail "without a device and with a changed hash it leaves with status $status"
[[ $(grep -c 'class="bad"><code>' "$work/none/report.html") -eq 1 ]] ||
    fail "the report does not show the one changed hash"
grep -q 'no Vulkan device' "$work/none/report.html" || fail "the report does not say that no device is there"
