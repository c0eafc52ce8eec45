#!/usr/bin/env python3
"""Turns data/*.csv into the generated sources of the CIE tables and of the metals."""
import csv
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOTE = "// clang-format off\n// Made by scripts/make_measured_data.py from data/{}; not to be edited.\n"


def rows_of(name):
    with open(ROOT / "data" / name, newline="") as file:
        return list(csv.DictReader(file))


def color_data():
    cie = rows_of("cie1931_5nm.csv")
    d65 = rows_of("d65_5nm.csv")
    assert [float(r["lambda_nm"]) for r in cie] == list(range(360, 831, 5))
    assert [float(r["lambda_nm"]) for r in d65] == list(range(300, 831, 5))
    lines = [f"    {{{r['xbar']}, {r['ybar']}, {r['zbar']}}}," for r in cie]
    powers = ", ".join(r["rel_power"] for r in d65)
    return (
        NOTE.format("cie1931_5nm.csv, d65_5nm.csv")
        + '#include "kaustik/base/color_data.h"\n\nnamespace kaustik {\n\n'
        + f"const double cie1931_5nm[{len(cie)}][3] = {{\n" + "\n".join(lines) + "\n};\n\n"
        + f"const double d65_5nm[{len(d65)}] = {{\n    {powers}}};\n\n}}  // namespace kaustik\n"
    )


def metal_data():
    rows = rows_of("metals_nk.csv")
    metals = sorted({r["metal"] for r in rows})
    text = NOTE.format("metals_nk.csv")
    text += '#include "kaustik/material/metal_data.h"\n\nnamespace kaustik {\nnamespace {\n\n'
    for metal in metals:
        samples = "\n".join(
            f"    {{{r['lambda_nm']}, {r['n']}, {r['k']}}}," for r in rows if r["metal"] == metal)
        text += f"const MetalSample {metal.lower()}[] = {{\n{samples}\n}};\n\n"
    text += "}  // namespace\n\nstd::span<const MeasuredMetal> measured_metals() {\n"
    text += "  static const MeasuredMetal metals[] = {\n"
    text += "".join(f'    {{"{metal}", {metal.lower()}}},\n' for metal in metals)
    return text + "  };\n  return metals;\n}\n\n}  // namespace kaustik\n"


def main():
    source = ROOT / "src" / "kaustik"
    (source / "base" / "color_data.cpp").write_text(color_data())
    (source / "material" / "metal_data.cpp").write_text(metal_data())


if __name__ == "__main__":
    main()
