# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DFOLDER=core -DOUTPUT=insula_headers.h -P headers_hash.cmake: a hash of all headers that a plugin may include.
# A shared plugin carries the hash it was built with, so nobody has to remember to raise a number when a header changes.
file(GLOB_RECURSE headers RELATIVE ${FOLDER} ${FOLDER}/*.h)
list(FILTER headers EXCLUDE REGEX "^testing/|^bus/|_for_test\\.h$")
list(SORT headers)
set(all)
foreach(h ${headers})
  file(SHA256 ${FOLDER}/${h} hash)
  string(APPEND all "${h} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 12 hash)
file(CONFIGURE OUTPUT ${OUTPUT}
  CONTENT "// generated: hash of the core's headers\n#pragma once\n#define INSULA_HEADERS \"${hash}\"\n")
