#!/usr/bin/env python3
"""Looks at the files of contrib/ that a parser of this machine reads. Usage: contrib_check.py CONTRIB. Without PyYAML the
manifests are not looked at."""
import ast
import json
import os
import pathlib
import re
import sys
import types

CONTRIB = pathlib.Path(sys.argv[1])
ROOT = CONTRIB.parent
mistakes = []


def check(is_right, what):
    if not is_right:
        mistakes.append(what)


def check_kubernetes(yaml):
    jobs = {path.stem: yaml.safe_load(path.read_text()) for path in sorted((CONTRIB / "kubernetes").glob("*.yaml"))}
    check(set(jobs) == {"learn", "parts", "merge"}, f"kubernetes: there are {sorted(jobs)}")
    for name, job in jobs.items():
        pod = job["spec"]["template"]["spec"]
        check(job["kind"] == "Job" and pod["restartPolicy"] == "Never", f"kubernetes/{name}.yaml is no job")
        resources = pod["containers"][0]["resources"]
        check(resources["requests"] == resources["limits"], f"kubernetes/{name}.yaml: requests are not the limits")
    spec = jobs["parts"]["spec"]
    command = spec["template"]["spec"]["containers"][0]["command"][2]
    parts = spec["completions"]
    check(f"/{parts} " in command, f"kubernetes/parts.yaml: --part is not of {parts}")
    check("exec kaustik" in command, "kubernetes/parts.yaml: the shell would get the signal")
    merge = jobs["merge"]["spec"]["template"]["spec"]["containers"][0]["command"][2]
    check(f" 1 {parts})" in merge, f"kubernetes/merge.yaml does not merge {parts} parts")
    actions = {code: rule["action"] for rule in spec["podFailurePolicy"]["rules"] if "onExitCodes" in rule
               for code in rule["onExitCodes"]["values"]}
    check(actions == {2: "FailIndex", 75: "Ignore"}, f"kubernetes/parts.yaml: exit codes {actions}")


def check_openjd(yaml):
    template = yaml.safe_load((CONTRIB / "openjd/kaustik.yaml").read_text())
    check(template["specificationVersion"] == "jobtemplate-2023-09", "openjd: another version")
    names = {f"Param.{parameter['name']}" for parameter in template["parameterDefinitions"]}
    steps = [step["name"] for step in template["steps"]]
    for step in template["steps"]:
        known = set(names)
        for parameter in step.get("parameterSpace", {}).get("taskParameterDefinitions", []):
            known.add(f"Task.Param.{parameter['name']}")
        for file in step["script"].get("embeddedFiles", []):
            known.add(f"Task.File.{file['name']}")
        used = set(re.findall(r"\{\{\s*([\w.]+)\s*\}\}", json.dumps(step)))
        check(used <= known, f"openjd: step {step['name']} uses {sorted(used - known)}")
        for dependency in step.get("dependencies", []):
            check(dependency["dependsOn"] in steps, f"openjd: no step {dependency['dependsOn']}")


def check_opencue():
    """Runs the outline with a stand-in for PyOutline."""
    layers = {}

    class Shell:
        def __init__(self, name, command, range, **more):
            layers[name] = (command, range)

        def depend_all(self, other):
            pass

    outline, modules, shell = (types.ModuleType(name) for name in ("outline", "outline.modules", "outline.modules.shell"))
    shell.Shell, modules.shell, outline.modules = Shell, shell, modules
    sys.modules.update({"outline": outline, "outline.modules": modules, "outline.modules.shell": shell})
    os.environ.update(KAUSTIK_SCENE="a.xml", KAUSTIK_FOLDER="out", KAUSTIK_PARTS="3", KAUSTIK_OPTIONS="--seed 7 --spp 9")
    text = (CONTRIB / "opencue/kaustik.outline").read_text()
    exec(compile(text, "kaustik.outline", "exec"), {"__name__": "outline_script"})
    check(layers["render"][1] == "1-3" and "#IFRAME#/3" in layers["render"][0], f"opencue: {layers['render']}")
    check("--spp" in layers["render"][0] and "--spp" not in layers["learn"][0], f"opencue: {layers['learn']}")
    check([f"out/part_{i}.kpt" in layers["merge"][0] for i in range(5)] == [False, True, True, True, False],
          f"opencue: {layers['merge']}")


def check_spack():
    recipe = (CONTRIB / "spack/packages/kaustik/package.py").read_text()
    ast.parse(recipe)
    dependencies = (ROOT / "cmake/dependencies.cmake").read_text() + "CLI11"
    for library, name in {"embree": "embree", "Imath": "imath", "TBB": "tbb", "fmt": "fmt", "OpenEXR": "openexr",
                          "TIFF": "libtiff", "PNG": "libpng", "JPEG": "jpeg", "pugixml": "pugixml", "ZLIB": "zlib-api",
                          "libwebp": "libwebp", "libhwy": "highway", "Boost": "boost", "nlohmann_json": "nlohmann-json",
                          "CLI11": "cli11"}.items():
        check(library in dependencies, f"spack: nothing asks for {library} any more")
        check(re.search(rf'depends_on\("{name}[@":]', recipe), f"spack: {name} is missing")
    project = re.search(r"project\(kaustik VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    for page in ("spack/packages/kaustik/package.py", "spack/README.md", "container/README.md", "kubernetes/parts.yaml"):
        check(project in (CONTRIB / page).read_text(), f"{page} is not of version {project}")


def check_images():
    """What is copied from the source folder."""
    container = (CONTRIB / "container/Containerfile").read_text()
    for source in re.findall(r"^COPY (?!--from)(\S+)", container, re.MULTILINE):
        check((ROOT / source).exists(), f"container: no {source}")
    for text in (container, (CONTRIB / "apptainer/kaustik.def").read_text()):
        for option in re.findall(r"-D (KAUSTIK_\w+)", text):
            sources = "".join(path.read_text() for path in [ROOT / "CMakeLists.txt", *(ROOT / "cmake").glob("*.cmake")])
            check(f"option({option}" in sources, f"images: CMake has no option {option}")


def main():
    try:
        import yaml
    except ImportError:
        print("no PyYAML: the manifests of kubernetes and openjd are not checked")
    else:
        check_kubernetes(yaml)
        check_openjd(yaml)
    json.loads((CONTRIB / "flamenco/job.json").read_text())
    check_opencue()
    check_spack()
    check_images()
    for mistake in mistakes:
        print(mistake, file=sys.stderr)
    return 1 if mistakes else 0


sys.exit(main())
