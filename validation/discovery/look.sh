# Read by the suites beside it (. look.sh); $build is set there.

# look FOLDER WORDS…: the program's verdict into FOLDER, what it says into FOLDER.txt; nothing where
# there is one already, but for one that was cut short. No verdict where it cannot give one (2): the
# scorer counts that as wrong. 1: the answer is "numerical".
look() {
  into=$1
  shift
  if [ -e "$into/verdict.json" ] && ! grep -q '"verdict": "stopped"' "$into/verdict.json"; then
    return 0
  fi
  mkdir -p "$into"
  "$build/apps/fisherhill" discover "$@" --force --out "$into" > "$into.txt" 2>&1 || [ $? -le 2 ]
}
