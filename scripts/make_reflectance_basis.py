#!/usr/bin/env python3
"""Finds the spectra behind red, green and blue: src/kaustik/base/reflectance_basis.cpp.

Three reflectances at steps of 5 nm, linear between them, that add up to 1 at every wavelength and lie
within 0 and 1; each has the colour of its primary of Rec. 709 under D65. Of all such the smoothest: the
sum of the squared steps is least (after Mallett and Yuksel, "Spectral Primary Decomposition for Rendering
with sRGB Reflectance", EGSR 2019). Needs numpy. Tables are those of data/, integrals sums over 1 nm."""
import csv
import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
KNOTS = np.arange(360, 831, 5)
REC709_FROM_XYZ = np.array(
    [[3.2404541621, -1.5371385128, -0.4985314096],
     [-0.9692660305, 1.8760108454, 0.0415560175],
     [0.0556434310, -0.2040259135, 1.0572251882]])


def table(name):
    with open(ROOT / "data" / name, newline="") as file:
        return np.array([[float(x) for x in row] for row in list(csv.reader(file))[1:]])


def channels_of_knots():
    """3 × knots: the colour under D65 of a reflectance that is 1 at a knot and 0 at all others."""
    nm = np.arange(360, 831)
    cie, d65 = table("cie1931_5nm.csv"), table("d65_5nm.csv")
    matching = np.stack([np.interp(nm, cie[:, 0], cie[:, i]) for i in (1, 2, 3)])
    channels = REC709_FROM_XYZ @ (matching * np.interp(nm, d65[:, 0], d65[:, 1]))
    channels /= channels.sum(axis=1, keepdims=True)
    hats = np.stack([np.interp(nm, KNOTS, row) for row in np.eye(len(KNOTS))])
    return channels @ hats.T


def constraints(channels):
    """E and e of E x = e, where x has red, green, blue one after the other. Red's colour follows."""
    n = len(KNOTS)
    rows, values = [], []
    for basis in (1, 2):
        for channel in range(3):
            row = np.zeros(3 * n)
            row[basis * n:(basis + 1) * n] = channels[channel]
            rows.append(row)
            values.append(float(channel == basis))
    for knot in range(n):
        row = np.zeros(3 * n)
        row[knot::n] = 1
        rows.append(row)
        values.append(1.0)
    return np.array(rows), np.array(values)


def optimality(quadratic, linear):
    zeros = np.zeros((len(linear), len(linear)))
    return np.block([[quadratic, linear.T], [linear, zeros]])


def smoothest(channels):
    """Alternating directions (Boyd et al. 2011, section 5.2) tell which values are 0 or 1; the others
    solve the equations of the optimum."""
    n = len(KNOTS)
    steps = np.diff(np.eye(n), axis=0)
    quadratic = np.kron(np.eye(3), steps.T @ steps + 1e-9 * np.eye(n))
    linear, values = constraints(channels)
    weight = 0.02
    inverse = np.linalg.pinv(optimality(quadratic + weight * np.eye(3 * n), linear))
    bounded, dual = np.full(3 * n, 1 / 3), np.zeros(3 * n)
    for _ in range(40000):
        x = (inverse @ np.concatenate([weight * (bounded - dual), values]))[:3 * n]
        bounded = np.clip(x + dual, 0, 1)
        dual += x - bounded
        if np.abs(x - bounded).max() < 1e-9:
            break
    free = (bounded > 1e-7) & (bounded < 1 - 1e-7)
    result = bounded.round()
    right = np.concatenate([-quadratic[np.ix_(free, ~free)] @ result[~free],
                            values - linear[:, ~free] @ result[~free]])
    system = optimality(quadratic[np.ix_(free, free)], linear[:, free])
    result[free] = np.linalg.lstsq(system, right, rcond=None)[0][:free.sum()]
    assert result.min() >= 0 and result.max() <= 1
    assert np.abs(linear @ result - values).max() < 1e-12
    return result.reshape(3, n)


def main():
    rows = "\n".join("    {%.9g, %.9g, %.9g}," % tuple(row) for row in smoothest(channels_of_knots()).T)
    (ROOT / "src" / "kaustik" / "base" / "reflectance_basis.cpp").write_text(
        "// clang-format off\n"
        "// Made by scripts/make_reflectance_basis.py; not to be edited.\n"
        '#include "kaustik/base/reflectance_basis.h"\n\nnamespace kaustik {\n\n'
        f"const double reflectance_basis_5nm[{len(KNOTS)}][3] = {{\n{rows}\n}};\n\n}}  // namespace kaustik\n")


if __name__ == "__main__":
    main()
