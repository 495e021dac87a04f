#!/usr/bin/env bash
# The main job end to end: scenes/demo.sh DUCTILE FOLDER, where DUCTILE is the command and FOLDER takes the pictures.
set -euo pipefail
cd "$(dirname "$0")/.."
ductile=$1
out=$2
mkdir -p "$out"

run() {
  printf '\n$ ductile'
  printf ' %s' "$@"
  printf '\n\n'
  "$ductile" "$@"
}

# A machine without rsvg-convert makes the SVGs alone.
pictures() {
  printf -- '--picture\n%s/%s.svg\n' "$out" "$1"
  ! command -v rsvg-convert >/dev/null || printf -- '--picture\n%s/%s.png\n' "$out" "$1"
}

echo 'A harbour crane, drawn in scenes/harbour_crane.svg. Its jib is cut into twelve pieces; what each joint between
them can carry follows from the length of its cut, around the holes, and from the steel.'
mapfile -t files < <(pictures capacities)
run calibrate scenes/harbour_crane.scene.json "${files[@]}"

echo '
The container has caught on the barge. The first swell bends the jib, the second one breaks it.'
mapfile -t files < <(pictures run)
run simulate scenes/harbour_crane.scene.json --time 6 "${files[@]}" --picture-at 2.5,3.9,6

echo '
The pictures:'
ls -1 "$out"/capacities.* "$out"/run.*
