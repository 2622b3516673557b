#!/bin/bash
# Plans a task under uncertainty, starts a virtual arm before which things are not where they were said to
# be, and executes the plan by touch over CANopen, in real time. Installs what is missing and builds first.
#
#   ./demo.sh [--seed N] [--start NAME] [--task NAME] [--cell NAME] [--output DIR]
#             [--bin DIR]
#
# The task is planner/tasks/connector.yaml where none is named, the start the task's first, and the cell one of
# hw/cells that is meant for the task.
# --bin names programs that are there already, such as /usr/bin: then nothing is installed or built.
#
# Exit status 0: the part ended within the task's tolerance of its goal. 1: it did not; the reason is
# printed. 2: bad usage or bad input.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

seed=1 start='' task=connector cell='' output=build/demo bin=
while (($#)); do
  case "$1" in
    --seed | --start | --task | --cell | --output | --bin)
      if (($# < 2)); then
        echo "demo.sh: $1 needs a value" >&2
        exit 2
      fi
      printf -v "${1#--}" '%s' "$2"
      shift 2
      ;;
    --help)
      sed -n '2,13s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    *)
      echo "demo.sh: unknown option '$1'; try ./demo.sh --help" >&2
      exit 2
      ;;
  esac
done

if [[ -z $bin ]]; then
  .ci/setup.sh build
  echo "== Build: minutes the first time"
  if [[ -t 1 ]]; then
    cmake --preset release >/dev/null
    cmake --build --preset release  # its progress is one line on a terminal
  elif ! build_log=$( (cmake --preset release && cmake --build --preset release) 2>&1); then
    printf '%s\n' "$build_log" >&2
    exit 1
  fi
  bin=build/release/bin
  echo
fi
if [[ -z $cell ]]; then
  case $task in  # what each cell's file says that it stands before
    box_on_table_3d) cell=gantry3_peg ;;
    box_on_table_*) cell=csp6 ;;
    peg_in_hole_tilt) cell=csp6_peg ;;
    peg_in_hole_*) cell=gantry3_peg ;;
    toy_1d) cell=gantry3 ;;
    *) cell=csp6_bench ;;
  esac
fi
task_file=planner/tasks/$task.yaml cell_file=hw/cells/$cell.yaml
mkdir -p "$output"
rm -f "$output"/{plan.tnp,plan.json,plan.html,run.html,truth.json,sim.out,run.lcmlog,run.can.log,result.json,black-box.csv}

echo "== Plan: $task${start:+ from start $start}, positions uncertain"
"$bin/tenon-plan" "$task_file" ${start:+--start "$start"} --cell "$cell_file" --threads "$(nproc)" -o "$output/plan.tnp" \
  --json "$output/plan.json" --report "$output/plan.html"

# The virtual arm and who moves it, to the end of a run. Sets `executed`, tenon-exec's exit status.
execute() {
  echo
  echo "== Virtual arm: $cell, the environment displaced by a draw of seed $seed"
  : >"$output/sim.out"
  "$bin/tenon-sim" --cell "$cell_file" --task "$task_file" ${start:+--start "$start"} --seed "$seed" \
    --can slcan-listen://127.0.0.1:0 --once --json "$output/truth.json" >"$output/sim.out" 2>&1 &
  sim=$!
  trap 'kill "$sim" 2>/dev/null || true' EXIT
  local port=
  for _ in $(seq 100); do
    port=$(sed -n 's/^listening on 127\.0\.0\.1:\([0-9]*\).*/\1/p' "$output/sim.out")
    [[ -n $port ]] && break
    kill -0 "$sim" 2>/dev/null || break
    sleep 0.1
  done
  if [[ -z $port ]]; then
    cat "$output/sim.out" >&2
    kill "$sim" 2>/dev/null || true
    local status=0
    wait "$sim" || status=$?
    exit $((status == 2 ? 2 : 1))
  fi

  echo
  echo "== Execute over CANopen in real time"
  executed=0
  "$bin/tenon-exec" --cell "$cell_file" --plan "$output/plan.tnp" --can "slcan://127.0.0.1:$port" \
    --rt prefer --log "$output/run.lcmlog" --can-log "$output/run.can.log" \
    --json "$output/result.json" --black-box "$output/black-box.csv" || executed=$?
  wait "$sim" || true
  trap - EXIT
}

# A machine that others use too may stand still for longer than executor and virtual arm wait for each other. To stop
# is right then, and says nothing of the plan. Whether the run ended as it ends then; says how late either woke up.
stood_still() {
  local unheard='overruns|blind|bus_silent|feedback_missing|feedback_poor'
  grep -Eq "^  \"(reason|arm_fault)\": \"($unheard)\"" "$output/result.json" || return 1
  [[ -s $output/truth.json ]] || return 1  # the arm's program broke down
  local us='/"wakeup_late"/,/}/s/^ *"max_us": \([0-9]*\).*/\1e-3/p' ms='s/^ *"late_max_ms": \([0-9.]*\).*/\1/p'
  LC_ALL=C printf 'tenon-exec woke up at most %.0f ms late, tenon-sim %.0f ms' \
    "$(sed -n "$us" "$output/result.json")" "$(sed -n "$ms" "$output/truth.json")"
}

for attempt in 1 2 3; do
  rm -f "$output"/{truth.json,result.json}
  execute
  ((executed == 1)) && late=$(stood_still) || break
  once_more=$( ((attempt == 3)) || echo "; once more")
  echo "So a run ends where the machine stands still or is busy ($late)$once_more."
done

echo
echo "== What really happened (known to the simulator alone)"
grep -v '^listening' "$output/sim.out"
# A run that never began has left no log to look at.
pages="$output/plan.html (why the plan works)"
if "$bin/tenon-inspect" "$output/plan.tnp" --task "$task_file" --cell "$cell_file" --run "$output/result.json" \
  --log "$output/run.lcmlog" --report "$output/run.html" >/dev/null 2>&1; then
  pages+=" and $output/run.html (how the run went)"
fi
echo "Look at $pages; the run's telemetry and CAN log lie beside."
if ((executed != 0)); then exit "$executed"; fi
grep -q '"within_tolerance": true' "$output/truth.json"
