#!/bin/bash
# Checks the layering: which folder may include which, which files may name Vulkan, forbidden text, and
# that each file includes the headers that it uses. A self-test first breaks every rule once in a
# temporary tree and must notice each.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

# folder | allowed first parts of its quoted includes
rules='
runtime/core|core/|flamewright/flamewright.h
runtime/fire|fire/|core/|shared/|flamewright/flamewright.h
runtime/mesh|mesh/|core/|shared/|flamewright/flamewright.h
runtime/volume|volume/|core/|shared/|flamewright/flamewright.h
runtime/save|save/|core/
runtime/flipbook|flipbook/|core/|shared/|flamewright/flamewright.h|host_limits.h
runtime/field|field/|core/|shared/|flamewright/flamewright.h
runtime/components|components/|core/|fire/|mesh/|volume/|field/|flipbook/|shared/|flamewright/flamewright.h|host_limits.h
runtime/world|world/|components/|core/|fire/|mesh/|volume/|field/|flipbook/|save/|shared/|gpu/backend.h|flamewright/flamewright.h|flamewright/flamewright_debug.h|host_limits.h
runtime/net|net/|world/|components/|core/|shared/|flamewright/flamewright.h|host_limits.h
runtime/lod|lod/|core/|volume/|shared/|flamewright/flamewright.h
runtime/reference|reference/|gpu/|mesh/|core/|shared/|flamewright/
runtime/gpu|gpu/|lod/|core/|fire/|mesh/|volume/|field/|shared/|flamewright/|host_limits.h
plugin/src|flamewright/|world/|net/|components/|core/|gpu/backend.h|gpu/extension.h|gpu/cpu/cpu_backend.h|gpu/vk/vk_backend.h
plugin/include|flamewright/
shaders/shared|shared/
samples|flamewright/|common/|import/|model/|shell/|document/|link/
editor/import|flamewright/|import/
editor/model|flamewright/|import/|model/
editor/shell|common/|shell/
editor/viewport|flamewright/|common/|import/|shell/|document/|viewport/
editor/link|import/|document/|link/
editor/app|flamewright/|common/|import/|shell/|document/|link/|output/|script/|viewport/|app/|tools/|profile/|volume/|core/error.h
editor/document|flamewright/|import/|model/|document/
editor/output|flamewright/|import/|model/|document/|output/|tools/
editor/script|flamewright/|import/|model/|document/|link/|output/|tools/|script/
editor/tools|flamewright/|import/|document/|link/|output/|script/|scene/|tools/|flipbook/|core/|volume/|reference/|shared/
'

sources() {
    find "$1" -type f \( -name '*.h' -o -name '*.hpp' -o -name '*.cpp' -o -name '*.c' \) 2>/dev/null || true
}

# Lines of a file without // comments and without strings: "path:line:text".
code_lines() {
    local file
    while read -r file; do
        sed -e 's|//.*||' -e 's|/\*.*\*/||g' -e '/^ *#/!s|"[^"]*"||g' "$file" | sed "s|^|$file: |"
    done
}

# Prints one line per broken rule in the tree $1.
check_tree() {
    local tree=$1 rule room allowed
    while read -r rule; do
        [[ -n $rule ]] || continue
        room=${rule%%|*}
        allowed=${rule#*|}
        sources "$tree/$room" | while read -r file; do
            sed -n 's/^ *# *include *"\([^"]*\)".*/\1/p' "$file" | while read -r include; do
                if [[ $include == *..* ]]; then
                    echo "$file includes \"$include\": no include climbs out of its folder"
                elif [[ $include == */* ]] && ! grep -E -q "^(${allowed//./\\.})" <<<"$include"; then
                    # A path relative to the file's own folder is allowed too.
                    [[ -f $(dirname "$file")/$include ]] ||
                        echo "$file includes \"$include\": $room may include only $allowed"
                fi
            done
        done
    done <<<"$rules"

    local rooms=("$tree"/runtime/{core,fire,mesh,volume,field,lod,components,world,net} "$tree/runtime/gpu/cpu"
        "$tree/runtime/gpu/backend.h" "$tree/plugin/include/flamewright/flamewright.h"
        "$tree/plugin/include/flamewright/flamewright_debug.h")
    for room in "${rooms[@]}"; do
        sources "$room" | code_lines | grep -E '\b(Vk|vk|PFN_vk)[A-Z][A-Za-z]+|include *<vulkan' |
            sed 's/$/   <- names Vulkan outside gpu\/vk, gpu\/passes and the edge/' || true
    done

    # Systems of a world see each other through const views and calls: no header of one includes
    # another's or the world's, and none has a friend but the system that saves and loads them.
    for file in "$tree"/runtime/world/*_system.h; do
        [[ -f $file ]] || continue
        grep -H -n -E '#include "world/([a-z_]+_system|world)\.h"' "$file" |
            sed 's/$/   <- declare the other system instead/' || true
        grep -H -n 'friend ' "$file" | grep -v 'friend class PersistenceSystem;' |
            sed 's/$/   <- only PersistenceSystem is a friend/' || true
    done
    # A file of a system does not know the world.
    for file in "$tree"/runtime/world/*.cpp; do
        [[ -f $file ]] || continue
        grep -H -n '#include "world/world\.h"' "$file" | grep -v -F -f <(
            grep -l -E '^[^/]*\b(World|PersistenceSystem)::' "$tree"/runtime/world/*.cpp) |
            sed 's/$/   <- a system does not know the world/' || true
    done

    # The world hands to a plan the data of systems that stand later in this order. Saves know all of
    # them, none of them knows saves.
    local order=(wind room exchange burn flame emitter field light query) own k
    for file in "$tree"/runtime/world/*.cpp; do
        [[ -f $file ]] || continue
        own=-1
        for k in "${!order[@]}"; do
            if grep -q -i -E "^[^/#]*\b${order[k]}System::~?[a-z]+\(.*[{,]$" "$file"; then own=$k; fi
        done
        if [[ $own -lt 0 ]]; then continue; fi
        for ((k = own + 1; k < ${#order[@]}; ++k)); do
            grep -H -n "#include \"world/${order[k]}_system\.h\"" "$file" |
                sed "s/$/   <- comes after the ${order[own]} system/" || true
        done
        grep -H -n -E '#include "world/(save|persistence)\.h"' "$file" |
            sed 's/$/   <- a system does not know saves/' || true
    done

    # No mutable globals: the library may be loaded several times in one process.
    for room in runtime plugin/src; do
        sources "$tree/$room" | code_lines | grep -E '\bthread_local\b|\bdynamic_cast\b|\btypeid\b' |
            sed 's/$/   <- not in the library/' || true
    done
    # The library's files include the standard headers that they use.
    for room in runtime plugin/src plugin/include shaders/shared; do sources "$tree/$room"; done >"$listed"
    awk -v list="$listed" -v roots="$tree/runtime:$tree/shaders:$tree/plugin/include:$tree/plugin/src" \
        -f "$root/tests/abi/named_headers.awk"
    for room in plugin runtime shaders samples editor tests; do
        sources "$tree/$room" | while read -r file; do
            grep -H -n -E '\b(TO''DO|FIX''ME|XX''X)\b' "$file" || true
            grep -H -n -E '^using namespace std' "$file" || true
        done
    done
}

broken=$(mktemp -d)
listed=$(mktemp)
trap 'rm -rf "$broken" "$listed"' EXIT
mkdir -p "$broken"/runtime/{core,fire,mesh,volume,field,components,world,gpu/cpu} "$broken"/plugin/{src,include/flamewright} \
    "$broken"/{shaders/shared,samples/a,editor/import}
echo '#include "fire/law.h"' >"$broken/runtime/core/a.h"
echo '#include "mesh/bake.h"' >"$broken/runtime/fire/a.h"
echo '#include "world/world.h"' >"$broken/runtime/mesh/a.h"
echo '#include "fire/law.h"' >"$broken/runtime/volume/a.h"
echo '#include "volume/curve.h"' >"$broken/runtime/field/a.h"
echo '#include "gpu/vk/device.h"' >"$broken/runtime/components/a.cpp"
echo '#include "gpu/vk/device.h"' >"$broken/runtime/world/a.cpp"
echo 'int f(VkDevice device);' >"$broken/runtime/world/b.h"
echo 'int f(VkDevice device);' >"$broken/runtime/gpu/backend.h"
echo '#include "components/a.h"' >"$broken/runtime/gpu/cpu/a.cpp"
echo '#include "gpu/vk/device.h"' >"$broken/plugin/src/a.cpp"
echo '#include "core/error.h"' >"$broken/plugin/include/flamewright/flamewright.h"
echo '#include "core/hash.h"' >"$broken/shaders/shared/a.h"
echo '#include "core/hash.h"' >"$broken/samples/a/main.cpp"
echo '#include "../../runtime/core/hash.h"' >"$broken/editor/import/a.cpp"
echo 'thread_local int x;' >"$broken/runtime/world/c.cpp"
printf '%s\n' '#include "core/e.h"' 'std::vector<int> x = std::array<int, 1>();' >"$broken/runtime/core/d.cpp"
echo '#include <vector>' >"$broken/runtime/core/e.h"
echo '#include "world/b_system.h"' >"$broken/runtime/world/a_system.h"
echo 'friend class BurnSystem;' >"$broken/runtime/world/b_system.h"
echo '#include "world/world.h"' >"$broken/runtime/world/a_system.cpp"
printf '%s\n' '#include "world/query_system.h"' '#include "world/save.h"' 'void WindSystem::f() {' '}' >"$broken/runtime/world/wind_system.cpp"
expected=22
noticed=$(check_tree "$broken" | wc -l)
if [[ $noticed -ne $expected ]]; then
    check_tree "$broken"
    echo "the self-test breaks $expected rules and the check notices $noticed"
    exit 1
fi

problems=$(check_tree "$root")
if [[ -n $problems ]]; then
    echo "$problems"
    exit 1
fi
echo "layers hold in $(for room in plugin runtime shaders samples editor; do sources "$root/$room"; done | wc -l) files"
