#!/usr/bin/env python3
"""Checks the form of the documentation: links, pictures, lengths, formulas.

Usage: scripts/check_docs.py [--root FOLDER]

Each mistake is a line `file:line: what is wrong`, and the exit code is 1 if there are any:

- in all pages: links and pictures to files that are not there, links to pages that have moved, anchors that no heading has
  (by GitHub's rule, which is also the site's), links out of the repository, `$$` without its partner or with a blank line
  before it;
- in pages under docs/ that are written by hand: 1500 words or more, and lines of prose over 120 characters that could be
  broken. Tables, code, formulas and comments are exempt. So are generated blocks, `<!-- KIND -->` … `<!-- end of KIND -->`;
- pages under docs/ to which no other page links. Pages that only say where their text has gone are exempt.

The result pages that commands write (RESULT_PAGES in doc_pages.py) have no limits of length.
"""
import argparse
import pathlib
import re
import sys

import doc_pages

MOST_WORDS = 1500
MOST_COLUMNS = 120
GENERATED = re.compile(r"^<!-- (\w+) -->$.*?^<!-- end of \1 -->$", re.DOTALL | re.MULTILINE)


class Checker:
    def __init__(self, root):
        self.root, self.mistakes = root, []
        self.texts = {page: (root / page).read_text() for page in doc_pages.pages(root)}
        self.anchors, self.linked = {}, set()

    def fail(self, page, line, text):
        self.mistakes.append((page, line, text))

    def anchors_of(self, page):
        if page not in self.anchors:
            self.anchors[page] = doc_pages.anchors(self.texts[page])
        return self.anchors[page]

    def check_links(self, page):
        text = self.texts[page]
        for link in doc_pages.links_of(text):
            if doc_pages.is_outside(link.target):
                continue
            line = doc_pages.line_at(text, link.start)
            path, anchor = doc_pages.resolved(page, link.target)
            what = "picture" if link.is_picture else "link"
            if path.startswith("..") or link.target.startswith("/"):
                self.fail(page, line, f"{what} out of the repository: {link.target}")
            elif not link.target:
                self.fail(page, line, f"{what} without a target")
            elif not (self.root / path).exists():
                self.fail(page, line, f"{what} to a file that is not there: {link.target}")
            elif path in self.texts:
                if path != page and not doc_pages.is_stub(text):
                    self.linked.add(path)
                if doc_pages.is_stub(self.texts[path]):
                    self.fail(page, line, f"link to a page that has moved: {link.target}")
                elif anchor and anchor not in self.anchors_of(path):
                    self.fail(page, line, f"no heading of {path} has the anchor #{anchor}")
            elif anchor and not re.fullmatch(r"L\d+(-L\d+)?", anchor):
                self.fail(page, line, f"{path} is no page, so it has no anchor #{anchor}")

    def check_formulas(self, page):
        """`$$` in pairs, without a blank line between."""
        opened = None
        for number, line in enumerate(doc_pages.prose_of(self.texts[page]).split("\n"), 1):
            if opened and not line.strip():
                self.fail(page, opened, "$$ without its partner, or with a blank line before it")
                opened = None
            for _ in range(len(re.findall(r"(?<!\\)\$\$", line))):
                opened = None if opened else number
        if opened:
            self.fail(page, opened, "$$ without its partner")

    def check_length(self, page):
        text = GENERATED.sub("", self.texts[page])
        words = len(text.split())
        if words >= MOST_WORDS:
            self.fail(page, 1, f"{words} words; a page has fewer than {MOST_WORDS}")

    def check_columns(self, page):
        text = GENERATED.sub(lambda match: doc_pages.blanked("", match), self.texts[page])
        is_formula = False
        for number, line in enumerate(doc_pages.without_fences(text).split("\n"), 1):
            was_formula = is_formula
            is_formula ^= line.count("$$") % 2 == 1
            if len(line) <= MOST_COLUMNS or was_formula or line.lstrip(" >").startswith(("|", "$$", "<")):
                continue
            words = re.sub(r"^[ >]*([-*+]|\d+[.)])? +", "", line).split()
            if len(words) > 1:
                self.fail(page, number, f"{len(line)} characters; a line has at most {MOST_COLUMNS}")

    def check(self):
        for page, text in self.texts.items():
            self.check_links(page)
            self.check_formulas(page)
            if page.startswith("docs/") and page not in doc_pages.RESULT_PAGES:
                self.check_length(page)
                self.check_columns(page)
        for page, text in self.texts.items():
            if page.startswith("docs/") and page not in self.linked and not doc_pages.is_stub(text):
                self.fail(page, 1, "no page links to this page")
        return sorted(self.mistakes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=doc_pages.ROOT, help="of the repository [this one]")
    arguments = parser.parse_args()
    checker = Checker(arguments.root.resolve())
    mistakes = checker.check()
    for page, line, text in mistakes:
        print(f"{page}:{line}: {text}", file=sys.stderr)
    print(f"check_docs: {len(checker.texts)} pages, {len(mistakes)} mistakes")
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
