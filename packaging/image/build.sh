#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# build.sh PACKAGE.deb TARGET [--suite SUITE] [--mirror URL] [--keep-root]
# Writes the image of Insula into the folder TARGET: insula-VERSION.oci.tar for every runtime of OCI images, and
# insula-VERSION.docker.tar for Docker and for podman's health checks, since the OCI format has no field for them.
# Its base is a Debian that mmdebstrap makes from the mirror, so no registry of images is asked. It needs mmdebstrap and
# buildah, and neither root nor a daemon: without root, both use a user namespace.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fail() { printf 'error: %s\n' "$*" >&2; exit 2; }
say() { printf '== %s\n' "$*" >&2; }

words=() suite=bookworm mirror=http://deb.debian.org/debian keep=no
while [ $# -gt 0 ]; do
  case $1 in
    --suite) suite=${2:?--suite needs a name}; shift ;;
    --mirror) mirror=${2:?--mirror needs an address}; shift ;;
    --keep-root) keep=yes ;;
    -*) fail "unknown option $1" ;;
    *) words+=("$1") ;;
  esac
  shift
done
[ ${#words[@]} = 2 ] || fail "build.sh needs a package and a folder"
package=$(realpath "${words[0]}")
[ -f "$package" ] || fail "$package is no file"
for tool in mmdebstrap buildah dpkg-deb; do
  command -v $tool >/dev/null || fail "$tool is not installed: apt-get install mmdebstrap buildah uidmap"
done
[ "$(dpkg-deb --field "$package" Package)" = insula ] || fail "$package is not the package insula"
version=$(dpkg-deb --field "$package" Version)
mkdir -p "${words[1]}"
target=$(realpath "${words[1]}")
work=$(mktemp -d "${TMPDIR:-/tmp}/insula_image.XXXXXX")
chmod 755 "$work"
trap 'rm -rf "$work"' EXIT
root=$work/root.tar

say "Debian $suite with Insula $version"
install -m 644 "$package" "$work/insula.deb"
mode=unshare
[ "$(id -u)" = 0 ] && mode=root
# Manuals, translations and examples of the packages are left out; licences stay.
mmdebstrap --quiet --mode=$mode --variant=minbase \
  --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
  --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-include=/usr/share/doc/*/copyright' \
  --aptopt='APT::Install-Recommends "false"' \
  --customize-hook="copy-in $work/insula.deb /tmp" \
  --customize-hook='chroot "$1" apt-get install -y /tmp/insula.deb' \
  --customize-hook="copy-in $here/health /usr/lib/insula" \
  --customize-hook='chmod 755 "$1/usr/lib/insula/health"' \
  --customize-hook='chroot "$1" useradd --uid 1000 --create-home --shell /usr/sbin/nologin insula' \
  --customize-hook='chroot "$1" install -d -o insula -g insula /data' \
  --customize-hook='rm -rf "$1"/tmp/insula.deb "$1"/var/lib/apt/lists/* "$1"/var/cache/apt/*.bin' \
  "$suite" "$root" "$mirror"

say "the image"
cat >"$work/assemble.sh" <<'ASSEMBLE'
set -euo pipefail
container=$(buildah from scratch)
trap 'buildah rm "$container" >/dev/null' EXIT
buildah add "$container" "$ROOT" / >/dev/null
# Published ports come from outside of the container: pages log in with the PIN that the log shows.
buildah config --user insula --workingdir /home/insula --env XDG_DATA_HOME=/data --env INSULA_PORT=8080 \
  --volume /data --port 8080 --entrypoint '["insula"]' \
  --cmd 'play --no-browser --no-mdns --listen 0.0.0.0 --pin --port 8080' \
  --healthcheck 'CMD /usr/lib/insula/health' --healthcheck-interval 30s --healthcheck-timeout 10s \
  --healthcheck-start-period 60s --healthcheck-retries 3 \
  --label org.opencontainers.image.title=Insula --label org.opencontainers.image.version="$VERSION" \
  --label org.opencontainers.image.licenses=GPL-3.0-or-later \
  --label org.opencontainers.image.description="Training in aneurysm surgery. Never for the care of patients." \
  "$container"
image=$(buildah commit --quiet --format docker "$container")
rm -f "$TARGET/insula-$VERSION.docker.tar" "$TARGET/insula-$VERSION.oci.tar"
buildah push --quiet "$image" "docker-archive:$TARGET/insula-$VERSION.docker.tar:localhost/insula:$VERSION"
buildah push --quiet --format oci "$image" "oci-archive:$TARGET/insula-$VERSION.oci.tar:insula:$VERSION"
buildah rmi "$image" >/dev/null
ASSEMBLE
# A store of its own and the plain file system driver: nothing of the user's images is touched.
store=(--root "$work/store" --runroot "$work/run" --storage-driver vfs)
sed -i "s#\bbuildah #buildah ${store[*]} #" "$work/assemble.sh"
export ROOT=$root VERSION=$version TARGET=$target BUILDAH_ISOLATION=chroot
if [ "$(id -u)" = 0 ]; then bash "$work/assemble.sh"; else buildah unshare bash "$work/assemble.sh"; fi
if [ $keep = yes ]; then mv "$root" "$target/insula-$version.root.tar"; fi
ls -l --block-size=M "$target" | awk 'NR > 1 { print $5, $9 }' >&2
say "podman load -i $target/insula-$version.docker.tar; docs/distribution.md goes on"
