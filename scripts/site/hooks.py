"""What makes a site of pages that are written for GitHub. mkdocs.yml names this file; scripts/build_site.sh uses it.

- Links out of docs/ stay within the site: pages of the repository (README.md, scenes/…/README.md) become pages under
  repository/, sources and scene files are shown there with their colours, folders as lists, all else is copied.
- Markdown that GitHub and Python-Markdown read differently (lists, tables, comments) is brought into the form of the latter.
- Entries `FOLDER/*` of the navigation stand for the pages of the folder that are named nowhere else.
- Anchors are GitHub's.
"""
import json
import logging
import pathlib
import posixpath
import re
import sys

from mkdocs.structure.files import File
from mkdocs.structure.nav import Link

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import doc_pages  # noqa: E402

log = logging.getLogger("mkdocs.site")
ROOT = doc_pages.ROOT
REPOSITORY = "repository/"
LANGUAGES = {".xml": "xml", ".cpp": "cpp", ".h": "cpp", ".py": "python", ".sh": "bash", ".awk": "awk", ".ts": "typescript",
             ".mjs": "javascript", ".json": "json", ".txt": "text", ".yml": "yaml", ".toml": "toml", ".bib": "bibtex", ".cmake": "cmake"}
MOST_SHOWN = 400_000  # bytes of a source
SOURCE = re.compile(r"[\w.-]+(?:/[\w.-]+)+\.\w+")
SOURCE_FOLDERS = ("", "src/kaustik/", "tests/")  # pages name files from these
ASSETS = {"scripts/site/site.css": "assets/site.css", "scripts/site/formulas.js": "assets/formulas.js",
          "apps/view/src/icon.svg": "assets/icon.svg"}
MATHJAX = ROOT / "build/site_packages/node_modules/mathjax/es5/tex-svg-full.js"

slugs = doc_pages.Slugs()
shown = {}  # path in the site (….md) of a page that is made here: path in the repository


# Paths


def place_in_repository(uri):
    """Of a page of the site: where its text is in the repository, as links within it see it."""
    if uri in shown:
        return shown[uri]
    return uri.removeprefix(REPOSITORY) if uri.startswith(REPOSITORY) else "docs/" + uri


def language_of(path):
    if path.name in ("CMakeLists.txt", "Makefile", "Doxyfile"):
        return {"CMakeLists.txt": "cmake", "Makefile": "make", "Doxyfile": "text"}[path.name]
    return LANGUAGES.get(path.suffix)


def place_in_site(path):
    """(path in the site, kind) of a file or folder of the repository; None: there is no such thing.

    Kinds: a "page", a "source" or "folder" of which a page is made here, a "copy".
    """
    file = ROOT / path
    uri = path.removeprefix("docs/") if path.startswith("docs/") else REPOSITORY + path
    if file.is_dir():
        for index in ("index.md", "README.md"):
            if (file / index).exists():
                return posixpath.join(uri, index), "page"
        return posixpath.join(uri, "index.md"), "folder"
    if not file.exists():
        return None
    if file.suffix == ".md":
        return uri, "page"
    if language_of(file) and file.stat().st_size <= MOST_SHOWN:
        return uri + ".md", "source"
    return uri, "copy"


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


# Pages that the repository does not have as pages


def shown_folder(path):
    lines = [f"# {path}", ""]
    for entry in sorted((ROOT / path).iterdir(), key=lambda entry: (entry.is_file(), entry.name)):
        if not entry.name.startswith("."):
            lines.append(f"- [{entry.name}{'/' if entry.is_dir() else ''}]({entry.name})")
    return "\n".join(lines)


def shown_source(path):
    text = read(path)
    fence = "`" * max(3, 1 + max((len(run) for run in re.findall(r"`+", text)), default=0))
    return (f"# {path}\n\n[Download]({posixpath.basename(path)}){{ download }}\n\n"
            f"{fence}{language_of(ROOT / path)}\n{text.rstrip()}\n{fence}\n")


def text_of(uri):
    """What stands in a page of the site before for_python_markdown()."""
    path = place_in_repository(uri)
    if uri not in shown:
        return read(path)
    return shown_folder(path) if (ROOT / path).is_dir() else shown_source(path)


def mentioned(code):
    """The file that code within text names, such as `transport/component.h`; None if it is none."""
    if SOURCE.fullmatch(code):
        for folder in SOURCE_FOLDERS:
            file = ROOT / folder / code
            if file.is_file() and language_of(file):
                return folder + code
    return None


def mentions(text):
    """(start, end, path) of sources that are named in code that is no link."""
    prose = doc_pages.without_fences(text)
    links = [match.span() for match in doc_pages.LINK.finditer(doc_pages.prose_of(text))]
    for match in doc_pages.CODE.finditer(prose):
        path = mentioned(match[2])
        if path and not in_heading(text, match.start()):
            if not any(start <= match.start() < end for start, end in links):
                yield match.start(), match.end(), path


def in_heading(text, position):
    return text[text.rfind("\n", 0, position) + 1:].lstrip().startswith("#")


def targets(uri):
    """Everything of the repository to which a page leads."""
    text, page = text_of(uri), place_in_repository(uri)
    if uri in shown and (ROOT / page).is_dir():
        page += "/index.md"
    elif uri in shown:
        return  # a source names itself only
    for link in doc_pages.links_of(text):
        if not doc_pages.is_outside(link.target):
            yield doc_pages.resolved(page, link.target)[0]
    for _, _, path in mentions(text):
        yield path


def new_file(uri, config):
    return File(uri, config["docs_dir"], config["site_dir"], config["use_directory_urls"])


def add_file(files, uri, source, config):
    """A file of the site that lies outside docs/."""
    file = new_file(uri, config)
    file.abs_src_path = str(source)
    files.append(file)


def on_files(files, config):
    shown.clear()
    known = set(files.src_uris)

    def add(uri, source):
        if uri not in known:
            known.add(uri)
            add_file(files, uri, source, config)

    waiting = [file.src_uri for file in files.documentation_pages()]
    waiting += [uri for uri in nav_paths(config["nav"]) if uri.startswith(REPOSITORY)]
    seen = set()
    for uri in waiting:  # which grows
        if uri in seen:
            continue
        seen.add(uri)
        add(uri, ROOT / place_in_repository(uri))
        for path in targets(uri):
            place = None if path.startswith("..") else place_in_site(path)
            if not place:
                continue  # with_links() or mkdocs complains
            target, kind = place
            if kind == "copy":
                add(target, ROOT / path)
                continue
            if kind != "page":
                shown[target] = path
            if kind == "source":
                add(target.removesuffix(".md"), ROOT / path)  # to download
            waiting.append(target)
    for name, uri in ASSETS.items():
        add(uri, ROOT / name)
    if MATHJAX.exists():
        add("assets/mathjax.js", MATHJAX)
    else:
        log.warning(f"no {MATHJAX.relative_to(ROOT)}: scripts/build_site.sh installs it")
    return files


# Navigation


def nav_paths(nav):
    for entry in nav:
        if isinstance(entry, dict):
            for value in entry.values():
                yield from nav_paths(value if isinstance(value, list) else [value])
        else:
            yield entry


def expanded(nav, named):
    """The same with the pages of a folder for `FOLDER/*`, except those that are named."""
    result = []
    for entry in nav:
        if isinstance(entry, dict):
            (title, value), = entry.items()
            result.append({title: expanded(value, named) if isinstance(value, list) else value})
        elif entry.endswith("/*"):
            pages = sorted((ROOT / "docs" / entry[:-2]).glob("*.md"))
            uris = [path.relative_to(ROOT / "docs").as_posix() for path in pages if not doc_pages.is_stub(path.read_text())]
            result += [uri for uri in uris if uri not in named]
        else:
            result.append(entry)
    return result


def on_config(config):
    config["nav"] = expanded(config["nav"], set(nav_paths(config["nav"])))
    config["mdx_configs"].setdefault("toc", {})["slugify"] = lambda text, separator: slugs(text, separator)
    return config


def on_nav(nav, config, files):
    """The C++ interface is made by Doxygen afterwards, so mkdocs doesn't know of it."""
    for section in nav.items:
        if section.is_section and section.title == "Reference":
            link = Link("C++ interface", "api/index.html")
            link.parent = section
            section.children.append(link)
    named = set(nav_paths(config["nav"]))
    for file in files.documentation_pages():
        uri = file.src_uri
        if not uri.startswith(REPOSITORY) and uri not in shown and uri not in named and not doc_pages.is_stub(text_of(uri)):
            log.warning(f"docs/{uri} is not in the navigation of mkdocs.yml")
    return nav


# Text


def with_links(text, file, files):
    """Links out of docs/ and to folders, as links within the site."""
    uri = file.src_uri
    page = place_in_repository(uri)
    base = page + "/index.md" if uri in shown and (ROOT / page).is_dir() else page
    changes = []
    for link in doc_pages.links_of(text):
        if doc_pages.is_outside(link.target) or link.target.startswith("#"):
            continue
        path, anchor = doc_pages.resolved(base, link.target)
        place, _ = (None if path.startswith("..") else place_in_site(path)) or (None, None)
        if uri in shown and path == page:
            place = uri.removesuffix(".md")  # the file itself, to download
        target = files.get_file_from_path(place) if place else None
        if not target:
            if link.is_html or "." not in posixpath.basename(path):  # of others mkdocs complains itself
                log.warning(f"{page}: dead link {link.target}")
            continue
        if link.is_html:
            address = target.url_relative_to(file)
        else:
            address = posixpath.relpath(place, posixpath.dirname(uri) or ".")
        changes.append((link.start, link.end, address + ("#" + anchor if anchor else "")))
    for start, end, path in mentions(text):
        place, _ = place_in_site(path)
        if path != page and files.get_file_from_path(place):
            address = posixpath.relpath(place, posixpath.dirname(uri) or ".")
            changes.append((start, end, f"[{text[start:end]}]({address})"))
    for start, end, new in sorted(changes, reverse=True):
        text = text[:start] + new + text[end:]
    return text


ITEM = re.compile(r"( *)([-*+]|\d{1,9}[.)])( +)(?=\S)")
TABLE_RULE = re.compile(r" {0,3}\|?\s*:?-+:?\s*(\|\s*:?-+:?\s*)+\|?\s*$")


def for_python_markdown(text):
    """Lists indented by fours, blank lines before lists and tables, no comments."""
    text = doc_pages.COMMENT.sub(lambda match: "" if is_prose(text, match.start()) else match[0], text)
    lines, result = text.split("\n"), []
    stack, fence = [], None  # of lists: the columns where the items' texts begin

    def put(line, column):
        """A line within the innermost item, which took off `column` columns."""
        kept = line[min(column, len(line) - len(line.lstrip(" "))):]
        result.append("    " * len(stack) + kept if kept.strip() else "")

    for at, line in enumerate(lines):
        mark = doc_pages.FENCE.match(line)
        if fence is not None:
            put(line, stack[-1] if stack else 0)
            if mark and mark[1].startswith(fence) and not line.replace(mark[1], "").strip(" >"):
                fence = None
                result.append("")
            continue
        if not line.strip():
            result.append("")
            continue
        indent = len(line) - len(line.lstrip(" "))
        item = ITEM.match(line)
        after_blank = not result or not result[-1].strip()
        if item and not stack and not after_blank and item[2][:-1].isdigit() and int(item[2][:-1]) != 1:
            item = None  # such a number can't interrupt a paragraph
        if item or after_blank or mark or line.startswith("#"):
            while stack and indent < stack[-1]:
                stack.pop()
        if item:
            if not stack and not after_blank and not ITEM.match(lines[at - 1]) and not is_in_list(lines, at):
                result.append("")
            marker = item[2][:-1] + "." if item[2].endswith(")") else item[2]
            put(line[len(item[1]):].replace(item[2] + item[3], marker + " ", 1), 0)
            stack.append(item.end())
            continue
        if at + 1 < len(lines) and "|" in line and TABLE_RULE.match(lines[at + 1]) and not after_blank:
            result.append("")
        if mark:
            fence = mark[1]
            if not after_blank:
                result.append("")
        put(line, stack[-1] if stack else 0)
    return "\n".join(result)


def is_in_list(lines, at):
    """Whether the paragraph above a line belongs to an item."""
    for line in reversed(lines[:at]):
        if not line.strip():
            return False
        if ITEM.match(line):
            return True
    return False


def is_prose(text, position):
    return doc_pages.without_fences(text[:position] + "x")[-1] == "x"


def on_page_read_source(page, config):
    return text_of(page.file.src_uri) if page.file.src_uri.startswith(REPOSITORY) or page.file.src_uri in shown else None


def on_page_markdown(markdown, page, config, files):
    slugs.__init__()
    page.title = doc_pages.plain(page.title) if page.title else page.title
    if page.is_homepage:
        page.meta["hide"] = ["navigation"]
    if page.file.src_uri in shown and (ROOT / shown[page.file.src_uri]).is_file():
        return with_links(markdown, page.file, files)
    return for_python_markdown(with_links(markdown, page.file, files))


def with_labels(table):
    """A table of parameters or options whose cells say what they are: on phones they stand in lines."""
    heads = re.findall(r"<th[^>]*>(.*?)</th>", table)
    if len(heads) < 3 or heads[-1] != "Meaning" or heads[0] not in ("Name", "Option", "Argument"):
        return f'<div class="table">{table}</div>'

    def row(match):
        cells = iter(heads)
        return re.sub(r"<td([^>]*)>", lambda cell: labelled(cell, next(cells)), match[0])

    def labelled(cell, head):
        label = {"Default": "default", "Range or choices": "range"}.get(head)
        shown_label = f' data-label="{label}"' if label else ' data-label=""' if head in ("Kind", "Value") else ""
        return f"<td{cell[1]}{shown_label}>"

    return f'<div class="table parameters">{re.sub(r"<tr>.*?</tr>", row, table, flags=re.DOTALL)}</div>'


def on_page_content(html, page, config, files):
    """Tables scroll by themselves on narrow screens."""
    return re.sub(r"<table>.*?</table>", lambda match: with_labels(match[0]), html, flags=re.DOTALL)


def on_post_page(output, page, config):
    """Without the theme's indentation, which is most of a page: hundreds of entries of the navigation."""
    parts = re.split(r"(<(pre|script|textarea)\b.*?</\2>)", output, flags=re.DOTALL)
    parts[::3] = [re.sub(r"\s*\n\s*", "\n", part) for part in parts[::3]]
    del parts[2::3]
    return "".join(parts)


def on_post_build(config):
    """Sources and pages that have moved are not what a search looks for."""
    path = pathlib.Path(config["site_dir"]) / "search/search_index.json"
    index = json.loads(path.read_text())
    hidden = {uri.removesuffix('.md') for uri in shown}
    hidden |= {uri[:-3] for uri in (page.removeprefix("docs/") for page in doc_pages.pages() if page.startswith("docs/"))
               if doc_pages.is_stub(read("docs/" + uri))}
    index["docs"] = [entry for entry in index["docs"] if entry["location"].split("#")[0].removesuffix(".html") not in hidden]
    path.write_text(json.dumps(index, separators=(",", ":"), sort_keys=True))
