#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The checker of headers finds what it is there for, and leaves the rest alone."""
import unittest

import headers


class Headers(unittest.TestCase):
    def found(self, text, of_test=False):
        return [number for number, _ in headers.faults(text, of_test)]

    def test_standard_and_libraries_pass(self):
        self.assertEqual(self.found("#include <vector>\n#include <Eigen/Dense>\n#include <expat.h>\n"), [])

    def test_system_headers_are_found_with_their_line(self):
        for header in ("unistd.h", "sys/wait.h", "linux/filter.h", "pthread.h", "signal.h", "dlfcn.h", "windows.h"):
            self.assertEqual(self.found("#pragma once\n#include <%s>\n" % header), [2])

    def test_a_processor_is_asked_for_within_if(self):
        self.assertEqual(self.found("#if defined(__SSE2__)\n#include <immintrin.h>\n#endif\n"), [])
        self.assertEqual(self.found("#if 1\n#endif\n#include <immintrin.h>\n"), [3])

    def test_calls_of_posix_are_found(self):
        self.assertEqual(self.found("int f() { return ::getpid(); }\n"), [1])
        self.assertEqual(self.found("void f() { setenv(a, b, 1); }\n"), [1])

    def test_names_alike_are_no_calls_of_posix(self):
        text = "x.poll(20);\nbus->poll(1);\nstd::any pipe(int a);\n// kill(1)\nown::kill(2);\n"
        self.assertEqual(self.found(text), [])

    def test_types_and_files(self):
        self.assertEqual(self.found('pid_t p;\nauto f = "/proc/self/exe";\n'), [1, 2])
        self.assertEqual(self.found('auto f = "/dev/full";\n', of_test=True), [])


if __name__ == "__main__":
    unittest.main()
