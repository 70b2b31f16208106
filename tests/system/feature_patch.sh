# SPDX-License-Identifier: BSD-3-Clause
# Functions that the tests of docs/examples/*.patch share. Each patch adds a feature in few files.
# To be sourced after common.sh.
#
#   NAME.sh                             does the patch still apply, and touch few files?
#   NAME.sh [PYTHON] CMAKE OPTION...    builds a copy of the tree with it, and runs that
#
# PYTHON is a folder for a Python environment, CMAKE OPTION... configure the copy.

# begin_patch NUMBER_OF_WORDS NAME MOST_FILES [PAGE...]: goes on only if the test has words and the
# patch is good. PAGEs are pages of the reference that the program prints; they are files, too.
begin_patch() {
    local n_words=$1 most=$3 n_files
    change=$CARROM_SOURCE_DIR/docs/examples/$2.patch
    shift 3
    printed=("$@")
    n_files=$(($(grep -c '^+++ ' "$change") + $#))
    [ "$n_files" -le "$most" ] || complain "it touches $n_files files, not $most at most"
    check_patch "$change"
    [ "$n_words" -gt 0 ] && [ "$n_failures" -eq 0 ] || finish
}

# get_python FOLDER MODULE: sets `python` to an interpreter that has the module. Skips the test if
# there is none.
get_python() {
    python=$1/bin/python
    { [ -x "$python" ] || python3 -m venv "$1"; } >"$test_folder/err" 2>&1 &&
        { "$python" -c "import $2" 2>/dev/null ||
            timeout 200 "$python" -m pip install --quiet --disable-pip-version-check \
                --only-binary :all: --retries 1 --timeout 10 "$2" >>"$test_folder/err" 2>&1; } || {
        printf 'skipped: no %s: %s\n' "$2" "$(tail -n 1 "$test_folder/err")"
        exit 77
    }
}

# expect_pages WORD: the pages of the reference gain lines with the word, and no others. Lines that
# the page had before, such as the head of a table, may come again.
expect_pages() {
    local page words
    for page in "${printed[@]}"; do
        words=(keys)
        [ "$page" = keys ] || words+=("--$page")
        "$CARROM_PROGRAM" "${words[@]}" >"$page.md"
        grep -vxFf "$CARROM_SOURCE_DIR/docs/reference/$page.md" "$page.md" >added
        grep -q "$1" added || complain "$page.md has no $1"
        grep -v "$1" added && complain "other lines of $page.md change"
    done
}

# expect_one_hash SCENE NAME WORD...: the scene with these words ends with the same state hash on 1
# rank, on 3, and, checked, on 2 from a checkpoint of step 50 of the run on 1. It is in $hash.
expect_one_hash() {
    local scene=$1 name=$2 folder
    shift 2
    run 1 run "$scene" --quiet "$@" -o "one_$name"
    expect_code 0 "$name on 1 rank"
    hash=$(json_value "one_$name/report.json" state_hash)
    run 3 run "$scene" --quiet "$@" -o "three_$name"
    expect_code 0 "$name on 3 ranks"
    run 2 run --restart "one_$name/checkpoints/checkpoint-000000000050.h5" --quiet --check \
        -o "again_$name"
    expect_code 0 "$name on 2 ranks, from a checkpoint of 1"
    for folder in "three_$name" "again_$name"; do
        [ "$(json_value "$folder/report.json" state_hash)" = "$hash" ] ||
            complain "$folder: another state hash"
    done
}
