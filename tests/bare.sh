#!/bin/bash
# Runs the README's commands on a bare Debian 12 in a folder (minbase plus the packages that our
# scripts install), which shows packages that our lists lack. Called by tests/run --bare; its last line
# is "N passed, N failed, N skipped".
#
# The checkout has the same path inside and shares the ccache cache, so that the build takes minutes.
# It needs root for mounts and a mirror of Debian's packages.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bare="$root/build/bare"

skip() {
    echo "Skipped, and why:"
    echo "  bare machine: $1"
    echo "0 passed, 0 failed, 1 skipped"
    exit 0
}

# fail TEXT...: the whole check fails.
fail() {
    echo "Failed:"
    echo "  bare machine: $1"
    echo "0 passed, 1 failed, 0 skipped"
    exit 1
}

# The mounts live in their own namespace and end with it. The folder is removed from outside, where
# nothing is mounted in it.
if [[ -z ${FW_BARE_NAMESPACE:-} ]]; then
    [[ $(id -u) -eq 0 ]] || skip "only root may mount and change the root folder; run it as root"
    command -v debootstrap >/dev/null || skip "debootstrap is not here (third_party/install.sh installs it)"
    unshare --mount true 2>/dev/null || skip "this machine refuses mounts, even to root"
    rm -rf "$bare"
    status=0
    FW_BARE_NAMESPACE=yes unshare --mount --propagation private bash "${BASH_SOURCE[0]}" || status=$?
    rm -rf "$bare"
    exit "$status"
fi

mirror=$(apt-get indextargets --format '$(REPO_URI)' 2>/dev/null | grep -m 1 '/debian/\?$' || true)
mirror=${mirror:-http://deb.debian.org/debian}
log="$root/build/bare.log"
mkdir -p "$root/build"
if ! debootstrap --variant=minbase bookworm "$bare" "$mirror" >"$log" 2>&1; then
    # Without a mirror the check is skipped; later errors are failures.
    grep -q '^I: Retrieving Packages' "$log" || skip "no mirror of Debian's packages answers at $mirror"
    tail -n 30 "$log"
    fail "debootstrap failed (its last lines are above)"
fi

mount -t proc proc "$bare/proc"
mount --rbind /dev "$bare/dev"
mountpoint -q "$bare/dev/pts" || mount -t devpts devpts "$bare/dev/pts"
[[ ! -e /etc/resolv.conf ]] || cp -L /etc/resolv.conf "$bare/etc/resolv.conf"
for settings in /etc/apt/apt.conf.d/*proxy* /etc/apt/apt.conf; do
    [[ ! -f $settings ]] || cp "$settings" "$bare/etc/apt/apt.conf.d/"
done

mkdir -p "$bare$root"
git -C "$root" ls-files -z | tar -C "$root" --null --files-from=- --ignore-failed-read -cf - |
    tar -C "$bare$root" -xf -
compile_cache=()
if command -v ccache >/dev/null; then
    cache=$(ccache --get-config=cache_dir)
    mkdir -p "$cache" "$bare$cache"
    mount --bind "$cache" "$bare$cache"
    compile_cache=("CCACHE_DIR=$cache" "CCACHE_BASEDIR=$(ccache --get-config=base_dir)")
fi

passed=0
failed=0
# step COMMAND...: runs one command inside, in the folder of the checkout. Of this machine's
# environment only the compile settings are passed on.
step() {
    local start=$SECONDS status=0
    echo "== $*"
    chroot "$bare" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 TERM=dumb \
        "${compile_cache[@]}" "FW_WARNINGS_AS_ERRORS=${FW_WARNINGS_AS_ERRORS:-OFF}" "FW_UNITY=${FW_UNITY:-ON}" \
        bash -c 'cd "$1" && shift && exec "$@"' bash "$root" "$@" >"$log" 2>&1 </dev/null || status=$?
    if [[ $status -eq 0 ]]; then
        echo "passed, $((SECONDS - start)) s"
        passed=$((passed + 1))
    else
        tail -n 40 "$log"
        echo "failed with status $status, $((SECONDS - start)) s"
        failed=$((failed + 1))
    fi
}

step ./samples/run --frames 3 --size 320x180
step ./samples/run 00_c_own_device
step ./samples/run editor --headless --once
step ./tests/run --build
echo "$passed passed, $failed failed, 0 skipped"
[[ $failed -eq 0 ]]
