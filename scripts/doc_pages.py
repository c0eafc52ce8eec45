"""What the scripts that read Markdown pages have in common: which pages there are, their links, headings and addresses.

GitHub and the site must agree about pages, so both scripts/check_docs.py and scripts/site/hooks.py read them through this.
"""
import collections
import pathlib
import re
import unicodedata
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ("*.md", "docs/**/*.md", "scenes/**/*.md", "benchmarks/**/*.md", "data/*.md", "examples/**/*.md", "contrib/**/*.md",
         "tests/**/*.md")
# Written by commands: docs/developer/benchmarks.md says by which.
RESULT_PAGES = {"docs/comparisons.md", "docs/ablation.md", "docs/sensitivity.md", "docs/gallery.md", "docs/thesis/results.md",
                "docs/thesis/walkthrough.md", "docs/scenes.md"}

FENCE = re.compile(r"^[ >]*(`{3,}|~{3,})")
CODE = re.compile(r"(?<!`)(`+)(?!`)(.+?)(?<!`)\1(?!`)", re.DOTALL)
LINK = re.compile(r"(!?)\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]*)>?(?:\s+\"[^\"]*\")?\s*\)")
PICTURE_IN_LINK = re.compile(r"!\[[^\]]*\]\(\s*<?([^)\s>]*)>?\s*\)(?=\]\()")
DEFINITION = re.compile(r"^ {0,3}\[[^\]]+\]:\s*<?(\S+?)>?(?:\s+\"[^\"]*\")?\s*$", re.MULTILINE)
ATTRIBUTE = re.compile(r"<(a|img|source|video)\b[^>]*?\b(?:href|src)=\"([^\"]*)\"")
NAME = re.compile(r"<a\b[^>]*?\b(?:id|name)=\"([^\"]*)\"")
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)


def pages(root=ROOT):
    """Paths of all pages, relative to the root."""
    found = {path.relative_to(root).as_posix() for pattern in PAGES for path in root.glob(pattern)}
    return sorted(path for path in found if not path.startswith(("build/", "out/")))


def is_stub(text):
    """Whether a page only says where its text has gone."""
    return "\nThis page has moved:" in text


def blanked(text, match):
    return re.sub(r"[^\n]", " ", match[0] if match else text)


def without_fences(text):
    """The same text, of the same length and lines, with blanks for fenced blocks and comments."""
    result, fence = [], None
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if fence is None and mark:
            fence = mark[1]
            line = " " * len(line)
        elif fence is not None:
            if mark and mark[1].startswith(fence) and not line.replace(mark[1], "").strip(" >"):
                fence = None
            line = " " * len(line)
        result.append(line)
    return COMMENT.sub(lambda match: blanked("", match), "\n".join(result))


def prose_of(text):
    """Likewise, with blanks for code within lines, too; its backquotes stay."""
    def blank(match):
        inner = re.sub(r"[^\n]", " ", match[2])
        return match[1] + inner + match[1]
    return CODE.sub(blank, without_fences(text))


Link = collections.namedtuple("Link", "start end target is_picture is_html")


def links_of(text):
    """All links and pictures of a page: where their targets stand, and what they are."""
    prose = prose_of(text)
    found = {}
    for pattern, group, is_picture in ((PICTURE_IN_LINK, 1, True), (LINK, 2, None), (DEFINITION, 1, False)):
        for match in pattern.finditer(prose):
            picture = match[1] == "!" if is_picture is None else is_picture
            found.setdefault(match.start(group), Link(*match.span(group), match[group], picture, False))
    for match in ATTRIBUTE.finditer(prose):
        found.setdefault(match.start(2), Link(*match.span(2), match[2], match[1] != "a", True))
    return [found[start] for start in sorted(found)]


def is_outside(target):
    """Whether a link leads to another host, or is no path at all."""
    return bool(re.match(r"[a-zA-Z][a-zA-Z0-9+.-]*:|//", target))


def resolved(page, target):
    """(path from the root, anchor) of a link in a page; the path may begin with '..'."""
    path, _, anchor = target.partition("#")
    path = urllib.parse.unquote(path)
    if not path:
        return page, anchor
    parts = []
    for part in (*pathlib.PurePosixPath(page).parent.parts, *path.split("/")):
        if part == ".." and parts and parts[-1] != "..":
            parts.pop()
        elif part not in ("", "."):
            parts.append(part)
    return "/".join(parts), anchor


def plain(markdown):
    """A heading as it is read: without marks, links as their texts."""
    text = re.sub(r"!?\[((?:[^\[\]]|\[[^\]]*\])*)\]\([^)]*\)", r"\1", markdown)
    text = re.sub(r"(?<![\w*])(\*{1,3})(?=\S)(.+?)(?<=\S)\1(?!\w)", r"\2", text)
    text = re.sub(r"`+", "", text)
    return re.sub(r"<[^>]*>", "", text).strip()


def slug(heading):
    """The anchor of a heading, by GitHub's rule; `heading` is plain text."""
    text = unicodedata.normalize("NFC", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


class Slugs:
    """Anchors of one page: headings that repeat are numbered."""

    def __init__(self):
        self.counts = {}

    def __call__(self, heading, separator="-"):
        base = result = slug(heading)
        while result in self.counts:
            self.counts[base] += 1
            result = f"{base}-{self.counts[base]}"
        self.counts[result] = 0
        return result


def headings(text):
    """(line, level, Markdown) of all headings."""
    for number, line in enumerate(without_fences(text).split("\n"), 1):
        if match := re.match(r" {0,3}(#{1,6})\s+(.*?)(?:\s+#+)?\s*$", line):
            yield number, len(match[1]), match[2]


def title_of(text):
    return next((plain(heading) for _, level, heading in headings(text) if level == 1), "")


def anchors(text):
    slugs = Slugs()
    return {slugs(plain(heading)) for _, _, heading in headings(text)} | set(NAME.findall(prose_of(text)))


def line_at(text, position):
    return text.count("\n", 0, position) + 1
