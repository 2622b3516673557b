#!/bin/bash
# Plans and evaluates pairs of parts from nothing but their files. FOLDER holds a folder for each pair, with
# plug.stl or plug.obj and socket.stl or socket.obj, assembled in one frame. Of each pair the output folder gets
# task.yaml, plan.tnp, plan.json, evaluation.json and plan.html, and of all together assemblies.txt, .json and .html:
# what was planned or why not, times, steps, how many of the runs ended at the goal, the largest forces.
#
#   sim/experiments/assemblies.sh FOLDER [--uniform-mm MM] [--uniform-deg DEG] [-n RUNS] [--seed SEED]
#                                 [--cell FILE] [--time-limit S] [--threads N] [--shard I/N] [--bin FOLDER]
#                                 [--output FOLDER]
#
# Stopped and started again, it goes on where it was. --shard 2/3 takes every third pair, the second first; shards
# that share an output folder make one table of all that is there.
set -euo pipefail
home=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

usage() {
  sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}" >&2
  exit 2
}
fail() {
  echo "assemblies.sh: $1" >&2
  exit 2
}

folder= uniform_mm=2 uniform_deg=0 runs=60 seed=1 cell=$home/hw/cells/gantry3_peg.yaml time_limit=300
threads=$(nproc) shard=1/1 bin=$home/build/release/bin output=$home/build/assemblies
while (($#)); do
  case "$1" in
    -h | --help) usage ;;
    -*) (($# >= 2)) || fail "$1 needs a value" ;;&
    --uniform-mm) uniform_mm=$2 ;;
    --uniform-deg) uniform_deg=$2 ;;
    -n) runs=$2 ;;
    --seed) seed=$2 ;;
    --cell) cell=$2 ;;
    --time-limit) time_limit=$2 ;;
    --threads) threads=$2 ;;
    --shard) shard=$2 ;;
    --bin) bin=$2 ;;
    --output) output=$2 ;;
    -*) fail "'$1' is not known; --help lists what is" ;;
    *)
      [[ -z $folder ]] || fail "one folder at a time, not '$folder' and '$1'"
      folder=$1 && shift && continue
      ;;
  esac
  shift 2
done
[[ -n $folder ]] || usage
[[ -d $folder ]] || fail "'$folder' is no folder"
[[ -f $cell ]] || fail "cell '$cell' is no file"
[[ -x $bin/tenon-plan ]] || fail "$bin has no tenon-plan: cmake --build --preset release, or --bin"
[[ $shard =~ ^([0-9]+)/([0-9]+)$ ]] || fail "--shard is I/N, such as 1/2, not '$shard'"
first=${BASH_REMATCH[1]} every=${BASH_REMATCH[2]}
((first >= 1 && first <= every)) || fail "--shard $shard: I from 1 to N"

# What was asked is part of what came out: one output folder, one setting.
mkdir -p "$output"
setting="uniform $uniform_mm mm, $uniform_deg deg; $runs runs, seed $seed; cell $(basename "$cell"); at most $time_limit s"
if [[ -e $output/setting.txt && $(<"$output/setting.txt") != "$setting" ]]; then
  fail "$output holds results of another setting ($(<"$output/setting.txt")); take another --output"
fi
echo "$setting" >"$output/setting.txt"

# part FOLDER NAME: its file.
part() {
  local file
  for file in "$1/$2".{stl,obj,STL,OBJ}; do
    [[ -f $file ]] && realpath "$file" && return
  done
  return 1
}

# stage NAME FILE COMMAND...: COMMAND makes FILE, once; what it said stays in NAME.txt and NAME.err. What it refused
# is not asked again.
stage() {
  local name=$1 file=$2 began
  shift 2
  if [[ -e $name.seconds ]]; then
    [[ -e $file ]]
    return
  fi
  began=$(date +%s.%N)
  "$@" >"$name.txt" 2>"$name.err" || true
  awk -v from="$began" -v to="$(date +%s.%N)" 'BEGIN { printf "%.2f\n", to - from }' >"$name.seconds.part"
  mv "$name.seconds.part" "$name.seconds"
  [[ -e $file ]]
}

one_pair() {
  local plug=$1 socket=$2
  stage task task.yaml "$bin/tenon-plan" --new-task "$plug" "$socket" --uniform-mm "$uniform_mm" \
    --uniform-deg "$uniform_deg" -o task.yaml || return 0
  stage plan plan.tnp "$bin/tenon-plan" task.yaml --cell "$cell" --time-limit "$time_limit" --threads "$threads" \
    --json plan.json -o plan.tnp || return 0
  stage evaluation evaluation.json "$bin/tenon-evaluate" --cell "$cell" --task task.yaml --plan plan.tnp \
    --experiment "$home/sim/experiments/peg_in_hole.yaml" -n "$runs" --seed "$seed" --threads "$threads" \
    --json evaluation.json || return 0
  stage page plan.html "$bin/tenon-inspect" plan.tnp --task task.yaml --cell "$cell" --report plan.html || return 0
}

# A stage that is stopped is made again: it has no .seconds yet.
trap 'fail "stopped; the same command goes on from here"' INT TERM HUP
folder=$(realpath "$folder") cell=$(realpath "$cell") bin=$(realpath "$bin") output=$(realpath "$output") count=0
for pair in "$folder"/*/; do
  name=$(basename "$pair")
  plug=$(part "$pair" plug) && socket=$(part "$pair" socket) || continue
  ((++count % every == first % every)) || continue
  mkdir -p "$output/$name" && cd "$output/$name"
  echo "== $name"
  one_pair "$plug" "$socket"
done
((count > 0)) || fail "'$folder' has no folder with plug.stl or plug.obj and socket.stl or socket.obj"
python3 "$home/sim/experiments/assemblies_page.py" "$output"
