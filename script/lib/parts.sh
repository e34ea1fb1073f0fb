# SPDX-License-Identifier: GPL-2.0-or-later
# To be sourced: parts of a long script, each with the time that it took.
#   part NAME COMMAND...   says the name, runs the command, keeps the seconds; a failure ends the script
#   print_parts            one line a part; also printed when a part fails
#   run_tests PRESET WORDS...   runs ctest with these words; the script then prints why tests failed as its last lines
#   until_minute N COMMAND...   ends the command, and all that it started, when the script is N minutes old: 124 then
parts_done=()

part() {
    local name=$1 start=$SECONDS status=0
    shift
    echo "== $name"
    "$@" || status=$?
    parts_done+=("$(printf '%4d min %02d s  %s' $(((SECONDS - start) / 60)) $(((SECONDS - start) % 60)) "$name")")
    if [ "$status" -ne 0 ]; then
        parts_done[-1]+=" (failed)"
        print_parts
        exit "$status"
    fi
}

print_parts() {
    echo "== time of each part"
    printf '%s\n' "${parts_done[@]}"
}

run_tests() {
    local logs=build/$1/Testing/Temporary
    rm -f "$logs"/LastTest*.log
    # With the folder of this call.
    trap "python3 tools/failed_tests.py '$logs'" EXIT
    ctest --preset "$1" --parallel "$(nproc)" "${@:2}"
}

until_minute() {
    local left=$(($1 * 60 - SECONDS))
    shift
    timeout --kill-after=10 $((left > 1 ? left : 1)) "$@"
}
