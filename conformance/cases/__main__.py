"""Write every family to conformance/cases/data; what is there already comes out the same to the byte."""

from conformance.cases.registry import FAMILIES, build
from conformance.cases.table import DATA, text


def main() -> None:
    """Compute and store all families."""
    DATA.mkdir(exist_ok=True)
    for family in FAMILIES.values():
        points = build(family)
        (DATA / f"{family.name}.csv").write_text(text(family, points), encoding="ascii", newline="\n")
        print(f"{family.name}: {len(next(iter(points.values())))} points")


if __name__ == "__main__":
    main()
