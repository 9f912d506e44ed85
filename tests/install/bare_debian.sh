#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# bare_debian.sh SUITE [--ccache DIR] [--mirror URL] [--keep] [STEP...]
# Runs both commands of the README in a bare Debian: a root that debootstrap makes holds a clean clone and nothing else.
#   SUITE    bookworm (Debian 12) or trixie (Debian 13)
#   STEP     root, clone, play, build, test; all but build when none is named. "root" throws an old root away first.
#   --ccache DIR   a compiler cache that is mounted into the root, so that a second run is quick
#   --mirror URL   where the packages come from (default: http://deb.debian.org/debian)
#   --keep         the root stays at the end; a later run with a STEP goes on in it
# It needs root, debootstrap, git and a way to the package mirror and to npm's registry. Its root is BARE_DEBIAN_ROOT,
# or /var/tmp/insula-SUITE. It prints each step, its status and its time. Exit status 0: every step passed.
set -uo pipefail
source_tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
play_seconds=60

fail() { printf 'error: %s\n' "$*" >&2; exit 2; }
usage() { sed -n '3,12s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }

suite= cache= mirror=http://deb.debian.org/debian keep=no steps=()
while [ $# -gt 0 ]; do
  case $1 in
    -h|--help) usage; exit 0 ;;
    --ccache) cache=${2:?}; shift ;;
    --mirror) mirror=${2:?}; shift ;;
    --keep) keep=yes ;;
    root|clone|play|build|test) steps+=("$1") ;;
    bookworm|trixie) suite=$1 ;;
    *) usage >&2; fail "unknown word: $1" ;;
  esac
  shift
done
[ -n "$suite" ] || { usage >&2; fail "no suite named"; }
[ ${#steps[@]} -gt 0 ] || steps=(root clone play test)
[ "$(id -u)" = 0 ] || fail "needs root"
root=${BARE_DEBIAN_ROOT:-/var/tmp/insula-$suite}
log=$root.log

# Mounts live in a mount namespace of their own and end with the command.
in_root() {
  local certificates=${NODE_EXTRA_CA_CERTS:-}
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root TERM=dumb LANG=C.UTF-8 \
    http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" \
    ROOT="$root" CACHE="$cache" CERTIFICATES="$certificates" \
    unshare --mount --pid --fork --kill-child /bin/bash -c '
      set -e
      mount -t proc proc "$ROOT/proc"
      mount --rbind /dev "$ROOT/dev"
      [ -f /etc/resolv.conf ] && cp -L /etc/resolv.conf "$ROOT/etc/resolv.conf"
      if [ -n "$CACHE" ]; then
        mkdir -p "$CACHE" "$ROOT/ccache"
        mount --bind "$CACHE" "$ROOT/ccache"
        export CCACHE_DIR=/ccache CCACHE_BASEDIR=/insula
      fi
      # A network whose proxy signs with a certificate of its own is known to npm by this file.
      if [ -n "$CERTIFICATES" ]; then
        cp -L "$CERTIFICATES" "$ROOT/etc/extra-certificates.crt"
        export NODE_EXTRA_CA_CERTS=/etc/extra-certificates.crt npm_config_cafile=/etc/extra-certificates.crt
      fi
      exec chroot "$ROOT" /bin/bash -c "$1"' in_root "$1"
}

make_root() {
  rm -rf --one-file-system "$root"
  debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" "$mirror" || return
  # Services do not start in a root without an init.
  printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" && chmod +x "$root/usr/sbin/policy-rc.d"
}

clone() {
  rm -rf "$root/insula"
  git -c safe.directory='*' clone --no-hardlinks --quiet "$source_tree" "$root/insula"
}

play() {
  in_root "cd /insula && ./insula play --no-browser --duration '${play_seconds} s'"
}

run_step() {
  local name=$1 began=$SECONDS status=0
  printf '== %s: %s\n' "$suite" "$name"
  case $name in
    root) make_root ;;
    clone) clone ;;
    play) play ;;
    build) in_root "cd /insula && ./insula build" ;;
    test) in_root "cd /insula && ./insula test" ;;
  esac >>"$log" 2>&1 || status=$?
  printf '   %s after %d s\n' \
    "$([ $status = 0 ] && echo passed || echo "FAILED with status $status")" $((SECONDS - began))
  [ $status = 0 ] || { tail -n 40 "$log"; printf '   the whole log is %s\n' "$log"; }
  return $status
}

: >"$log"
result=0
for step in "${steps[@]}"; do
  run_step "$step" || { result=1; break; }
done
if [ $keep = no ]; then rm -rf --one-file-system "$root"; fi
exit $result
