#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# LCM's own window onto the bus, lcm-spy, with Insula's message types. Debian's starter asks for an option that no Java
# of Debian 12 knows.
#
#   spy.sh FOLDER     where the types are built when lcm_types/ has changed
set -euo pipefail
types=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../lcm_types" && pwd)
jar=$1/insula_types.jar
share=/usr/share/java
if [ ! -f "$jar" ] || [ -n "$(find "$types" -newer "$jar" -print -quit)" ]; then
  rm -rf "$1"; mkdir -p "$1"
  lcm-gen -j --jpath "$1" "$types"/*.lcm
  find "$1" -name '*.java' -print0 | xargs -0 javac -nowarn -cp "$share/lcm.jar" -d "$1/classes"
  jar cf "$jar" -C "$1/classes" .
fi
exec java -Djava.net.preferIPv4Stack=true -cp "$share/lcm.jar:$share/jchart2d.jar:$jar" lcm.spy.Spy
