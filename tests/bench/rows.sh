#!/bin/bash
# Checks that the bench has the rows whose names are a contract.
set -euo pipefail
bench="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/tests/flamewright_bench"
if [[ ! -x $bench ]]; then
    echo "skipped: this build has no bench"
    exit 77
fi
listed=$("$bench" --benchmark_list_tests)
status=0
while read -r row; do
    grep -q -F -x -- "$row" <<<"$listed" || { echo "the bench has no row $row" && status=1; }
done < <(printf '%s\n' front/{dense,sparse3,published}/{128,256,512,1024} \
    front/wide/1024 front/wide_cpu/1024 front/mapsize_smallfire/{256,1024} \
    objects10k/{rest,one_walks,thousand_walk,thousand_touch,spawn,first_match,rain,memory} objects1k/memory_on_device objects2k/all_walk objects/{burning,exchange}10 objects/{burning,exchange}10_idle1000 objects/{idle/1000,burning/100} \
    front/{dense,sparse,published}_bunny{4k,31k}/512 \
    deform/{xpbd,published}/{4k,31k} deform/recession/31k heat/bunny31k/1024 \
    refine/{full,adaptive}/{10,15,20,50}k refine/{full,adaptive}_{lit5,burnt}/20k refine/published/20k \
    bake/bunny31k/1024 houses100/{frame,budget} ground/{bump,parallax} surface/bunny31k/720p volume/{samework/360p,{delivered,15percent_screen,onequarter_screen,steps16,steps24,steps32,high,flames32,haze}/720p} selfcross/{none,product,published} \
    scene/tower_defence/{none,throwers10,throwers100} game/frame views/two/720p particles/{sim/{10k,100k},draw/2k,draw_half/2k{,_near},sort/10k} \
    field/64x64x64 field/draw_{ground,fire,smoke,water} \
    server/burning100_step world/{burning300,shielded300,idle1000}_step \
    query/eta record/idle save/burnt1024 load/burnt1024 net/{latejoin,delta}_bytes \
    editor/{stroke,scrub/1024,open_bunny31k,start})
twice=$(sort <<<"$listed" | uniq -d)
[[ -z $twice ]] || { echo "duplicate rows: $twice" && status=1; }
exit $status
