#!/bin/bash
# Carries out the experiments of sim/README.md: plans, evaluates, and leaves NAME.json and NAME.html of
# each in the output folder. Its results folder gets NAME.json without the single runs, and the figures; what
# stands in sim/experiments/results was made by
#
#   sim/experiments/run.sh all --results sim/experiments/results
#
# Stopped and started again, it goes on where it was; the same sources give the same bytes.
#
#   sim/experiments/run.sh NAME... [-n RUNS] [--threads N] [--bin FOLDER] [--output FOLDER]
#                          [--results FOLDER]
#
#   fig11        box on a table, starts of sigma 0.05 and 0.03 m, with the plan made for each of them
#   fig13        peg in a hole, goal of sigma 0.01 m, clearance 1 mm: our plans for c_p 3 and 2, and two
#                baselines; clearance 0.5 mm: our plan for c_p 3
#   clearance    peg in a hole, clearance by friction
#   tilt         peg in a hole, the hole tilted
#   noise        box on a table, sensor noise by force threshold
#   calibration  box on a table, errors of the tool's frame by errors of the sensor's
#   stiffness    box on a table, contact stiffness by cycle time
#   all
#
# Seeds and ranges stand here and in the files beside it, chosen before results were looked at, but for two
# that were changed after a first look at 60 runs and less: the start of fig11 (6 became 7, for which planning
# takes less time), and the range of the sensor noise (24 times became 6: taring refuses above 0.3 N).
# Before their first run the tilt was narrowed, and sweep_clearance_tight.yaml, the peg at 0.5 mm and the peg's cell
# were added. All of it was run again after the planner had changed, with the same seeds and ranges. The
# number of runs of a sweep is what there was time for. The bins of --by were chosen to show what had come
# out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

all=(fig13 fig11 clearance tilt noise calibration stiffness)
runs= threads=$(nproc) bin=build/release/bin output=build/experiments results= names=()
while (($#)); do
  case "$1" in
    -n | --threads | --bin | --output | --results)
      if (($# < 2)); then
        echo "run.sh: $1 needs a value" >&2
        exit 2
      fi
      case "$1" in
        -n) runs=$2 ;;
        --threads) threads=$2 ;;
        --bin) bin=$2 ;;
        --output) output=$2 ;;
        --results) results=$2 ;;
      esac
      shift 2
      ;;
    all) names+=("${all[@]}") && shift ;;
    *)
      if [[ " ${all[*]} " != *" $1 "* ]]; then
        sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}" >&2
        exit 2
      fi
      names+=("$1") && shift
      ;;
  esac
done
if ((${#names[@]} == 0)); then
  echo "run.sh: name an experiment, such as fig11; --help lists them" >&2
  exit 2
fi
results=${results:-$output/results}
mkdir -p "$output" "$results"

here=sim/experiments
box=planner/tasks/box_on_table_2d.yaml box_start=7 box_cell=hw/cells/gantry3.yaml
peg=planner/tasks/peg_in_hole_2d_fine.yaml peg_cell=hw/cells/gantry3_peg.yaml

# make_plan NAME CELL TASK [tenon-plan's options]: a plan in the output folder, made once.
make_plan() {
  local file=$output/$1.tnp cell=$2 task=$3
  shift 3
  [[ -e $file ]] || "$bin/tenon-plan" "$task" --cell "$cell" --threads "$threads" --time-limit 600 "$@" \
      -o "$file" >"$file.txt"
}

# evaluate NAME RUNS CELL TASK SEED FIGURES [tenon-evaluate's options]: FIGURES says which are kept.
evaluate() {
  local name=$1 count=${runs:-$2} cell=$3 task=$4 seed=$5 figures=$6
  shift 6
  echo "== $name"
  "$bin/tenon-evaluate" --cell "$cell" --task "$task" --seed "$seed" -n "$count" --threads "$threads" \
    --json "$output/$name.json" --report "$output/$name.html" --summary "$results/$name.json" \
    --figures "$output/$name" "$@"
  local file
  for file in "$output/$name"/*_"$figures".svg; do cp "$file" "$results/${name}_$(basename "$file")"; done
}

# edited SOURCE NAME FROM TO...: a copy in the output folder with some texts changed; prints its name.
edited() {
  local source=$1 file=$output/$2 text
  shift 2
  text=$(<"$source")
  while (($#)); do
    if [[ $text != *"$1"* ]]; then
      echo "run.sh: $source has no '$1'" >&2
      exit 1
    fi
    text=${text//"$1"/"$2"}
    shift 2
  done
  mkdir -p "$(dirname "$file")"
  echo "$text" >"$file"
  echo "$file"
}

box_plan() { make_plan box_30mm "$box_cell" "$box" --start "$box_start"; }

fig11() {
  local wide
  wide=$(edited "$box" box_sigma_50mm.yaml 'sigma_m: [0.03, 0.03]' 'sigma_m: [0.05, 0.05]')
  box_plan
  make_plan box_50mm "$box_cell" "$wide" --start "$box_start"
  local options=(--experiment "$here/box_on_table.yaml"
    --plan "$output/box_50mm.tnp" --plan "$output/box_30mm.tnp")
  evaluate fig11_sigma_50mm 1000 "$box_cell" "$wide" 1101 runs "${options[@]}"
  evaluate fig11_sigma_30mm 1000 "$box_cell" "$box" 1102 runs "${options[@]}"
}

peg_plan() { make_plan peg_cp3 "$peg_cell" "$peg#clearance_1mm"; }

fig13() {
  peg_plan
  make_plan peg_cp2 "$peg_cell" "$peg#clearance_1mm_2_sigma"
  make_plan peg_single_particle "$peg_cell" "$peg#clearance_1mm" --method single-particle
  make_plan peg_contact_greedy "$peg_cell" "$peg#clearance_1mm" --method contact-greedy
  make_plan peg_cp3_half "$peg_cell" "$peg#clearance_0.5mm"
  local world=(--experiment "$here/peg_in_hole.yaml")
  evaluate fig13 1000 "$peg_cell" "$peg#clearance_1mm" 1301 draws "${world[@]}" \
    --plan "$output/peg_cp3.tnp" --plan "$output/peg_cp2.tnp" \
    --plan "$output/peg_single_particle.tnp" --plan "$output/peg_contact_greedy.tnp"
  evaluate fig13_half 1000 "$peg_cell" "$peg#clearance_0.5mm" 1302 draws "${world[@]}" \
    --plan "$output/peg_cp3_half.tnp"
}

clearance() {
  peg_plan
  evaluate clearance 400 "$peg_cell" "$peg#clearance_1mm" 2001 by \
    --experiment "$here/sweep_clearance.yaml" --plan "$output/peg_cp3.tnp" \
    --by friction=0.1:0.8:4 --by clearance_m=-0.0008:0.003:5
  evaluate clearance_tight 400 "$peg_cell" "$peg#clearance_1mm" 2011 by \
    --experiment "$here/sweep_clearance_tight.yaml" --plan "$output/peg_cp3.tnp" \
    --by friction=0.1:0.8:4 --by clearance_m=-0.0009:0.0001:5
}

tilt() {
  peg_plan
  evaluate tilt 400 "$peg_cell" "$peg#clearance_1mm" 2002 by --experiment "$here/sweep_tilt.yaml" \
    --by task_in_base_error_rad=0:0.024:8 --plan "$output/peg_cp3.tnp"
}

noise() {
  local plans=() on_N task
  for on_N in 3 6 12; do
    task=$(edited "$box" "box_on_${on_N}N.yaml" 'force_on_N: 6.0' "force_on_N: $on_N.0" \
      'force_keep_N: 3.0' "force_keep_N: $((500 * on_N))e-3" \
      'force_off_N: 1.5' "force_off_N: $((250 * on_N))e-3")
    make_plan "box_on_${on_N}N" "$box_cell" "$task" --start "$box_start"
    plans+=(--plan "$output/box_on_${on_N}N.tnp")
  done
  evaluate noise 100 "$box_cell" "$box" 2003 by --experiment "$here/sweep_noise.yaml" \
    --by sensor_noise_factor=0:6:6 "${plans[@]}"
}

calibration() {
  box_plan
  evaluate calibration 400 "$box_cell" "$box" 2004 by --experiment "$here/sweep_calibration.yaml" \
    --by tool_in_flange_error_m=0:0.008:4 --by sensor_in_flange_error_rad=0:0.16:4 \
    --plan "$output/box_30mm.tnp"
}

stiffness() {
  local ms folder cell robot=hw/robots/gantry3
  for ms in 2 4 8; do
    # A cell finds its robot, and the robot its URDF, beside itself. A setpoint takes two cycles.
    folder=cycle_${ms}ms
    edited "$robot/robot.yaml" "$folder/robot.yaml" 'cycle_us: 2000' "cycle_us: ${ms}000" \
      'response_lag_s: 0.004' "response_lag_s: $((2 * ms))e-3" >/dev/null
    cp "$robot/gantry3.urdf" "$output/$folder/"
    cell=$(edited "$box_cell" "$folder/cell.yaml" '../robots/gantry3/' '')
    make_plan "box_$folder" "$cell" "$box" --start "$box_start"
    evaluate "stiffness_$folder" 100 "$cell" "$box" 2005 by --experiment "$here/sweep_stiffness.yaml" \
      --by contact_stiffness_Npm=1e4:5e5:7 --plan "$output/box_$folder.tnp"
  done
}

for name in "${names[@]}"; do "$name"; done
echo "results: $results"
