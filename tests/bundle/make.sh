#!/bin/bash
# Packs a bundle: what checks and times the library on any x86-64 machine with a Vulkan device, and
# needs nothing there but the Vulkan loader and the C and C++ runtimes. Writes the folder DIR and
# DIR.tar.xz. Called by tests/run --bundle DIR, after the build.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tests=$(dirname "$here")
build=${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}
limit=45 # MiB, packed
programs=(flamewright-check flamewright_gpu_tests flamewright_device_bench)

fail() {
    echo "bundle: $1" >&2
    exit 1
}
[[ $# -eq 1 ]] || fail "it takes one folder, not $#"
dir=${1%/}
[[ ! -e $dir || -f $dir/recorded.hashes ]] ||
    fail "$dir exists and is no bundle; name a folder that does not exist"
rm -rf "$dir" "$dir.tar.xz"
mkdir -p "$dir"/{bin,lib,layers,tests}
dir=$(cd "$dir" && pwd)

for program in "${programs[@]}"; do strip -o "$dir/bin/$program" "$build/tests/$program"; done
# Libraries of the target: the runtimes and the loader. All others travel, and these three may not.
target='^(linux-vdso|/lib.*/ld-linux.*|ld-linux.*|lib(c|m|dl|pthread|rt|stdc\+\+|gcc_s|vulkan))\.so'
while read -r name path; do
    [[ ! $name =~ $target ]] || continue
    [[ ! $name =~ ^lib(OpenImageIO|glfw|freetype) ]] || fail "a program links $name"
    strip --strip-unneeded -o "$dir/lib/$name" "$path"
done < <(for program in "${programs[@]}"; do ldd "$build/tests/$program"; done |
    awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | sort -u)
for file in "$dir"/bin/* "$dir"/lib/*; do
    ! env -i LD_LIBRARY_PATH="$dir/lib" ldd -r "$file" 2>&1 | grep -E 'not found|undefined symbol' ||
        fail "$(basename "$file") does not load from the bundle alone"
done

# For targets without the validation layer.
layer=$(dpkg -L vulkan-validationlayers | grep '/libVkLayer_khronos_validation\.so$')
cp "$layer" "$dir/layers/"
sed "s|\"library_path\": *\"[^\"]*\"|\"library_path\": \"./$(basename "$layer")\"|" \
    /usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json >"$dir/layers/validation.json"

cp -r "$tests/golden" "$tests/replay" "$dir/tests/"
rm -f "$dir"/tests/*/*.{cpp,h,md}
cp "$here/run" "$here/recorded.hashes" "$tests/../LICENSE" "$dir/"
needs=$(objdump -T "$dir"/bin/* "$dir"/lib/* "$dir"/layers/*.so | grep -E -o '(GLIBC|GLIBCXX)_[0-9.]+' |
    sort -u -V | awk -F _ '{ newest[$1] = $0 } END { for (i in newest) printf " %s", newest[i] }')
commit=$(git -C "$here" rev-parse --short HEAD 2>/dev/null || echo unknown)
git -C "$here" diff --quiet HEAD 2>/dev/null || commit+=" with changes"
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
echo "commit $commit, built by $(basename "$compiler") $("$compiler" -dumpfullversion), needs$needs" \
    >"$dir/about"

tar -C "$(dirname "$dir")" -c "$(basename "$dir")" | xz -T0 >"$dir.tar.xz"
size=$((($(stat -c %s "$dir.tar.xz") + 1048575) >> 20))
[[ $size -le $limit ]] || fail "$dir.tar.xz is $size MiB; the limit is $limit"
echo "bundle: $dir ($(cat "$dir/about"))"
echo "bundle: $dir.tar.xz, $size MiB. On the target: tar -xJf $(basename "$dir").tar.xz &&" \
    "$(basename "$dir")/run OUT"
