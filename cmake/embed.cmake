# SPDX-License-Identifier: GPL-3.0-or-later
# insula_embed(OUTPUT NAMESPACE FILE name [FILE name ...]): a source with a table of files' texts, so that a program
# holds them wherever it is installed. FILE is read when CMake runs, and again whenever it changes.
function(insula_embed output function)
  string(CONCAT text
    "// generated: texts of files\n#include \"engine/authoring/embedded.h\"\nnamespace insula {\n"
    "std::span<const EmbeddedFile> ${function}() {\n  static constexpr EmbeddedFile files[] = {\n")
  set(rest ${ARGN})
  while(rest)
    list(POP_FRONT rest file name)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} content)
    string(APPEND text "{\"${name}\", R\"~insula~(${content})~insula~\"},\n")
  endwhile()
  string(APPEND text "  };\n  return files;\n}\n}  // namespace insula\n")
  if(EXISTS ${output})
    file(READ ${output} before)
    if(before STREQUAL text)
      return()
    endif()
  endif()
  file(WRITE ${output} "${text}")
endfunction()
