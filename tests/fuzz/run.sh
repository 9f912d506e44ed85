#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the loader's fuzz target with clang, beside the g++ build, and runs it:  run.sh SOURCE_DIR BUILD_DIR SECONDS
# Exit status 77 (skipped) without clang or its libFuzzer.
set -eu
source_dir=$1
build_dir=$2/fuzz
seconds=$3
command -v clang++ >/dev/null || { echo "clang++ is not installed (package clang): skipped"; exit 77; }
mkdir -p "$build_dir/objects" "$build_dir/corpus" "$build_dir/scene" "$build_dir/findings"
cp "$source_dir"/tests/fuzz/parts/*.xml "$build_dir/scene/"

cache=
command -v ccache >/dev/null && cache=ccache
flags="-std=c++20 -O1 -g1 -fno-omit-frame-pointer"
flags="$flags -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined"
flags="$flags -I$source_dir -I$2/generated/abi -isystem /usr/include/eigen3 -DFMT_HEADER_ONLY"
folders="core/base core/params core/registry core/scene core/xml platform/linux/base tests/fuzz"
target=$build_dir/loader_fuzz

if [ ! -x "$target" ] || [ -n "$(cd "$source_dir" &&
    find $folders -newer "$target" \( -name '*.h' -o -name '*.cpp' \) | head -1)" ]; then
  echo "building the fuzz target"
  if ! echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' |
      clang++ -x c++ -fsanitize=fuzzer - -o "$build_dir/probe" 2>/dev/null; then
    echo "clang has no libFuzzer here (package libclang-rt-14-dev): skipped"
    exit 77
  fi
  rm -f "$build_dir"/objects/*.o
  # A folder is one unit of compilation, since most of the time goes into reading headers.
  for folder in $folders; do
    unit=$build_dir/objects/$(echo "$folder" | tr / _)
    ls "$source_dir/$folder"/*.cpp | grep -v '_test\.cpp$' | sed 's/.*/#include "&"/' >"$unit.cpp"
    printf '%s %s\n' "$unit.cpp" "$unit.o"
  done | xargs -P 2 -n 2 sh -c "$cache clang++ $flags -c \"\$0\" -o \"\$1\" || exit 255"
  clang++ -fsanitize=fuzzer,address,undefined "$build_dir"/objects/*.o -lexpat -ldl -o "$target"
fi

# A new corpus each time: a test must not depend on what earlier runs left.
rm -rf "$build_dir/corpus"
mkdir -p "$build_dir/corpus"
export INSULA_FUZZ_FOLDER="$build_dir/scene"
exec "$target" -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=3000 -print_final_stats=1 \
  -dict="$source_dir/tests/fuzz/loader.dict" -artifact_prefix="$build_dir/findings/" -verbosity=1 \
  "$build_dir/corpus" "$source_dir/tests/fuzz/seeds" "$source_dir/tests/scenes_bad"
