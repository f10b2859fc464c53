#!/bin/bash
# Checks the shared library's symbols: it exports exactly the functions of the public headers, and
# needs only the C and C++ runtimes, never the Vulkan loader.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
library="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/plugin/libflamewright.so"
status=0

declared=$(cat "$root"/plugin/include/flamewright/*.h | tr '\n' ' ' |
    grep -o -E 'FW_API [^;{]*FW_CALL +fw[A-Za-z0-9_]+ *\(' | grep -o -E 'fw[A-Za-z0-9_]+ *\($' |
    tr -d ' (' | sort -u)
# The version node itself is listed as an absolute symbol (type A).
exported=$(nm -D --defined-only "$library" | awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort -u)

if [[ -z $declared ]]; then
    echo "the public headers declare no function that this check can read"
    status=1
fi
while read -r name; do
    [[ -z $name ]] || { echo "declared in a public header, not exported: $name" && status=1; }
done < <(comm -23 <(echo "$declared") <(echo "$exported"))
while read -r name; do
    [[ -z $name ]] || { echo "exported, declared in no public header: $name" && status=1; }
done < <(comm -13 <(echo "$declared") <(echo "$exported"))

allowed='^(libstdc\+\+|libm|libgcc_s|libc|libdl|libpthread|ld-linux-[a-z0-9-]+)\.so\.[0-9]+$'
while read -r needed; do
    [[ $needed =~ $allowed ]] || { echo "needs $needed" && status=1; }
done < <(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')

if nm -D --undefined-only "$library" | grep -E ' vk[A-Z]'; then
    echo "calls Vulkan by name instead of through the host's table"
    status=1
fi
if readelf -d "$library" | grep -E 'R(UN)?PATH|TEXTREL'; then
    echo "carries a run path or text relocations"
    status=1
fi
readelf -d "$library" | grep -q -F 'SONAME' || { echo "has no SONAME" && status=1; }

[[ $status -eq 0 ]] && echo "$(wc -l <<<"$exported") functions exported, all of them declared"
exit $status
