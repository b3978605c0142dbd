#!/bin/sh
# How many instructions a run of each hot job takes, by callgrind, beside those of instructions.txt: what
# changed by more than 5 % is marked, and ends it with status 1. Unlike times they do not feel what else the
# machine does; they do depend on compiler and C library, so record anew where those are others.
#
#   bench/count_instructions.sh build/release/bench/speed_table            compares
#   bench/count_instructions.sh build/release/bench/speed_table --record   writes instructions.txt
set -eu
program=${1:?usage: $0 path/to/speed_table [--record]}
folder=$(dirname "$0")
known=$folder/instructions.txt
jobs="simulation configurations sensitivities-60 sensitivities-all prediction compilation"

# $1: job, $2: runs
total() {
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" --run "$1" "$2" 2>&1 |
    sed -n 's/.*Collected : //p'
}

counts=$(for job in $jobs; do
  once=$(total "$job" 1)
  thrice=$(total "$job" 3)
  echo "$job $(((thrice - once) / 2))"
done)

if [ "${2:-}" = --record ]; then
  {
    echo "# Instructions of one run, written by bench/count_instructions.sh: $(date -u +%F), $(c++ --version | head -n 1),"
    echo "# $(ldd --version | head -n 1), $(uname -m)"
    echo "$counts"
  } > "$known"
  cat "$known"
  exit
fi
echo "$counts" | awk -v known="$known" '
  BEGIN { while ((getline line < known) > 0) if (split(line, word, " ") == 2) before[word[1]] = word[2] }
  {
    if (!($1 in before)) { printf "%-18s %12d  new\n", $1, $2; next }
    change = 100 * ($2 / before[$1] - 1)
    marked = change > 5 || change < -5
    printf "%-18s %12d %+7.1f %%%s\n", $1, $2, change, marked ? "  <-- more than 5 %" : ""
    if (marked) changed = 1
  }
  END { exit changed }'
