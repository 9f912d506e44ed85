#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The include checker finds what it is there for."""
import unittest

import includes

ROOMS = includes.read_rooms("base:\nlinalg:base\nmechanics:base,linalg\n")


class Includes(unittest.TestCase):
    def problems(self, path, include):
        return includes.check({path: f'#pragma once\n#include "{include}"\n'}, ROOMS)

    def test_declared_use_is_allowed(self):
        self.assertEqual(self.problems("core/linalg/a.h", "core/base/math.h"), [])
        self.assertEqual(self.problems("plugins/clip/clip.cpp", "core/mechanics/body.h"), [])

    def test_circle_is_found_with_its_line(self):
        self.assertEqual(self.problems("core/linalg/a.h", "core/mechanics/body.h"),
                         ["core/linalg/a.h:2: core/linalg may not include from core/mechanics: core/mechanics/body.h"])

    def test_engine_knows_no_plugin(self):
        self.assertEqual(len(self.problems("engine/live/frame.cpp", "plugins/clip/clip.h")), 1)

    def test_plugin_knows_no_program(self):
        self.assertEqual(len(self.problems("plugins/clip/clip.cpp", "engine/live/frame.h")), 1)

    def test_tests_may_include_anything(self):
        self.assertEqual(self.problems("core/linalg/a_test.cpp", "core/mechanics/body.h"), [])


if __name__ == "__main__":
    unittest.main()
