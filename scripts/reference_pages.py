#!/usr/bin/env python3
"""Writes the generated parts of docs/reference: tables of parameters, lists of types, list of families, options of commands.

Usage: scripts/reference_pages.py PROGRAM [--check]

Everything comes from `PROGRAM help`, `PROGRAM help FAMILY`, `PROGRAM --help` and `PROGRAM COMMAND --help`. What lies between
these lines is replaced:

    docs/reference/FAMILY/TYPE.md     <!-- parameters --> … <!-- end of parameters -->
    docs/reference/FAMILY/index.md    <!-- types --> … <!-- end of types -->
    docs/reference/index.md           <!-- families --> … <!-- end of families -->
    docs/reference/cli.md             <!-- commands --> … <!-- end of commands -->

All other text is written by hand and stays. A page that is missing is created, with a title, the program's sentence and the
picture of the gallery if there is one. --check writes nothing: it names every page that differs, every type without a page
and every page of parameters without a type, and exits with 1 if there are any.
"""

import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCE, PICTURES = ROOT / "docs/reference", ROOT / "docs/pictures/gallery"
MOST_CHOICES = 8  # more of them go below the table

# Title of a family's page, and what the list of families says.
FAMILIES = {
    "integrator": ("Integrators", "Rendering methods."),
    "shape": ("Shapes", "Meshes, analytic and procedural surfaces, groups and instances."),
    "bsdf": ("Materials", "How surfaces reflect and transmit."),
    "texture": ("Textures", "Colours and numbers that vary over a surface, and spectra."),
    "emitter": ("Lights", "Sources of light, surroundings, sun and sky."),
    "medium": ("Media", "Haze, smoke and liquids between surfaces."),
    "phase": ("Phase functions", "Directions into which a medium scatters."),
    "volume": ("Volumes", "Values in space, for media and textures."),
    "sensor": ("Cameras", "Cameras and meters."),
    "film": ("Films", "Size, crop window and layers of the picture."),
    "rfilter": ("Pixel filters", "Weights of samples around a pixel."),
    "sampler": ("Samplers", "Number of samples per pixel."),
    "tonemap": ("Tone mapping operators", "From radiance to the display."),
}
KINDS = ["boolean", "integer", "float or name (string)", "float", "string", "choice", "point or vector", "rgb or spectrum",
         "transform", "file name (string)", "array"]


class Parameter:
    def __init__(self, name, facts):
        """`facts`: what `kaustik help` prints in parentheses."""
        self.name, self.meaning, self.choices = name, "", []
        self.kind = next(kind for kind in KINDS if facts.startswith(kind))
        self.default, self.range = "", []
        facts = facts[len(self.kind):].removeprefix(", ")
        for origin in ("texture", "volume"):
            if re.search(rf"(^|, )or a {origin}$", facts):
                facts = facts[:-len(f"or a {origin}")].removesuffix(", ")
                self.kind += f", or a {origin}"
        extents = re.search(r"(\[[^]]*\]|of integers).*$", facts) if self.kind == "array" else None
        if extents:
            self.range.append(extents[0])
            facts = facts[:extents.start()].removesuffix(", ")
        for fact in facts.split(", ") if facts else []:
            if fact == "required":
                self.default = fact
            elif fact.startswith("default "):
                self.default = fact.removeprefix("default ")
            elif re.fullmatch(r"-?\d[\d.e+-]*", fact) and self.default:
                self.default += ", " + fact
            else:
                self.range.append(fact)  # "0 … 1", and a unit


class Type:
    def __init__(self, family, name):
        self.family, self.name, self.sentence = family, name, ""
        self.parameters, self.ignored = [], []

    def picture(self):
        path = PICTURES / f"{self.family}_{self.name}.jpg"
        return path if path.exists() else None


def output_of(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def types_of(program, family):
    """The family's types in the program's order."""
    found = []
    for line in output_of(program, "help", family).splitlines():
        if match := re.fullmatch(r'(\w+) type="(.*)"', line):
            found.append(Type(*match.groups()))
        elif match := re.fullmatch(r"  Accepted, no effect: (.*)", line):
            found[-1].ignored = match[1].split(", ")
        elif match := re.fullmatch(r"      One of: (.*)", line):
            found[-1].parameters[-1].choices = match[1].split(", ")
        elif match := re.fullmatch(r"      (.*)", line):
            found[-1].parameters[-1].meaning = match[1]
        elif found[-1:] and found[-1].sentence and (match := re.fullmatch(r"  (\S+) \((.*)\)", line)):
            found[-1].parameters.append(Parameter(*match.groups()))
        elif match := re.fullmatch(r"  (.*)", line):
            found[-1].sentence = match[1]
        elif line:
            sys.exit(f"reference_pages: 'kaustik help {family}' prints a line that this script does not know: {line}")
    return [type_ for type_ in found if type_.family == family]  # "volume" is a texture, too


def families_of(program):
    """{family: {name: its types}}: two for a name that Kaustik and other renderers have."""
    names = [line for line in output_of(program, "help").splitlines() if re.fullmatch(r"[a-z]+", line)]
    families = {}
    for family in names:
        of_name = {}
        for type_ in types_of(program, family):
            of_name.setdefault(type_.name, []).append(type_)
        families[family] = of_name
    return families


def escaped(text):
    return text.replace("|", r"\|").replace("<", "&lt;").replace("*", r"\*")


def code(text):
    return f"`{text}`"


def parameter_lines(type_):
    """The table of a type, and what follows it."""
    lines, after = [], []
    if type_.parameters:
        lines += ["| Name | Kind | Default | Range or choices | Meaning |", "|---|---|---|---|---|"]
    for parameter in type_.parameters:
        allowed = [escaped(fact) for fact in parameter.range]
        if 0 < len(parameter.choices) <= MOST_CHOICES:
            allowed.append(", ".join(code(choice) for choice in parameter.choices))
        elif parameter.choices:
            allowed.append("names below")
            after += ["", f"Names for {code(parameter.name)}: " + ", ".join(code(choice) for choice in parameter.choices) + "."]
        lines.append(f"| {code(parameter.name)} | {parameter.kind} | {escaped(parameter.default)} | {', '.join(allowed)} "
                     f"| {escaped(parameter.meaning)} |")
    if not type_.parameters:
        lines.append("No parameters of its own." if "takes the parameters of" in type_.sentence else "No parameters.")
    if type_.ignored:
        after += ["", "Accepted, no effect: " + ", ".join(code(name) for name in type_.ignored) + "."]
    return lines + after


def parameter_block(types):
    lines = parameter_lines(types[0])
    for type_ in types[1:]:
        lines += ["", escaped(type_.sentence), "", *parameter_lines(type_)]
    return lines


def types_block(of_name):
    with_pictures = any(types[0].picture() for types in of_name.values())
    lines = ["| Type | Meaning | Picture |", "|---|---|---|"] if with_pictures else ["| Type | Meaning |", "|---|---|"]
    for name, (type_, *_) in of_name.items():
        picture = type_.picture()
        image = f'<a href="{name}.md"><img src="../../pictures/gallery/{picture.name}" width="96" alt="{name}"></a>' if picture else ""
        lines.append(f"| [{code(name)}]({name}.md) | {escaped(type_.sentence)} |" + (f" {image} |" if with_pictures else ""))
    return lines


def families_block(families):
    lines = ["| Family | Meaning | Types |", "|---|---|---|"]
    for family, of_name in families.items():
        _, meaning = FAMILIES[family]
        types = ", ".join(f"[{code(name)}]({family}/{name}.md)" for name in of_name)
        lines.append(f"| [{code(family)}]({family}/index.md) | {meaning} | {types} |")
    return lines


def new_type_page(type_):
    lines = [f"# {type_.name}", "", escaped(type_.sentence), ""]
    if picture := type_.picture():
        scene = f"../../gallery/{picture.stem}.xml"
        lines += [f"[![{type_.name}](../../pictures/gallery/{picture.name})]({scene})", ""]
    return lines + ["## Parameters", "", "<!-- parameters -->", "<!-- end of parameters -->"]


class Command:
    """What `--help` says of the program or of one of its commands."""

    COLUMN = 30  # in bytes: there meanings begin

    def __init__(self, program, name):
        self.name, self.usage, self.sentence = name, "", ""
        self.entries = {"Positionals": [], "Options": [], "Exit codes": []}  # (what, meaning)
        self.groups = {}  # of commands, each as those above
        self.after, section = [], None
        for line in output_of(program, *name.split(), "--help").rstrip().splitlines():
            if line.startswith("Usage: "):
                self.usage = line.removeprefix("Usage: ")
            elif re.fullmatch(r"[A-Z][a-z ]+:", line):
                title = line.rstrip(":")
                section = self.entries[title] if title in self.entries else self.groups.setdefault(title, [])
            elif section is not None and line.startswith("  "):
                self.add_entry(section, line, is_wide=section is not self.entries["Exit codes"])
            elif not self.usage:
                self.sentence = line
            else:
                section = None
                self.after.append(line)

    def add_entry(self, entries, line, is_wide):
        if not is_wide:
            entries.append(line.split(None, 1))
        elif not line[:self.COLUMN].strip():
            entries[-1] = [" ".join(filter(None, entries[-1])), line.strip()]
        elif len(line.encode()) > self.COLUMN and line.encode()[self.COLUMN - 1:self.COLUMN] == b" ":
            entries.append([part.decode().strip() for part in (line.encode()[:self.COLUMN], line.encode()[self.COLUMN:])])
        else:
            entries.append([line.strip(), ""])

    def text_after(self, general):
        """Lines below the options, if they are the command's own."""
        return [] if self.after == general.after else "\n".join(self.after).strip().split("\n")


VALUES = {"INT": "integer", "UINT": "integer", "FLOAT": "number"}


def option_row(what, meaning):
    """A line of a table, of '-o,--output FILE ... REQUIRED' and its meaning."""
    notes = []
    for keyword, note in (("Needs", "needs"), ("Excludes", "not with")):
        if match := re.search(rf" {keyword}: (\S+)", what):
            notes.append(f"{note} {code(match[1])}")
            what = what.replace(match[0], "")
    if what.endswith(" REQUIRED"):
        notes.insert(0, "required")
        what = what.removesuffix(" REQUIRED")
    if what.endswith(" ..."):
        notes += ["repeatable"] if "may be repeated" not in meaning else []
        what = what.removesuffix(" ...")
    names, _, value = what.partition(" ")
    names, _, optional = names.partition("{")
    value, _, limits = value.partition(":") if "SIZE" not in value else ("SIZE", "", "")
    if re.fullmatch(r"[A-Z]+", limits):
        value, limits = f"{value}:{limits}", ""
    if optional:
        value = f"optional [{optional.rstrip('}')}]"
    elif "|" in value:
        value = ", ".join(code(choice) for choice in value.split("|"))
    elif value:
        value = VALUES.get(value, code(value)) + (f", {limits}" if limits else "")
    notes = f" ({', '.join(notes)})" if notes else ""
    return f"| {', '.join(code(name) for name in names.split(','))} | {value} | {escaped(meaning)}{notes} |"


def commands_block(program):
    """All commands with their options, and the exit codes."""
    general = Command(program, "")
    lines = [general.sentence]
    for title, commands in general.groups.items():
        lines += ["", f"| {title} | Meaning |", "|---|---|"]
        lines += [f"| [{code(name)}](#kaustik-{name}) | {escaped(meaning)} |" for name, meaning in commands]
    lines += ["", "| Exit code | Meaning |", "|---|---|"]
    lines += [f"| {number} | {escaped(meaning)} |" for number, meaning in general.entries["Exit codes"]]
    lines += ["", "## kaustik", *command_lines(general, general)]
    for name in [name for commands in general.groups.values() for name, _ in commands]:
        command = Command(program, name)
        lines += ["", f"## kaustik {name}", "", escaped(command.sentence), "", *command_lines(command, general)]
    return lines


def command_lines(command, general):
    """Usage, tables of arguments and options, and the command's own text."""
    lines = ["Usage: " + code(command.usage)] if command is not general else []
    for kind, title in (("Positionals", "Argument"), ("Options", "Option")):
        rows = [option_row(*entry) for entry in command.entries[kind] if not entry[0].startswith("-h,--help")]
        if rows:
            lines += ["", f"| {title} | Value | Meaning |", "|---|---|---|", *rows]
    is_code = False
    for line in command.text_after(general) if command is not general else []:
        if line.startswith("  ") != is_code:
            is_code = not is_code
            lines += ["", "<!-- not run: in --help, whose commands are run -->", "```sh"] if is_code else ["```", ""]
        elif line and not is_code:
            lines.append("")
        lines.append(line.removeprefix("  ") if is_code else escaped(line))
    return lines + ["```"] if is_code else lines


class Pages:
    """Writes blocks, or only compares them."""

    def __init__(self, is_check):
        self.is_check, self.complaints, self.written = is_check, [], 0

    def put(self, path, kind, block, new_page, what):
        """Makes `block` the lines between `<!-- kind -->` and `<!-- end of kind -->` of a page."""
        shown = path.relative_to(ROOT)
        if not path.exists() and self.is_check:
            self.complaints.append(f"{shown} is missing: the page of {what}")
            return
        found = path.read_text() if path.exists() else "\n".join(new_page) + "\n"
        first, last = f"<!-- {kind} -->\n", f"<!-- end of {kind} -->\n"
        if found.count(first) != 1 or found.count(last) != 1 or found.index(first) > found.index(last):
            self.complaints.append(f"{shown} has no block between the lines '{first[:-1]}' and '{last[:-1]}'")
            return
        before, after = found[:found.index(first)] + first, found[found.index(last):]
        # Blank lines, or comments would make the lines beside them part of themselves.
        page = before + "\n" + "\n".join(block) + "\n\n" + after
        if path.exists() and page == found:
            return
        if self.is_check:
            self.complaints.append(f"{shown} differs from what the program says")
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(page)
        self.written += 1

    def find_strays(self, families):
        """Pages with a table of parameters, but no type."""
        for path in sorted(REFERENCE.glob("*/*.md")):
            is_type = path.stem in families.get(path.parent.name, {})
            if path.stem != "index" and not is_type and "<!-- parameters -->" in path.read_text():
                self.complaints.append(f"{path.relative_to(ROOT)} is the page of no type")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="kaustik")
    parser.add_argument("--check", action="store_true", help="write nothing, exit with 1 if a page differs")
    arguments = parser.parse_args()
    if not pathlib.Path(arguments.program).is_file():
        sys.exit(f"there is no program {arguments.program}\n  remedy: build it: make build")
    families = families_of(arguments.program)
    if unknown := [family for family in families if family not in FAMILIES]:
        sys.exit(f"reference_pages: FAMILIES in this script lacks {', '.join(unknown)}")
    pages = Pages(arguments.check)
    for family, of_name in families.items():
        for name, types in of_name.items():
            pages.put(REFERENCE / family / f"{name}.md", "parameters", parameter_block(types), new_type_page(types[0]),
                      f"{family} '{name}'")
        title, meaning = FAMILIES[family]
        new_page = [f"# {title}", "", meaning, "", "<!-- types -->", "<!-- end of types -->"]
        pages.put(REFERENCE / family / "index.md", "types", types_block(of_name), new_page, f"family '{family}'")
    new_page = ["# Reference", "", "All families of types, with every parameter.", "", "<!-- families -->", "<!-- end of families -->"]
    pages.put(REFERENCE / "index.md", "families", families_block(families), new_page, "all families")
    new_page = ["# Commands", "", "All commands of the program, with every option.", "", "<!-- commands -->",
                "<!-- end of commands -->"]
    pages.put(REFERENCE / "cli.md", "commands", commands_block(arguments.program), new_page, "the commands")
    pages.find_strays(families)
    for complaint in pages.complaints:
        print(complaint, file=sys.stderr)
    if arguments.check and pages.complaints:
        print(f"remedy: scripts/reference_pages.py {arguments.program}, which `make docs` runs", file=sys.stderr)
    if not arguments.check:
        print(f"{pages.written} pages written")
    return 1 if pages.complaints else 0


if __name__ == "__main__":
    sys.exit(main())
