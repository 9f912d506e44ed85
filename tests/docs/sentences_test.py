#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What sentences.py counts, on texts whose counts are known."""
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import sentences  # noqa: E402

PAGE = """# A heading is no sentence of the page
One two three. Four `a span of code`, six [seven eight](https://nowhere.org).
Is this one? Yes!

- A list item without a full stop
- Another item of et al. 2015 with an abbreviation.
  It goes on here.

    a formula = does not count

| cell | another |
|---|---|
| %s | short |

<!-- a comment
of two lines -->
```sh
echo This is no sentence either.
```
"""
HEADER = """// SPDX-License-Identifier: GPL-3.0-or-later
// The top comment. It has two sentences.
//   formula = that does not count
#pragma once
/// A doc comment,
/// in two lines.
int x;  ///< of a member
"""
SOURCE = """// SPDX-License-Identifier: GPL-3.0-or-later
/*
# clip
The top comment of a plugin.

    code = here;
*/
#include <x>
// A later comment is counted too.
int y;
"""


def main():
    failures = 0

    def equal(got, wanted, what):
        nonlocal failures
        if got != wanted:
            failures += 1
            print("FAILED: %s: %r in place of %r" % (what, got, wanted))

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def counts(file, text, read):
            (folder / file).write_text(text, encoding="utf-8")
            texts, cells = read(folder / file)
            return [n for t in texts for n, _ in sentences.sentences(t)], sentences.measure(texts, cells)

        words, (_, long) = counts("page.md", PAGE % "a cell.", sentences.of_page)
        equal(words, [3, 5, 3, 1, 7, 9, 4], "words of a page's sentences")
        equal(long, [], "a page of short sentences")
        _, (entry, long) = counts("page.md", PAGE % ("word " * 41), sentences.of_page)
        equal((entry["max"], len(long)), (41, 1), "a long sentence in a cell")
        words, (entry, long) = counts("page.md", "word " * 40 + "\n\n" + "word " * 41, sentences.of_page)
        equal((entry["max"], entry["mean"], [n for n, _ in long]), (41, 40.5, [41]), "the limit")
        equal(counts("a.h", HEADER, sentences.comments)[0], [3, 4, 6, 3], "words of a header's comments")
        equal(counts("a.cpp", SOURCE, sentences.comments)[0], [6, 6], "words of a source's comments")
    print("%d failures" % failures)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
