#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Rebuilds the meshes of an approach from Debian's package mricron-data:
#   tools/mesh_lobes/rebuild.sh [FOLDER [build-dir [output-dir]]]
# FOLDER (meshes/lobes) holds approach.json, which states the parts, the ball and the sizes.
# Needs: mricron-data libcgal-dev zlib1g-dev cmake ninja-build g++ python3. Takes a few minutes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
folder=$(cd "${1:-$root/meshes/lobes}" && pwd)
build=${2:-$root/build/mesh_lobes}
out=${3:-$folder}
templates=$(dpkg -L mricron-data 2>/dev/null | sed -n 's|/aal\.nii\.gz$||p')
if [ -z "$templates" ]; then
  echo "rebuild.sh: the package mricron-data is missing (apt-get install mricron-data)" >&2
  exit 2
fi
cmake -S "$here" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
ninja -C "$build" insula_mesh_volume
mkdir -p "$out"
cd "$out"
python3 "$here/rebuild_options.py" "$folder" | while read -r options; do
  # The options hold no blanks of their own.
  "$build/insula_mesh_volume" --labels "$templates/aal.nii.gz" \
    --more-labels "$templates/JHU-WhiteMatter-labels-1mm.nii.gz" \
    --intensity "$templates/ch2better.nii.gz" --tissue 68 $options
done
python3 "$here/falx.py" "$folder" "$out"
python3 "$here/manifest.py" "$folder" "$out"
