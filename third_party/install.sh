#!/bin/bash
# Installs the Debian 12 packages this project needs, and only those that are missing. Says what it
# installs. With nothing missing it returns at once and needs no network.
# Usage: third_party/install.sh [--samples | --clang | --long]
#   --samples    leave out the packages that only the tests need
#   --clang      and the second compiler, which only tests/run --clang and --fuzz need
#   --long       and what only tests/run --long needs: that compiler, cross compilers and emulators
set -euo pipefail

packages=(
    g++ cmake ninja-build ccache pkg-config binutils
    glslang-tools
    libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers
    libglm-dev
    libglfw3-dev
    nlohmann-json3-dev
    libimgui-dev libstb-dev libfreetype-dev
    fonts-inter fonts-material-design-icons-iconfont fonts-dejavu-core
    libopenimageio-dev libimath-dev zlib1g-dev libwebp-dev
    libdraco-dev libmeshoptimizer-dev
    assimp-testmodels
)
test_packages=(
    libgtest-dev libgmock-dev googletest libbenchmark-dev libtinygltf-dev libpng-dev
    spirv-tools
    xvfb xdotool imagemagick
    debootstrap xz-utils
)

long_packages=(
    clang libclang-rt-14-dev
    g++-aarch64-linux-gnu qemu-user
    g++-mingw-w64-x86-64-posix wine64
)

case "${1:-}" in
    --samples) ;;
    --clang) packages+=("${test_packages[@]}" clang libclang-rt-14-dev) ;;
    --long) packages+=("${test_packages[@]}" "${long_packages[@]}") ;;
    "") packages+=("${test_packages[@]}") ;;
    *)
        echo "usage: $0 [--samples | --clang | --long]" >&2
        exit 2
        ;;
esac

if ! command -v dpkg-query >/dev/null; then
    echo "install: dpkg is not here, so this is not Debian. Install these packages' equivalents by" >&2
    echo "install: hand: ${packages[*]}" >&2
    exit 1
fi

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    # A package of another architecture beside ours makes dpkg print the status twice.
    [[ $status == installed* ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
    if ! command -v sudo >/dev/null; then
        echo "install: missing Debian packages: ${missing[*]}" >&2
        echo "install: not root and sudo is absent; run as root: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "install: installing missing Debian packages: ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${apt[@]}" update && "${apt[@]}" install --no-install-recommends "${missing[@]}"; } \
    >"$log" 2>&1; then
    tail -n 30 "$log" >&2
    echo "install: apt-get failed (its last lines are above)" >&2
    exit 1
fi
echo "install: done"
