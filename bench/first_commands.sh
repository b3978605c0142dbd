#!/usr/bin/env bash
# How long the README's two commands take: clones this checkout, as committed, to a temporary folder, runs `./start --yes`
# and then `./start test --yes` in it without ccache, and prints both real times and, after the last repetition, their
# medians as a line for the README. Debian packages that are missing are installed in the first repetition, so the
# median of three is that of a machine that has them. Nothing else should run meanwhile.
#
#   bench/first_commands.sh [--times N] [--start COMMAND]
#
# --times N          repetitions, 3 by default, each in a new clone
# --start COMMAND    runs COMMAND in place of ./start, to try this script out
# TMPDIR, /tmp by default, needs about 3 GB. What the commands say is shown only if one of them fails, which ends this
# with status 1.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
repetitions=3
start=./start

wrong() { printf 'first_commands.sh: %s\n' "$*" >&2; exit 2; }
while [ $# -gt 0 ]; do
  [ $# -ge 2 ] || wrong "'$1' is no option, or has no value; see the first lines of this file"
  case "$1" in
    --times) repetitions=$2 ;;
    --start) start=$2 ;;
    *) wrong "unknown option '$1'; see the first lines of this file" ;;
  esac
  shift 2
done
[[ $repetitions =~ ^[1-9][0-9]*$ ]] || wrong "--times is '$repetitions', must be a whole number > 0"

export CCACHE_DISABLE=1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# $1: clone; the rest: arguments of start. Prints the real time in seconds.
seconds() {
  local clone=$1 began ended
  shift
  began=$(date +%s%N)
  if ! (cd "$clone" && "$start" "$@" </dev/null >"$scratch/said" 2>&1); then
    tail -n 30 "$scratch/said" >&2
    printf 'first_commands.sh: %s failed; above are its last lines\n' "$start $*" >&2
    return 1
  fi
  ended=$(date +%s%N)
  awk -v ns=$((ended - began)) 'BEGIN { printf "%.1f\n", ns / 1e9 }'
}

# The median of the lines, in words.
median() {
  sort -n | awk '
    { time[NR] = $1 }
    END {
      whole = int((time[int((NR + 1) / 2)] + time[int(NR / 2) + 1]) / 2 + 0.5)
      if (whole >= 60) printf "%d min ", whole / 60
      printf "%d s\n", whole % 60
    }'
}

for ((i = 1; i <= repetitions; ++i)); do
  git clone --quiet "$root" "$scratch/clone"
  first=$(seconds "$scratch/clone" --yes)
  second=$(seconds "$scratch/clone" test --yes)
  printf '%d: ./start %s s, ./start test %s s\n' "$i" "$first" "$second"
  echo "$first" >>"$scratch/first"
  echo "$second" >>"$scratch/second"
  rm -rf "$scratch/clone"
done
printf 'On %d cores, run in this order, the first command takes %s and the second %s (medians of %d, %s).\n' \
  "$(nproc)" "$(median <"$scratch/first")" "$(median <"$scratch/second")" "$repetitions" "$(date -u +%F)"
