#!/usr/bin/env python3
"""Runs the commands that the documentation prints, as far as they need nothing but this repository.

Usage: scripts/docs_commands.py PROGRAM [PAGE.md ... | help]; without pages: all but CHANGELOG.md, which
tells of earlier versions, and what PROGRAM's own --help prints; `help`: this alone.

Each fenced block ```sh of a page is run by bash, one after another, in a folder of the page's own that shows the
repository's scenes, docs and so on. There `kaustik` is PROGRAM with its work made short (shortened() below says how), so that
files, options and their values are what is checked, not how pictures look. HTML comments before a block, which readers do
not see:

    <!-- given: cp scenes/cornell_spheres/cornell_spheres.xml scene.xml -->    commands that make what the block takes for granted
    <!-- not run: needs root -->                                               and why

Of blocks that are not run and of commands within text it is looked up whether there is what they name: of `kaustik …` the
subcommands and options in --help, of `make …` the targets in the Makefile, of other programs (`build/release/…`, `…_tool`,
`…_bench`) their sources, of `scripts/…` the files, and of both the options in their text, of `--preset` the presets. In
--help commands stand in lines of their own, or at the end of a sentence after a colon; these run, with a scene.xml, an
a.exr and a b.exr. All others are looked up. Exits with 1 if anything is wrong.
"""
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ("*.md", "docs/**/*.md", "scenes/**/*.md", "benchmarks/**/*.md", "data/*.md", "examples/**/*.md", "contrib/**/*.md",
         "tests/**/*.md")
SIZE = 24  # of pictures
MOST_PASSES = 2
MOST_SECONDS = 0.2
MOST_PHOTONS = 20000
BLOCK_SECONDS = 120  # then something hangs
# What examples of --help take for granted.
HELP_GIVEN = r"""
sed '/<integrator/,/<.integrator>/d; /"size"/s/400/800/; s|"meshes/|"scenes/metal_ring/meshes/|' scenes/metal_ring/metal_ring.xml >scene.xml
kaustik render scene.xml -o a.exr; cp a.exr b.exr; mkdir -p pictures"""


class Block:
    def __init__(self, page, line, language, given, reason):
        self.page, self.line, self.language = page, line, language
        self.given, self.reason = given, reason  # reason: of not being run, or None
        self.lines = []

    def place(self):
        return f"{self.page}:{self.line}"


def blocks_and_text(page, text):
    """All fenced blocks, and (line number, line) of everything else."""
    blocks, prose, given, reason, block = [], [], [], None, None
    # A comment may go over several lines; it counts where it begins.
    lines = iter(enumerate(text.splitlines(), 1))
    for number, line in lines:
        fence = re.match(r"\s*```(\w*)", line)
        if block is not None:
            if fence:
                blocks.append(block)
                block = None
            else:
                block.lines.append(line)
            continue
        if fence:
            block = Block(page, number, fence[1], given, reason)
            given, reason = [], None
            continue
        if line.lstrip().startswith("<!--"):
            while "-->" not in line:
                line += "\n" + next(lines)[1]
            comment = re.match(r"\s*<!--\s*(given|not run):\s*(.*?)\s*-->", line, re.DOTALL)
            if comment and comment[1] == "given":
                given.append(comment[2])
            elif comment:
                reason = comment[2]
        prose.append((number, line))
    return blocks, prose


def limited(value, most):
    try:
        return str(min(int(value), most))
    except ValueError:
        return value  # the program says what is wrong with it


def shortened_time(value):
    is_time = re.fullmatch(r"\d+(\.\d+)?|(\d+(\.\d+)?(h|min|m|s))+", value)
    return f"{MOST_SECONDS}s" if is_time and re.search("[1-9]", value) else value


def shortened(arguments):
    """The same command with less to do: a small picture, one sample per pixel and pass, few passes, few photons."""
    command = arguments[0] if arguments else ""
    if command not in ("render", "resume", "learn", "photons") or "--help" in arguments:
        return arguments
    result, passes, is_limited = [], 1, False
    values = iter(arguments)
    for argument in values:
        result.append(argument)
        if argument in ("--passes", "--spp", "--time", "--set"):
            value = next(values, None)
            if value is None:
                break
            if argument == "--passes":
                value = limited(value, MOST_PASSES)
                passes = int(value) if value.isdigit() else passes
            if argument == "--time":
                value = shortened_time(value)
            if argument == "--set":
                photons = re.fullmatch(r"(integrator\.\w+_photons=)(\d+)", value)
                value = photons[1] + limited(photons[2], MOST_PHOTONS) if photons else value
            is_limited = is_limited or argument != "--set"
            result.append(value)
    if command == "photons":
        return result
    if command in ("render", "learn"):
        # Crop windows stay what they are, in a narrow picture.
        crops = " ".join(result)
        if "film.crop_offset_x" not in crops and "film.crop_width" not in crops:
            result += ["--set", f"film.width={SIZE}"]
        if "film.crop_offset_y" not in crops and "film.crop_height" not in crops:
            result += ["--set", f"film.height={SIZE}"]
    if "--spp" in result:
        at = result.index("--spp") + 1
        result[at] = limited(result[at], passes)
    elif not is_limited or ("--passes" in result and command != "resume"):
        result += ["--spp", str(passes)]
    return result if is_limited or command == "resume" else result + ["--passes", "1"]


class Program:
    """What the built program says of itself."""

    def __init__(self, path):
        self.path = path
        self.options = {}
        general = self.help([])
        self.commands = re.findall(r"^  (\w+)  ", general, re.MULTILINE)
        if not self.commands:
            sys.exit(f"docs_commands: {path} --help lists no commands")

    def help(self, arguments):
        return self.output([*arguments, "--help"])

    def output(self, arguments):
        return subprocess.run([self.path, *arguments], capture_output=True, text=True).stdout

    def options_of(self, command):
        if command not in self.options:
            self.options[command] = set(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", self.help([command])))
        return self.options[command]

    def complaint(self, words):
        """What is wrong with a mention: the words after `kaustik`; None: nothing."""
        if not words or words[0] in ("--help", "--version", "help", "…"):
            return None
        if words[0] not in self.commands:
            return f"there is no 'kaustik {words[0]}'"
        for word in words[1:]:
            option = word.split("=")[0]
            if re.match(r"--?[a-zA-Z]", option) and option not in self.options_of(words[0]):
                return f"'kaustik {words[0]}' has no option {option}"
        return None


class Sources:
    """What the repository has beside the program: targets, presets, programs, scripts."""

    def __init__(self):
        phony = re.search(r"^\.PHONY:(.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
        self.targets = set(phony[1].split())
        presets = json.loads((ROOT / "CMakePresets.json").read_text())
        self.presets = {preset["name"] for kind, list_ in presets.items() if kind.endswith("Presets") for preset in list_}
        self.programs = {}  # name: its sources
        for path in [ROOT / "apps", ROOT / "tests", ROOT / "benchmarks", ROOT / "scenes"]:
            for cmake in path.glob("**/CMakeLists.txt"):
                for name in re.findall(r"add_executable\((\w+)", cmake.read_text()):
                    self.programs[name] = list(cmake.parent.glob("**/*.cpp"))
        for source in [*ROOT.glob("benchmarks/*_bench.cpp"), *ROOT.glob("benchmarks/*_tool.cpp")]:
            self.programs[source.stem] = [source]
        for room in (ROOT / "tests").iterdir():
            if room.is_dir():
                self.programs["test_" + room.name] = None  # GoogleTest knows its options

    def complaint(self, words):
        """What is wrong with a command of another program than kaustik; None: nothing."""
        command = pathlib.PurePath(words[0])
        if command.name == "make":
            unknown = [word for word in words[1:] if re.fullmatch(r"[a-z-]+", word) and word not in self.targets]
            return f"the Makefile has no target '{unknown[0]}'" if unknown else None
        if command.name in ("cmake", "ctest"):
            named = [words[at + 1] for at, word in enumerate(words[:-1]) if word == "--preset"]
            unknown = [name for name in named if name not in self.presets]
            return f"there is no preset '{unknown[0]}'" if unknown else None
        if command.parts[0] in ("scripts", ".ci"):
            files = [ROOT / command]
            if not files[0].is_file():
                return f"there is no {command}"
            if files[0].read_text().startswith("#!") and not os.access(files[0], os.X_OK):
                return f"{command} cannot be run"
        else:
            if command.parts[0] == "build" and command.parts[1] not in self.presets:
                return f"no preset builds into {command.parent}"
            if command.name == "kaustik" or command.name.isupper():  # build/release/benchmarks/NAME
                return None
            if command.name not in self.programs:
                return f"there is no program '{command.name}'"
            files = self.programs[command.name]
        for word in words[1:]:
            option = re.match(r"--[a-z][\w-]*", word)
            if option and option[0] != "--help" and files is not None and not any(option[0] in file.read_text() for file in files):
                return f"'{command.name}' knows no option {option[0]}"
        return None


def is_command(word):
    return word in ("kaustik", "make", "cmake", "ctest") or re.match(
        r"(build/\w+/[\w/]+|scripts/[\w.]+|\.ci/\w+|\w+_(tool|bench))$", word)


def commands_in(text):
    """Simple commands of a piece of shell: lists of words."""
    for part in re.split(r"\n|\||&&|;", text.replace("\\\n", " ")):
        try:
            words = shlex.split(part, comments=True)
        except ValueError:
            continue
        for at, word in enumerate(words):
            if is_command(word):
                yield words[at:]
                break


def mention_complaints(program, sources, text):
    for words in commands_in(text):
        is_kaustik = pathlib.PurePath(words[0]).name == "kaustik"
        complaint = program.complaint(words[1:]) if is_kaustik else None
        complaint = complaint or (sources.complaint(words) if words[0] != "kaustik" else None)
        if complaint:
            yield complaint


def show(folder, work):
    for entry in folder.iterdir():
        if not entry.name.startswith(".") and entry.name not in ("out", "build"):
            (work / entry.name).symlink_to(entry)


def prepare_folder(folder, page, program):
    """The repository's folders as the page sees them; pages of scenes see the scene's files."""
    (folder / "bin").mkdir()
    work = folder / "work"
    work.mkdir()
    wrapper = folder / "bin" / "kaustik"
    wrapper.write_text("#!/bin/sh\nexec " + shlex.join(
        [sys.executable, str(pathlib.Path(__file__).resolve()), "--as-kaustik", program.path]) + ' "$@"\n')
    wrapper.chmod(0o755)
    show(ROOT, work)
    parts = pathlib.Path(page).parts
    if parts[0] != "scenes":
        return work
    # The page's own folder and those above it are real ones, so that its commands write nothing into the repository.
    for depth in range(1, len(parts)):
        inner = work.joinpath(*parts[:depth])
        inner.unlink()
        inner.mkdir()
        show(ROOT.joinpath(*parts[:depth]), inner)
    return work.joinpath(*parts[:-1])


def run_block(block, folder, work):
    script = "\n".join([*block.given, *block.lines])
    environment = dict(os.environ, PATH=f"{folder / 'bin'}:{os.environ['PATH']}")
    process = subprocess.Popen(["bash", "-euo", "pipefail", "-c", script], cwd=work, env=environment,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, errors="replace", start_new_session=True)
    try:
        output, _ = process.communicate(timeout=BLOCK_SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return f"took more than {BLOCK_SECONDS} s"
    return None if process.returncode == 0 else f"exit code {process.returncode}\n{output.strip()}"


class Report:
    def __init__(self):
        self.failures, self.commands, self.blocks, self.reasons, self.mentions, self.slowest = [], 0, 0, [], 0, []

    def fail(self, place, text):
        self.failures.append(f"{place}: {text}")


def check_page(page, program, sources, report):
    path = pathlib.Path(page)
    text = (path if path.is_absolute() else ROOT / path).read_text()
    blocks, prose = blocks_and_text(page, text)
    for number, line in prose:
        for code in re.findall(r"(?<!`)`([^`]+)`(?!`)", line):
            if is_command(code.split()[0] if code.split() else ""):
                report.mentions += 1
                for complaint in mention_complaints(program, sources, code):
                    report.fail(f"{page}:{number}", complaint)
    with tempfile.TemporaryDirectory() as name:
        folder, work = pathlib.Path(name), None
        for block in blocks:
            content = "\n".join(block.lines)
            if block.language != "sh":
                if re.match(r"\s*kaustik ", content):
                    report.fail(block.place(), "a block of commands does not say that it is: ```sh")
                continue
            if block.reason is not None:
                report.reasons.append(f"{block.place()}: {block.reason}")
                for complaint in mention_complaints(program, sources, content):
                    report.fail(block.place(), complaint)
                continue
            work = work or prepare_folder(folder, page, program)
            run_and_report(block, folder, work, report)


def run_and_report(block, folder, work, report):
    report.blocks += 1
    report.commands += sum(words[0] == "kaustik" for words in commands_in("\n".join(block.lines)))
    start = time.monotonic()
    failure = run_block(block, folder, work)
    report.slowest.append((time.monotonic() - start, block.place()))
    if failure:
        report.fail(block.place(), failure)


def check_help(program, report):
    """The examples that the program prints, and what else its help names."""
    texts = {" ".join(["kaustik", *words, "--help"]): program.help(words) for words in [[], *([c] for c in program.commands)]}
    texts["kaustik help thesis"] = program.output(["help", "thesis"])
    examples = {}  # most commands end with the same words
    for page, text in texts.items():
        block = Block(page, 0, "sh", ["SCENE=scene.xml"], None)
        for number, line in enumerate(text.splitlines(), 1):
            example = re.match(r"\s+((?:env (?:\S+=\S* )+)?kaustik .*)", line) or \
                (re.match(r"[A-Z][^:]*: (kaustik .+?)\.?$", line) if number > 2 else None)
            if example:
                block.line = block.line or number
                block.lines.append(example[1].replace("SCENE", "$SCENE"))
                continue
            for mention in re.findall(r"(?<!Usage: )\bkaustik (?!\[)[a-z][^:;,).]*", line):
                report.mentions += 1
                complaint = program.complaint(mention.split()[1:2] + re.findall(r" (--?[a-z][\w-]*)", mention))
                # "pixels that kaustik rendered"
                if complaint and not re.match(r"kaustik \w+ed\b", mention):
                    report.fail(f"{page}:{number}", complaint)
        if block.lines:
            examples.setdefault("\n".join(block.lines), block)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        work = prepare_folder(folder, "help", program)
        given = Block("help", 0, "sh", [HELP_GIVEN], None)
        for block in [given, *examples.values()]:
            run_and_report(block, folder, work, report)


def main(arguments):
    if len(arguments) >= 2 and arguments[0] == "--as-kaustik":
        os.execv(arguments[1], [arguments[1], *shortened(arguments[2:])])
    if not arguments:
        sys.exit(__doc__)
    pages = arguments[1:] or sorted(
        str(page.relative_to(ROOT)) for pattern in PAGES for page in ROOT.glob(pattern) if page.name != "CHANGELOG.md")
    program = Program(str(pathlib.Path(arguments[0]).resolve()))
    report, sources = Report(), Sources()
    for page in pages:
        if page != "help":
            check_page(page, program, sources, report)
    if len(arguments) == 1 or "help" in pages:
        check_help(program, report)
    for seconds, place in sorted(report.slowest, reverse=True)[:3]:
        print(f"{seconds:.1f} s: {place}")
    print(f"{report.blocks} blocks run, with {report.commands} commands of kaustik; {report.mentions} mentions looked up; "
          f"{len(report.reasons)} blocks not run:")
    for reason in report.reasons:
        print("  " + reason)
    for failure in report.failures:
        print(failure, file=sys.stderr)
    return 1 if report.failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
