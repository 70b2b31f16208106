# SPDX-License-Identifier: BSD-3-Clause
# An installation that is moved to another place: its program runs, its headers compile alone and
# are the public ones, its manual has every option, and the example builds against it and comes to
# the program's state hashes.
#
# usage: install.sh CMAKE BUILD_FOLDER CXX
. "$CARROM_SOURCE_DIR/tests/system/common.sh"
cmake=$1 build=$2 compiler=$3

rm -rf "$test_folder/first" "$test_folder/prefix" "$test_folder/embed" "$test_folder/logs"
mkdir "$test_folder/logs"
# step NAME COMMAND...: shows what the command printed if it fails.
step() {
    local name=$1
    shift
    timeout 500 "$@" >"$test_folder/logs/$name" 2>&1 && return
    complain "$name: $*"
    sed 's/^/    /' "$test_folder/logs/$name"
    finish
}
step install "$cmake" --install "$build" --prefix "$test_folder/first"
mv "$test_folder/first" "$test_folder/prefix"
prefix=$test_folder/prefix
export CARROM_PROGRAM=$prefix/bin/carrom

# The installed headers are exactly the public ones.
(cd "$CARROM_SOURCE_DIR/include" && find . -type f | sort) >"$test_folder/wanted"
(cd "$prefix/include" && find . -type f | sort) >"$test_folder/found"
expect_same "$test_folder/wanted" "$test_folder/found" 'other headers are installed than there are'
for header in "$prefix"/include/carrom/*.hpp; do
    name=${header##*/}
    printf '#include <carrom/%s>\n' "$name" >"$test_folder/logs/alone.cpp"
    step "header_$name" "$compiler" -std=c++20 -Wall -Wextra -Wpedantic -Werror -fsyntax-only \
        -I "$prefix/include" "$test_folder/logs/alone.cpp"
done
for file in share/carrom/inputs/gas.toml share/doc/carrom/LICENSE \
    share/doc/carrom/docs/reference/keys.md; do
    [ -s "$prefix/$file" ] || complain "not installed: $file"
done
for library in fmt tomlplusplus CLI11 nlohmann_json highway xxhash random123; do
    grep -qiE 'copyright|licen[cs]e' "$prefix/share/doc/carrom/licenses/$library.txt" ||
        complain "the licence of $library is not installed"
done

# The list of parts: CycloneDX's form, with every library that CMake looked for.
bill=$prefix/share/doc/carrom/carrom.cdx.json
python3 - "$bill" "$CARROM_SOURCE_DIR/CMakeLists.txt" <<'CHECK' ||
import json, re, sys
bill = json.load(open(sys.argv[1], encoding="utf-8"))
assert (bill["bomFormat"], bill["specVersion"]) == ("CycloneDX", "1.5"), bill
text = open(sys.argv[2], encoding="utf-8").read()
assert bill["metadata"]["component"]["version"] == re.search(r"carrom VERSION (\S+)", text)[1]
names = {part["name"].lower() for part in bill["components"]}
names |= {"hwy"} if "highway" in names else set()
looked_for = {name.lower() for name in re.findall(r"find_package\((\w+)", text)} - {"pkgconfig"}
assert looked_for <= names, looked_for - names
unknown = [part["name"] for part in bill["components"] if not part.get("version")]
assert unknown == ["random123"], unknown
CHECK
    complain 'carrom.cdx.json lacks a library, or a version'

# The recipe of Apptainer copies all files that a build reads, and no build folder.
mkdir "$test_folder/image"
awk '/^%/ { is_list = $0 == "%files" } is_list && $2 ~ /^\/src\// { print $1 }' \
    "$CARROM_SOURCE_DIR/docs/install/carrom.def" | while read -r name; do
    cp -r "$CARROM_SOURCE_DIR/$name" "$test_folder/image/"
done
step image "$cmake" -S "$test_folder/image" -B "$test_folder/image/build" -DCARROM_TESTS=OFF \
    -DCMAKE_CXX_COMPILER="$compiler"
rm -rf "$test_folder/image"

# The manual: no warning, and every option of every command.
page=$prefix/share/man/man1/carrom.1
plain=$test_folder/page
sed 's/\\-/-/g' "$page" >"$plain"
for command in '' run accuracy info verify convert diff; do
    run 1 $command --help
    grep -oE '^ +(-h,)?--[a-z-]+' "$test_folder/out" | grep -oE -- '--[a-z-]+' >options
    while read -r option; do
        grep -qwF -- "$option" "$plain" || complain "the manual lacks $option of carrom $command"
    done <options
    [ -z "$command" ] || grep -qx ".B $command" "$plain" || complain "the manual lacks $command"
done
if command -v man >"$test_folder/out"; then
    MANWIDTH=80 MANROFFSEQ='' man --warnings -l "$page" >"$test_folder/out" 2>"$test_folder/err"
    [ ! -s "$test_folder/err" ] || { complain 'the manual has warnings'; show; }
    grep -q 'EXIT STATUS' "$test_folder/out" || complain 'the manual is not shown'
else
    printf 'the manual is not shown: there is no program man\n'
fi

# The example, as it is installed, against the installed package alone.
step configure "$cmake" -S "$prefix/share/doc/carrom/docs/examples/embed" -B "$test_folder/embed" \
    -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler"
grep -q "^Carrom_DIR:PATH=$prefix/" "$test_folder/embed/CMakeCache.txt" ||
    complain 'the package was found elsewhere'
step build "$cmake" --build "$test_folder/embed"
# HDF5's compiler, which CMake calls, cannot handle such a name.
rm -rf "$test_folder/it's ä"
step configure_odd "$cmake" -S "$prefix/share/doc/carrom/docs/examples/embed" \
    -B "$test_folder/it's ä" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler"

# The same example by pkg-config, for projects without CMake.
flags() { PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name carrom.pc)") pkg-config "$@" carrom; }
read -ra words <<<"$(flags --cflags) $(flags --static --libs)"
step by_pkg_config "$compiler" -std=c++20 "$CARROM_SOURCE_DIR/docs/examples/embed/embed.cpp" \
    -o "$test_folder/embed/by_pkg_config" "${words[@]}"
[ "$(flags --modversion)" = "$("$CARROM_PROGRAM" --version | sed -n '1s/carrom //p')" ] ||
    complain "carrom.pc has another version: $(flags --modversion)"

# Installed files do not contain the path of the build.
library=$(dirname "$(dirname "$(find "$prefix" -name carrom.pc)")")
if grep -qx 'CMAKE_BUILD_TYPE:[A-Z]*=Release' "$build/CMakeCache.txt"; then
    for file in "$prefix/bin/carrom" "$library"/libcarrom.*; do
        for folder in "$CARROM_SOURCE_DIR" "$(realpath "$build")"; do
            grep -qF "$folder/" "$file" && complain "$file names $folder"
        done
    done
fi

# With position-independent code, the archive can be linked into other shared libraries.
if [ -e "$library/libcarrom.a" ] &&
    grep -qx 'CMAKE_POSITION_INDEPENDENT_CODE:[A-Z]*=ON' "$build/CMakeCache.txt"; then
    step into_a_library "$compiler" -shared -Wl,-z,text -o "$test_folder/embed/libother.so" \
        -Wl,--whole-archive "$library/libcarrom.a" -Wl,--no-whole-archive
fi

# expect_hash RANKS HASH SCENE...: the example's last line must have this hash.
expect_hash() {
    local ranks=$1 hash=$2 launch=()
    shift 2
    [ "$ranks" -eq 1 ] || launch=("$CARROM_MPIEXEC" -n "$ranks")
    timeout 120 "${launch[@]}" "$test_folder/embed/embed" "$@" >"$test_folder/out" \
        2>"$test_folder/err" || { complain "the example fails on $ranks ranks: $*"; show; }
    [ "$(tail -n 1 "$test_folder/out")" = "state hash $hash" ] ||
        complain "the example has another hash than the program on $ranks ranks: $*"
}
program_hash() {
    run 1 run "$@" --report report.json
    expect_code 0 "the program on $*"
    json_value report.json state_hash
}

cat >gas.toml <<'SCENE'
[box]
size = 100
[discs]
count = 500
radius = 1.0
speed = 0.5
[time]
method = "event-driven"
steps = 200
SCENE
sed 's/event-driven/time-stepped/' gas.toml >stepped.toml
sed 's/size = 100/&\nleft.kind = "periodic"\nright.kind = "periodic"/' gas.toml >periodic.toml
printf '0 20 50 1 0 5\n1 80 50 -1 0 2\n' >discs.txt
cat >file.toml <<'SCENE'
[box]
size = 100
[discs]
count = 2
file = "discs.txt"
columns = ["radius"]
[time]
method = "event-driven"
steps = 90
SCENE

hash=$(program_hash gas.toml)
expect_hash 1 "$hash"           # the scene that the example makes itself
expect_hash 2 "$hash" gas.toml
for scene in stepped.toml periodic.toml file.toml "$prefix/share/carrom/inputs/tiny.in"; do
    hash=$(program_hash "$scene")
    [ ${#hash} -eq 32 ] || complain "no state hash of $scene"
    for ranks in 1 2; do expect_hash "$ranks" "$hash" "$scene"; done
done

# A wrong scene gives the same error and code as in the program.
printf '[box]\nsize = -1\n' >wrong.toml
run 1 run wrong.toml
expect_code 2 'the program on a wrong scene'
cp "$test_folder/err" "$test_folder/of_program"
timeout 60 "$test_folder/embed/embed" wrong.toml >"$test_folder/out" 2>"$test_folder/err"
code=$?
expect_code 2 'the example on a wrong scene'
expect_silence 'a wrong scene'
expect_same "$test_folder/of_program" "$test_folder/err" 'a wrong scene has other problems'
finish
