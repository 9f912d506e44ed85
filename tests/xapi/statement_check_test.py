#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stand-in refuses what the specification forbids: each change to a good statement makes it a bad one."""
import copy
import unittest

import statement_check

GOOD = {
    "id": "2ed6657d-e927-568b-95e1-2665a8aea6a2",
    "actor": {"objectType": "Agent", "account": {"homePage": "https://example.org", "name": "P07"}},
    "verb": {"id": "http://adlnet.gov/expapi/verbs/passed", "display": {"en-US": "passed"}},
    "object": {"id": "https://example.org/a", "definition": {"name": {"en": "A"}, "type": "https://example.org/t"}},
    "result": {
        "score": {"scaled": 0.5, "raw": 1, "min": 0, "max": 2},
        "success": True,
        "duration": "PT30.25S",
        "extensions": {"https://example.org/e": 1},
    },
    "context": {"registration": "0d5dc6a4-7e0b-4c2f-9a54-0f7a4b7f1a11", "platform": "Insula", "language": "en"},
    "timestamp": "2023-11-14T22:13:20.123Z",
}
BAD = [
    (("id",), "seven"),
    (("id",), "2ed6657d-e927-568b-15e1-2665a8aea6a2"),
    (("actor",), None),
    (("actor", "account", "homePage"), "example.org"),
    (("actor", "account", "name"), 7),
    (("actor", "mbox"), "mailto:a@example.org"),
    (("verb", "id"), "passed"),
    (("verb", "display"), {"en_US": "passed"}),
    (("object", "id"), "a b"),
    (("object", "definition", "type"), "simulation"),
    (("object", "definition", "title"), "A"),
    (("result", "score", "scaled"), 1.5),
    (("result", "score", "raw"), 3),
    (("result", "score", "min"), 2),
    (("result", "success"), "true"),
    (("result", "duration"), "30.25"),
    (("result", "duration"), "PT"),
    (("result", "extensions"), {"e": 1}),
    (("context", "registration"), "r1"),
    (("context", "language"), "e"),
    (("timestamp",), "2023-11-14 22:13:20"),
    (("verbs",), {}),
    (("version",), "2.0.0"),
]


class Check(unittest.TestCase):
    def test_a_good_statement(self):
        statement_check.check(GOOD)

    def test_a_missing_part(self):
        for name in ("actor", "verb", "object"):
            with self.assertRaises(statement_check.Bad, msg=name):
                statement_check.check({k: v for k, v in GOOD.items() if k != name})

    def test_each_wrong_part(self):
        for path, value in BAD:
            bad = copy.deepcopy(GOOD)
            place = bad
            for step in path[:-1]:
                place = place[step]
            place[path[-1]] = value
            with self.assertRaises(statement_check.Bad, msg=f"{path} {value}"):
                statement_check.check(bad)


if __name__ == "__main__":
    unittest.main()
