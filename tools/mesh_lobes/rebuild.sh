#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Rebuilds meshes/lobes from Debian's package mricron-data: tools/mesh_lobes/rebuild.sh [build-dir [output-dir]]
# Needs: mricron-data libcgal-dev zlib1g-dev cmake ninja-build g++ python3. Takes a few minutes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=${1:-$root/build/mesh_lobes}
out=${2:-$root/meshes/lobes}
templates=$(dpkg -L mricron-data 2>/dev/null | sed -n 's|/aal\.nii\.gz$||p')
if [ -z "$templates" ]; then
  echo "rebuild.sh: the package mricron-data is missing (apt-get install mricron-data)" >&2
  exit 2
fi
cmake -S "$here" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
ninja -C "$build" insula_mesh_volume
mkdir -p "$out"
cd "$out"

# AAL numbers of the right hemisphere. frontal: precentral, superior, middle, inferior (operculum, triangle, orbital),
# Rolandic operculum, supplementary motor, medial; and the gyri behind it that share the upper lip of the fissure
# (postcentral, inferior parietal, supramarginal). temporal: all of the lobe with hippocampus and amygdala.
# insula: the insula, and what lies behind the fissure's depth (basal frontal gyri, olfactory, striate body).
mesh() {
  "$build/insula_mesh_volume" --labels "$templates/aal.nii.gz" --intensity "$templates/ch2better.nii.gz" --tissue 68 \
    --part frontal=2,4,8,10,12,14,16,18,20,24,58,62,64 \
    --part temporal=38,40,42,56,80,82,84,86,88,90 \
    --part insula=6,22,26,28,30,72,74,76 \
    --roi 54,4,-2,35 --view 1,0.2,0.2 --focus 2,14 --focus-point 60,4,0,24 --coarse-gap 0.45 "$@"
}

# Training: coarse tetrahedra, fine surfaces, the fissure's course.
mesh --cell 2.8,6.8 --cell-of temporal=5.4,13 --cell-error 0.5,1.2 \
  --edge 0.8,2.5 --edge-of insula=1,3.5 --edge-error 0.08 \
  --tet frontal=frontal.msh:4.1 --tet temporal=temporal.msh:2.2 \
  --surface frontal=frontal_surface.ply --surface temporal=temporal_surface.ply --surface insula=insula_surface.ply \
  --cleft frontal,temporal=fissure.json

# Benchmark: the same shapes with many more nodes.
mesh --cell 1.35,2.4 --cell-error 0.15,0.4 --tet frontal=frontal_large.msh:4.1b --tet temporal=temporal_large.msh:4.1b

python3 "$here/manifest.py" "$out"
