#!/usr/bin/env python3
"""Runs notebooks and writes them with what they show, as `make notebooks` does. The picture of the cell that has the
tag "cover" goes into a file beside the notebook, for docs/guides/python.md. Usage: make_notebooks.py NOTEBOOK.ipynb ..."""

import base64
import pathlib
import sys
import time

import nbclient
import nbformat


def cover_of(notebook):
    """The last picture of the cell with that tag."""
    [cell] = [cell for cell in notebook.cells if "cover" in cell.metadata.get("tags", [])]
    pictures = [output.data["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})]
    return base64.b64decode(pictures[-1])


def without_what_changes(notebook):
    """Versions of the machine's Python, and outputs that were emptied again."""
    notebook.metadata["language_info"] = {"name": "python"}
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs
                            if not (output.output_type == "display_data" and output.data.get("text/html") == "")]
            for output in cell.outputs:
                if isinstance(output.get("data", {}).get("image/png"), str):
                    output.data["image/png"] = output.data["image/png"].replace("\n", "")


def run(path):
    begin = time.monotonic()
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", record_timing=False,
                            resources={"metadata": {"path": str(path.parent)}}).execute()
    without_what_changes(notebook)
    nbformat.write(notebook, path)
    path.with_suffix(".png").write_bytes(cover_of(notebook))
    print(f"{path}: {time.monotonic() - begin:.0f} s")


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    for path in sys.argv[1:]:
        run(pathlib.Path(path))


if __name__ == "__main__":
    main()
