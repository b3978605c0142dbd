#!/bin/sh
# Repeats the run that wrote this folder and compares its numbers with those of summary.json.
#   sh reproduce.sh [FOLDER]    FOLDER: where the new result goes; without it, a temporary one
# FISHERHILL=/path/to/fisherhill names the program if it is not in PATH.
set -eu

# SHA-256 of the inputs; their paths are as seen from the folder in which the command ran.
inputs() {
  cat <<'END_OF_INPUTS'
{{inputs}}END_OF_INPUTS
}
version={{version}}
then_in={{then_in}}       # that folder as it was called
back={{back}}             # the way to it from here
run() {
  "$program"{{command}}
}

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd -P)
program=${FISHERHILL:-fisherhill}
case $program in
  /*) ;;
  */*) program=$PWD/$program ;;
esac
case ${1-} in
  '') new=$(mktemp -d)/result ;;
  /*) new=$1 ;;
  *) new=$PWD/$1 ;;
esac

found=no
for folder in "$here/$back" "$then_in"; do
  cd -- "$folder" 2>/dev/null || continue
  if [ -z "$(inputs)" ] || inputs | sha256sum --check --status 2>/dev/null; then
    found=yes
    break
  fi
done
if [ $found = no ]; then
  echo "reproduce.sh: not the inputs of that run, in $PWD:" >&2
  inputs | sha256sum --check --quiet >&2 || true
  exit 1
fi

version_here=$("$program" --version) || {
  echo "reproduce.sh: cannot start $program; FISHERHILL=/path/to/fisherhill names the program" >&2
  exit 2
}
if [ "$version_here" != "$version" ]; then
  echo "reproduce.sh: warning: the result is of $version, this is $version_here" >&2
fi

status=0
run || status=$?
if [ ! -f "$new/summary.json" ]; then
  echo "reproduce.sh: no result (exit status $status)" >&2
  exit "$((status > 0 ? status : 1))"
fi

# Both files have one value on each line. What depends on the clock or the machine is left out.
awk '
function value(text) { sub(/^ *("[^"]*": )?/, "", text); sub(/,$/, "", text); return text }
function size(x) { return x < 0 ? -x : x }
FNR == 1 { file++; n = 0; skip = 0 }
/^  "/ { skip = $1 ~ /^"(version|command_line|inputs|files|files_sha256|sentence|computed|ranks|cycle_ms)":$/ }
skip || /"[^"]*(wall|_ms|ms_per|cost_ratio|deadline|wake_up)[^"]*":/ { next }
{ n++ }
file == 1 { line[n] = $0; lines = n; next }
{
  a = value(line[n]); b = value($0)
  is_number = a ~ /^-?[0-9]/ && b ~ /^-?[0-9]/
  numbers += is_number
  if (a == b) next
  if (!is_number) { others++; print "  was " line[n] "\n  is  " $0; next }
  difference = size(a - b) / (size(a) > size(b) ? size(a) : size(b))
  if (difference > 1e-6) { differ++; print "  was " line[n] "\n  is  " $0 }
  if (difference > largest) largest = difference
}
END {
  if (n != lines) { others++; print "  the summaries have " lines " and " n " lines" }
  printf "reproduce.sh: %d of %d numbers agree to a millionth; largest relative difference %.2g\n",
    numbers - differ, numbers, largest
  if (others > 0) printf "reproduce.sh: %d other entries differ\n", others
  exit (differ + others > 0)
}' "$here/summary.json" "$new/summary.json" || status=1
echo "reproduce.sh: the new result is in $new"
exit "$status"
