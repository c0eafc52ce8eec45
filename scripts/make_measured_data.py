#!/usr/bin/env python3
"""Turns data/*.csv into the generated sources of the CIE tables, of the metals and of the glasses."""
import csv
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOTE = "// clang-format off\n// Made by scripts/make_measured_data.py from data/{}; not to be edited.\n"
# Tables from Palik's handbook that scenes also ask for by NAME_palik.
PALIK = """AlAs AlSb Be CsI Cu Cu2O CuO d-C HgTe Ir K Li MgO Mo Na Nb Rh Se SiC SnTe Ta Te ThF4 TiC TiN
TiO2 V VC VN""".split()


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


def check_metal(metal, samples):
    """The renderer looks up 360-830 nm and takes the wavelengths to ascend."""
    wavelengths = [float(r["lambda_nm"]) for r in samples]
    if any(a >= b for a, b in zip(wavelengths, wavelengths[1:])):
        sys.exit(f"metals_nk.csv: {metal}: the wavelengths do not ascend")
    if wavelengths[0] > 360 or wavelengths[-1] < 830:
        covered = f"{wavelengths[0]}-{wavelengths[-1]} nm"
        sys.exit(f"metals_nk.csv: {metal}: {covered} is less than 360-830 nm")


def metal_data():
    tables = {}
    for row in rows_of("metals_nk.csv"):
        tables.setdefault(row["metal"], []).append(row)
    text = NOTE.format("metals_nk.csv")
    text += '#include "kaustik/material/metal_data.h"\n\nnamespace kaustik {\nnamespace {\n\n'
    arrays = {metal: metal.lower().replace("-", "_") for metal in sorted(tables)}
    for metal, array in arrays.items():
        check_metal(metal, tables[metal])
        samples = "\n".join(f"    {{{r['lambda_nm']}, {r['n']}, {r['k']}}}," for r in tables[metal])
        text += f"const MetalSample {array}[] = {{\n{samples}\n}};\n\n"
    text += "}  // namespace\n\nstd::span<const MeasuredMetal> measured_metals() {\n"
    text += "  static const MeasuredMetal metals[] = {\n"
    names = {**arrays, **{f"{metal}_palik": arrays[metal] for metal in PALIK}}
    text += "".join(f'    {{"{name}", {names[name]}}},\n' for name in sorted(names))
    return text + "  };\n  return metals;\n}\n\n}  // namespace kaustik\n"


def glass_data():
    """A name may stand for the same table as another one's: Mitsuba's names of materials."""
    aliases = {"fused silica": ["fused quartz"]}
    lines = []
    for row in rows_of("sellmeier.csv"):
        terms = ", ".join(f"{{{row[f'B{i}']}, {row[f'C{i}_um2']}}}" for i in range(1, 5))
        lines += [f'    {{"{name}", {row["A"]}, {{{{{terms}}}}}}},'
                  for name in [row["name"], *aliases.get(row["name"], [])]]
    return (
        NOTE.format("sellmeier.csv")
        + '#include "kaustik/material/glass_data.h"\n\nnamespace kaustik {\n\n'
        + "std::span<const MeasuredGlass> measured_glasses() {\n"
        + "  static const MeasuredGlass glasses[] = {\n" + "\n".join(lines)
        + "\n  };\n  return glasses;\n}\n\n}  // namespace kaustik\n"
    )


def main():
    source = ROOT / "src" / "kaustik"
    (source / "base" / "color_data.cpp").write_text(color_data())
    (source / "material" / "metal_data.cpp").write_text(metal_data())
    (source / "material" / "glass_data.cpp").write_text(glass_data())


if __name__ == "__main__":
    main()
