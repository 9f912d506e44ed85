#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The checkers of this folder see what they are for."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import function_length  # noqa: E402
import lines  # noqa: E402
from sources import code_only  # noqa: E402

CODE = """namespace n {
struct Holder {
  Holder() : a_{1}, b_(2) {
    go();
  }
  int size() const { return 1; }  // a brace: {
  std::array<int, 2> two{1, 2};
};
TEST(Suite, Name) {
  const char* text = "} not a brace";
  const auto f = [](int x) {
    if (x) { return 1; }
    return 2;
  };
}
}  // namespace n
"""


class Functions(unittest.TestCase):
    def test_names_and_lines(self):
        found = function_length.functions(CODE)
        self.assertIn(("size", 6, 6), found)
        self.assertIn(("TEST(Suite, Name)", 9, 15), found)
        self.assertFalse([f for f in found if f[0] in ("if", "f", "two")])

    def long_ones(self, comment, ending=".cpp"):
        """The functions over the limit in a source with this comment above one function of 72 lines."""
        body = "".join("  step();\n" for _ in range(70))
        text = comment + ("def much():\n" + body + "\n" if ending == ".py" else "void much() {\n" + body + "}\n")
        with tempfile.NamedTemporaryFile("w", suffix=ending) as file:
            file.write(text.replace("step();", "step()") if ending == ".py" else text)
            file.flush()
            return [(name, length) for name, _, length in function_length.long_functions(pathlib.Path(file.name))]

    def test_length_and_reason(self):
        self.assertEqual(self.long_ones("// Does much.\n"), [("much", 72)])
        self.assertEqual(self.long_ones("// Long because its steps share all of their state.\n"), [])
        self.assertEqual(self.long_ones("/// Does much. Long because its steps share their state.\n"), [])
        self.assertEqual(self.long_ones("// Long because of this.\n\n"), [("much", 72)])
        self.assertEqual(self.long_ones("// It is too Long because it grew.\n"), [("much", 72)])

    def test_python(self):
        self.assertEqual(self.long_ones("# Does much.\n", ".py"), [("much", 71)])
        self.assertEqual(self.long_ones("# Long because its steps share all of their state.\n", ".py"), [])

    def test_code_only_keeps_places(self):
        self.assertEqual(len(code_only(CODE)), len(CODE))
        self.assertEqual(code_only('x = "a\\"b"; // c').rstrip(), "x =       ;")
        self.assertEqual(code_only("n = 1'000;").rstrip(), "n = 1'000;")


class Lines(unittest.TestCase):
    def faults(self, name, text):
        return [n for n, _ in lines.faults(pathlib.Path(name), text)]

    def test_columns(self):
        self.assertEqual(self.faults("a.cpp", "x" * 120 + "\n" + "y" * 121), [2])
        self.assertEqual(self.faults("a.md", "| " + "x" * 130 + "\n" + "y" * 121), [2])

    def test_blanks(self):
        self.assertEqual(self.faults("a.py", "x = 1 \n\ty\n"), [1])


if __name__ == "__main__":
    unittest.main()
