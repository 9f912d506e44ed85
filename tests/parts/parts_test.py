#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The division of the long tests into parts, and what --check finds."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import parts  # noqa: E402


class Division(unittest.TestCase):
    LINES = [(400, ("a",)), (300, ("b", "b2")), (200, ("c",)), (150, ("d",)), (100, ("e",)), (50, ("browser:f",))]

    def test_each_line_has_one_part_and_the_parts_are_even(self):
        home, load = parts.divide(self.LINES, 3)
        self.assertEqual(sorted(home), sorted(names for _, names in self.LINES))
        self.assertEqual(sum(load), 1200)
        self.assertEqual(load, [400, 400, 400])

    def test_it_does_not_depend_on_the_order_of_the_lines(self):
        self.assertEqual(parts.divide(self.LINES, 4), parts.divide(self.LINES[::-1], 4))

    def test_every_part_is_run_by_some_commit(self):
        self.assertEqual({int(c, 16) % parts.PARTS for c in "0123456789abcdef"}, set(range(parts.PARTS)))


class List(unittest.TestCase):
    def test_lines_are_seconds_and_names(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "long_tests.txt"
            path.write_text("# a comment\n\n12.5 ^one$ browser:two  # why\n")
            self.assertEqual(list(parts.read(path)), [(12.5, ("^one$", "browser:two"))])

    def test_names_without_a_test_and_tests_with_two_names_are_found(self):
        lines = [(1, ("^one",)), (1, ("one$",)), (1, ("^three$",)), (1, ("browser:four",))]
        self.assertEqual(parts.mistakes(lines, ["one", "two"], ["five"]), [
            "one is named by ^one and by one$",
            "^three$: there is no such test",
            "browser:four: there is no such test"])


class Numbers(unittest.TestCase):
    def test_they_are_those_of_the_tests_that_no_name_is_found_in(self):
        tests = {1: "Case.one", 2: "Case.two", 7: "Own/Case.one/(a"}
        self.assertEqual(parts.numbers_of([r"^Case\.(one|three)$", "browser:page"], tests), "0,0,0,2,7")


if __name__ == "__main__":
    unittest.main()
