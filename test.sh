#!/bin/bash
# Checks Tenon: installs what is missing, then format, lint, build and tests, the tests that need a kernel
# with CAN, and units, whole runs and threads again under sanitizers. Exit status 0 if all of it passed.
#
#   ./test.sh                  what a commit needs
#   ./test.sh full             what a release needs: also every start of every task and variant, the long
#                              studies, clang-tidy and its analyzer on every file, changed or not,
#                              the pages' bundle of libraries made anew and compared, and MCAP files read by the
#                              reader of its makers (both need npm's registry)
#   ./test.sh [full] STAGE...  only these stages, of: format lint unit guest asan tsan
#                              and on demand: fuzz (full: a million runs of every binary decoder, 200,000 of
#                              every text loader and of both ends of CANopen; hours), and planted, which plants faults in a copy and shows that
#                              the tests see each
#
# A run of all stages that passed leaves the hash of the tree that it passed on in build/tested: who asks
# whether a commit was tested compares it with `git rev-parse COMMIT^{tree}`.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1

all_stages=(format lint unit guest asan tsan)
jobs=$(nproc)
tier=commit

# --- helpers ----------------------------------------------------------------------------------------

section() { printf '\n======== %s ========\n' "$*"; }

sources() {
  find shared planner executor hw sim tests -name '*.h' -o -name '*.cpp' | LC_ALL=C sort
}

# What git calls the tree of all files that are here now and not ignored; empty where there is no git.
tree_hash() {
  local index
  index=$(mktemp -u)
  GIT_INDEX_FILE=$index git add --all 2>/dev/null && GIT_INDEX_FILE=$index git write-tree 2>/dev/null
  rm -f "$index"
}

# Configures a preset; says nothing unless it fails.
configure() {
  local log
  log=$(mktemp)
  if ! cmake --preset "$1" >"$log" 2>&1; then
    cat "$log"
    rm -f "$log"
    return 1
  fi
  rm -f "$log"
}

build() {
  configure "$1"
  local quiet=()
  [[ -t 1 ]] || quiet=(--quiet)
  cmake --build --preset "$1" --parallel "$jobs" -- "${quiet[@]}"
}

# Most checks see few files: the tests of an area, its program and what that runs (build/PRESET/areas). In this
# clone, and never in `full`, they are left out where all that they run and read is what they last passed on, byte
# for byte. What failed elsewhere takes nothing from an area that passed.

# One hash of the built files named, and of every file of the tree that is not compiled; empty without git.
bytes_of() {
  local tree
  tree=$(git ls-files --cached --others --exclude-standard 2>/dev/null | grep --invert-match '\.\(cpp\|h\)$') || return 0
  { printf '%s\n' "$@"; echo "$tree"; } | LC_ALL=C sort | tr '\n' '\0' | xargs --null sha256sum 2>/dev/null |
    sha256sum | cut --delimiter " " --fields 1 || true
}

# passed_before CHECK HASH
passed_before() {
  [[ $tier == commit && -n $2 && -f build/passed/$1 && $(<"build/passed/$1") == "$2" ]] || return 1
  echo "$1: passed before on the same bytes"
}

# passed_now CHECK HASH
passed_now() {
  mkdir -p build/passed
  echo "$2" >"build/passed/$1"
}

# --- stages; each runs in a subshell with errexit ------------------------------------------------------

stage_format() {
  sources | xargs --no-run-if-empty clang-format --dry-run --Werror
  echo "clang-format: $(sources | wc -l) files as they should be"
  [[ $tier == commit ]] || shared/drawing/page/bundle/rebuild.sh --check
}

# Runs all three linters even if one has found something.
stage_lint() {
  local failed=0
  python3 -B tests/house/rules.py || failed=1

  configure lint
  cmake --build --preset lint --target lcmtypes_headers >/dev/null
  local roots=()
  for folder in build/lint/roots/*; do
    roots+=(-I "$folder")
  done
  # Only Tenon's own headers: cppcheck is not meant to read Eigen's. Who passed in the commit that .ci/linted
  # names and is as it was is left out, but for a release.
  mkdir -p build/cppcheck
  local what=(shared planner executor hw sim tests)
  if [[ $tier == commit ]]; then
    .ci/tidy.py build/lint --list >build/cppcheck.list || return 1
    what=(--file-list=build/cppcheck.list)
  fi
  if [[ $tier == commit && ! -s build/cppcheck.list ]]; then
    echo "cppcheck: nothing has changed"
  elif cppcheck --quiet --cppcheck-build-dir=build/cppcheck -j "$jobs" --std=c++20 --language=c++ --library=googletest --inline-suppr \
    --enable=warning,performance,portability --error-exitcode=1 \
    --suppressions-list=.ci/cppcheck.suppressions "${roots[@]}" \
    "${what[@]}"; then
    echo "cppcheck: nothing found"
  else
    failed=1
  fi

  local which=()
  [[ $tier == full ]] && which=(--all)
  .ci/tidy.py build/lint -j "$jobs" "${which[@]}" || failed=1
  return "$failed"
}

# How many cases ran where one of ctest's tests is many of them.
cases_in_parts() {
  awk '/^[0-9]+\/[0-9]+ Testing: .*\.part_/ { part = 1 } /^\[  PASSED  \]/ && part { cases += $4; part = 0 }
       END { if (cases) print "test cases in parts: " cases " passed" }' "$1"
}

# run_tests PRESET; the release's tests carry the label "full".
run_tests() {
  local preset=$1 which=(--label-exclude '^full$' --no-tests=ignore) without=nothing list area files
  [[ $tier == full ]] && which=()
  local -A bytes
  for list in "build/$preset/areas"/*; do
    area=${list##*/}
    mapfile -t files <"$list"
    bytes[$area]=$(bytes_of "${files[@]}")
    if passed_before "$preset.$area" "${bytes[$area]}"; then without+="|$area"; fi
  done
  local failed=build/$preset/Testing/Temporary/LastTestsFailed.log result=0
  local log=${failed%/*}/LastTest.log
  rm -f "$failed" "$log"
  ctest --preset "$preset" --parallel "$jobs" "${which[@]}" --exclude-regex "^($without)\." || result=$?
  [[ ! -e $log ]] || cases_in_parts "$log"
  # A run that was broken off has no list of what failed, and says nothing of any area.
  ((result == 0)) || [[ -e $failed ]] || return "$result"
  for area in "${!bytes[@]}"; do
    grep --quiet --no-messages "^[0-9]*:$area\." "$failed" || passed_now "$preset.$area" "${bytes[$area]}"
  done
  return "$result"
}

stage_unit() {
  build dev
  [[ $tier == commit ]] || cmake --build --preset dev --target test_plans_full
  run_tests dev
}

stage_guest() {
  build dev
  local bytes
  bytes=$(bytes_of build/dev/bin/tests_socketcan)
  if passed_before guest "$bytes"; then return; fi
  tests/guest/run.sh build/dev/bin
  passed_now guest "$bytes"
}

# Whole runs execute the plans that the dev build has made: planning is slow under a sanitizer.
stage_asan() {
  build dev
  build asan-ubsan
  run_tests asan-ubsan
}

stage_tsan() {
  build dev
  build tsan
  run_tests tsan
}

stage_fuzz() {
  .ci/setup.sh fuzz
  local runs=short
  [[ $tier == full ]] && runs=long
  cmake --preset fuzz -DTENON_FUZZ_RUNS=$runs >/dev/null
  build fuzz
  ctest --preset fuzz --parallel "$jobs" --verbose | grep -E 'Done [0-9]+ runs|Passed|\*\*\*|tests passed|ERROR'
}

# Its sanitized builds, too, execute the plans that the dev build has made.
stage_planted() {
  build dev
  /usr/bin/python3 -B tests/planted/plant.py --jobs "$jobs"
}

# --- run ---------------------------------------------------------------------------------------------

if [[ ${1:-} == full ]]; then
  tier=full
  shift
fi
stages=("$@")
((${#stages[@]})) || stages=("${all_stages[@]}")
for stage in "${stages[@]}"; do
  if ! declare -F "stage_$stage" >/dev/null; then
    echo "test.sh: no stage '$stage'; there are: ${all_stages[*]} fuzz planted" >&2
    exit 2
  fi
done

packages=test
[[ $tier == full ]] && packages=full
.ci/setup.sh "$packages" || exit 1
tree=$(tree_hash)
mkdir -p build
rm -f build/tested

summary=()
status=0
for stage in "${stages[@]}"; do
  section "$stage"
  SECONDS=0
  # Not inside a condition, which would switch errexit off within the stage.
  (
    set -e
    "stage_$stage"
  )
  result=$?
  if ((result == 0)); then
    summary+=("passed  $stage  (${SECONDS} s)")
  else
    summary+=("FAILED  $stage  (${SECONDS} s)")
    status=1
  fi
done

section "summary"
printf '%s\n' "${summary[@]}"
if ((status == 0)) && [[ ${stages[*]} == "${all_stages[*]}" && -n $tree ]]; then
  if [[ $(tree_hash) == "$tree" ]]; then
    echo "$tree" >build/tested
  else
    echo "files have changed meanwhile: nobody can say which tree has passed"
  fi
fi
exit "$status"
