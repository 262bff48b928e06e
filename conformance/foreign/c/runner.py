"""A runner for a kit, as its README.md describes one: OpenCL C text as plain C, compiled for the processor.

`python runner.py KIT RESULTS.json` reads the kit and nothing of the project, as a runner for an engine does.
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
COMPILERS = ("clang", *(f"clang-{version}" for version in range(22, 13, -1)))
"""GCC has no swizzles and no functions of one name; Debian's PoCL brings a clang along."""
OPTIONS = ("-std=c11", "-O1", "-ffp-contract=off", "-fno-builtin", "-w")
LITERAL = re.compile(r"\((float[234]|uint[23])\)\(")


def compiler() -> str | None:
    """The first of these C compilers that is installed."""
    return next((found for found in map(shutil.which, COMPILERS) if found), None)


def as_c(text: str) -> str:
    """OpenCL C as C: calls instead of vector literals."""
    return LITERAL.sub(r"make_\1(", text)


def build(kit: Path, folder: Path, names: list[str]) -> Path:
    """The program that computes these functions; raises RuntimeError where the compiler refuses them."""
    calls, table = [], []
    for name in names:
        vectors = json.loads((kit / "vectors" / f"{name}.json").read_text(encoding="utf-8"))
        body = (kit / "opencl" / "calls" / f"{name}.cl").read_text(encoding="utf-8")
        calls.append(f"static void call_{name}(void) {{\n{as_c(body)}}}\n")
        rows = len(vectors["inputs"]), len(vectors["expected"])
        table.append(f'    {{"{name}", {rows[0]}, {rows[1]}, call_{name}}},\n')
    (folder / "calls.inc").write_text(
        "".join([*calls, "static const struct call calls[] = {\n", *table, "};\n"]), encoding="utf-8"
    )
    library = (kit / "opencl" / "library.cl").read_text(encoding="utf-8")
    (folder / "library.inc").write_text(as_c(library), encoding="utf-8")
    source, program = HERE / "program.c", folder / "program"
    command = [compiler() or "clang", *OPTIONS, f"-I{folder}", str(source), "-o", str(program), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return program


def compute(program: Path, kit: Path, name: str) -> dict[str, Any]:
    """The results of one function, as a file of results holds them."""
    vectors = json.loads((kit / "vectors" / f"{name}.json").read_text(encoding="utf-8"))
    words = [int(word, 16) for row in vectors["inputs"] for word in row["words"]]
    data = b"".join(word.to_bytes(4, sys.byteorder) for word in words)
    done = subprocess.run(
        [program, name, str(vectors["lanes"])], input=data, capture_output=True, check=False
    )
    if done.returncode:
        return {"vectors": vectors["vectors"], "failed": f"the program ended with status {done.returncode}"}
    out = [done.stdout[k : k + 4] for k in range(0, len(done.stdout), 4)]
    found = [f"{int.from_bytes(word, sys.byteorder):08x}" for word in out]
    lanes = vectors["lanes"]
    rows = [found[k : k + lanes] for k in range(0, len(found), lanes)]
    return {"vectors": vectors["vectors"], "rows": rows}


def run(kit: Path) -> dict[str, Any]:
    """The results of every function of a kit."""
    about = json.loads((kit / "kit.json").read_text(encoding="utf-8"))["kit"]
    version = subprocess.run([compiler() or "clang", "--version"], capture_output=True, text=True, check=True)
    driver = f"{version.stdout.splitlines()[0]}, C from OpenCL C, {' '.join(OPTIONS)}"
    with tempfile.TemporaryDirectory() as folder:
        program = build(kit, Path(folder), about["functions"])
        functions = {name: compute(program, kit, name) for name in about["functions"]}
    return {"kit": about, "target": "opencl", "driver": driver, "functions": functions}


if __name__ == "__main__":
    Path(sys.argv[2]).write_text(json.dumps(run(Path(sys.argv[1]))) + "\n", encoding="utf-8")
