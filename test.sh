#!/bin/bash
# Checks everything: installs what is missing, then format, lint, build and tests, the tests that need a
# kernel with CAN, and the tests again under sanitizers. Exit status 0 if all of it passed.
#
#   ./test.sh                  everything
#   ./test.sh STAGE...         only these stages, of: format lint unit guest asan
#                              and on demand: tsan fuzz
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1

all_stages=(format lint unit guest asan)
jobs=$(nproc)

# --- helpers ----------------------------------------------------------------------------------------

section() { printf '\n======== %s ========\n' "$*"; }

sources() {
  find shared planner executor hw sim tests -name '*.h' -o -name '*.cpp' | LC_ALL=C sort
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

# --- stages; each runs in a subshell with errexit ------------------------------------------------------

stage_format() {
  sources | xargs --no-run-if-empty clang-format --dry-run --Werror
  echo "clang-format: $(sources | wc -l) files as they should be"
}

# Runs all three linters even if one has found something.
stage_lint() {
  local failed=0
  python3 -B tests/house/rules.py || failed=1

  configure dev
  cmake --build --preset dev --target lcmtypes_headers >/dev/null
  local roots=()
  for folder in build/dev/roots/*; do
    roots+=(-I "$folder")
  done
  # Only Tenon's own headers: cppcheck is not meant to read Eigen's.
  if cppcheck --quiet -j "$jobs" --std=c++20 --language=c++ --library=googletest --inline-suppr \
    --enable=warning,performance,portability --error-exitcode=1 \
    --suppressions-list=.ci/cppcheck.suppressions "${roots[@]}" \
    shared planner executor hw sim tests; then
    echo "cppcheck: nothing found"
  else
    failed=1
  fi

  .ci/tidy.py build/dev -j "$jobs" || failed=1
  return "$failed"
}

stage_unit() {
  build dev
  ctest --preset dev --parallel "$jobs"
}

stage_guest() {
  build dev
  tests/guest/run.sh build/dev/bin
}

stage_asan() {
  build asan-ubsan
  ctest --preset asan-ubsan --parallel "$jobs"
}

stage_tsan() {
  build tsan
  ctest --preset tsan --parallel "$jobs"
}

stage_fuzz() {
  .ci/setup.sh fuzz
  build fuzz
  ctest --preset fuzz --parallel "$jobs"
}

# --- run ---------------------------------------------------------------------------------------------

stages=("$@")
((${#stages[@]})) || stages=("${all_stages[@]}")
for stage in "${stages[@]}"; do
  if ! declare -F "stage_$stage" >/dev/null; then
    echo "test.sh: no stage '$stage'; there are: ${all_stages[*]} tsan fuzz" >&2
    exit 2
  fi
done

.ci/setup.sh test || exit 1

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
exit "$status"
