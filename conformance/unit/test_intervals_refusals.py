"""What an accuracy table may say, key by key, and the sentence with which anything else is refused.

Plan. The table of WGSL with one text in the place of another.
  sentences  the whole sentence: file, row, key, what was given and what is meant
  accepted   every key of every kind, and its value in the row; what is left out has its default
"""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.errors import UserError
from codegen.intervals import TABLES, load_table, tables
from codegen.intervals.accuracy import Absolute, Exact, Filter, Inherited, Rounded, Row, Scaled, Ulp, Unstated
from codegen.intervals.tables import FOLDER, FORMULAS, Table, operands, read_table

TEXT = (FOLDER / "wgsl.toml").read_text(encoding="utf-8")
MIN = '[operations.min]\nkind = "exact"'


def read(old: str, new: str) -> Table:
    assert old in TEXT
    return read_table("wgsl", "my.toml", TEXT.replace(old, new, 1))


KINDS = "absolute, exact, filter, inherited, rounded, scaled, ulp, unstated"
SENTENCES = {
    'kind = "exact"\ncite = "WGSL, Logical': (
        'kind = "zzz"\ncite = "WGSL, Logical',
        f'my.toml: and: unknown kind "zzz"; valid names: {KINDS}',
    ),
    'kind = "exact"\ncite = "WGSL, bitcast': (
        'cite = "WGSL, bitcast',
        f"my.toml: float_to_bits: lacks kind; valid names: {KINDS}",
    ),
    'edition = "gpuweb/gpuweb da251f90, 2026-08-19"\n': ("", "my.toml: lacks edition"),
    'specification = "WebGPU': (
        'specifications = "WebGPU',
        'my.toml: unknown key "specifications"; did you mean "specification"?',
    ),
    'association = "WGSL': (
        'associations = "WGSL',
        'my.toml: settings: unknown key "associations"; did you mean "association"?',
    ),
    'rounding = "either"': (
        'rounding = "up"',
        'my.toml: rounding is "either" or "nearest", not "up"',
    ),
    "fused = true": ('fused = "yes"', "my.toml: fused is true or false"),
    "flush = true": ("flush = 0", "my.toml: flush is true or false"),
    "as_accurate = true": ("as_accurate = 1", "my.toml: as_accurate is true or false"),
    "[operations.floor]": ("[operations.flour]", 'my.toml: unknown operation "flour"; did you mean "floor"?'),
    MIN: (
        f"{MIN}\nulps = 3",
        'my.toml: min: unknown key "ulps"; valid names: assumed, cite, kind, magnitude, normal, zero',
    ),
    "ulps = 2.5": ("ulps = true", "my.toml: /: ulps is a number above 0, not True"),
    "ulps = 2\n": ('ulps = "2"\n', "my.toml: inverse_sqrt: ulps is a number above 0, not '2'"),
    "ulps = 3\n": ("ulps = 0\n", "my.toml: exp: ulps is a number above 0, not 0"),
    "magnitude = { y = [-126, 126] }": (
        "magnitude = { z = [-126, 126] }",
        'my.toml: /: no operand "z"; valid names: x, y',
    ),
    "magnitude = { x = [-126, 126] }": (
        "magnitude = { x = [126, -126] }",
        "my.toml: atan2: magnitude of x: needs two numbers in ascending order, not [126, -126]",
    ),
    'normal = ["y"]': ('normal = ["w"]', 'my.toml: atan2: no operand "w"; valid names: x, y'),
    "bound = 4.76837158203125e-07": ("bound = -1", "my.toml: log: bound is a number above 0, not -1"),
    "within = [0.5, 2.0]": (
        "within = [0.5]",
        "my.toml: log: within: needs two numbers in ascending order, not [0.5]",
    ),
    "within = [-3.141592653589793, 3.141592653589793]": (
        "within = 3.0",
        "my.toml: sin: within: needs two numbers in ascending order, not 3.0",
    ),
    "elsewhere_ulps = 3": ("elsewhere_ulps = -3", "my.toml: log: elsewhere_ulps is a number above 0, not -3"),
    'formula = "x / length(x)"': (
        'formula = "x / length"',
        'my.toml: normalize: unknown formula "x / length"; did you mean "x / length(x)"?',
    ),
    "texel = 1.0": ("texel = 0.0", "my.toml: lookup: texel is a number above 0, not 0.0"),
    "level = 1.0": ("level = false", "my.toml: lookup: level is a number above 0, not False"),
    "flush = true\n": ("flush = \n", "my.toml: not valid TOML: Invalid value (at line 6, column 9)"),
}
NOT_A_SENTENCE = ("3", '""', '"  "')


@pytest.mark.parametrize("old", SENTENCES)
def test_sentence_of_a_refusal(old: str) -> None:
    new, sentence = SENTENCES[old]
    with pytest.raises(UserError) as refused:
        read(old, new)
    assert str(refused.value) == sentence


@pytest.mark.parametrize("given", NOT_A_SENTENCE)
def test_what_is_told_is_a_sentence(given: str) -> None:
    for key in ("cite", "assumed"):
        others = "" if key == "cite" else 'cite = "c"\n'
        with pytest.raises(UserError) as refused:
            read_row(f'[operations.min]\nkind = "exact"\n{others}{key} = {given}\n')
        assert str(refused.value) == f"my.toml: min: {key} is a sentence"


ROWS = {
    'kind = "exact"': Row(Exact(), "c"),
    'kind = "rounded"': Row(Rounded(), "c"),
    'kind = "unstated"': Row(Unstated(), "c"),
    'kind = "ulp"\nulps = 3': Row(Ulp(3.0), "c"),
    'kind = "ulp"\nulps = 3\nper_abs_x = 2\nwhole = true\nper_component = 0.5': Row(
        Ulp(3.0, 2.0, True, 0.5), "c"
    ),
    'kind = "absolute"\nbound = 0.5\nwithin = [1, 2]': Row(Absolute(0.5, (1, 2)), "c"),
    'kind = "absolute"\nbound = 0.5\nwithin = [1, 1]\nelsewhere_ulps = 4': Row(
        Absolute(0.5, (1, 1), Ulp(4.0)), "c"
    ),
    'kind = "scaled"\nepsilons = 3': Row(Scaled(3.0), "c"),
    'kind = "scaled"\nepsilons = -1\nper_component = 2': Row(Scaled(-1.0, 2.0), "c"),
    'kind = "filter"\ntexel = 0.25\nlevel = 1': Row(Filter(0.25, 1.0), "c"),
    'kind = "ulp"\nulps = 1\nmagnitude = { x = [-3, 4], y = [5, 5] }': Row(
        Ulp(1.0), "c", {"x": (-3, 4), "y": (5, 5)}
    ),
    'kind = "ulp"\nulps = 1\nreciprocal = [-7, 8]\nzero = ["x", "y"]': Row(
        Ulp(1.0), "c", {}, (-7, 8), ("x", "y")
    ),
    'kind = "exact"\nnormal = ["y"]\nassumed = "because"': Row(Exact(), "c", {}, None, (), ("y",), "because"),
    **{f'kind = "inherited"\nformula = "{f}"': Row(Inherited(f), "c") for f in FORMULAS},
}


def read_row(text: str) -> Row:
    """The row of min, with this text in the place of its own."""
    start = TEXT.index(MIN)
    end = TEXT.index("[operations", start + 1)
    return read_table("wgsl", "my.toml", TEXT[:start] + text + TEXT[end:]).row("min")


def reading(row: str) -> Row:
    return read_row(f'[operations.min]\ncite = "c"\n{row}\n\n')


@pytest.mark.parametrize("text", ROWS)
def test_keys_of_a_row(text: str) -> None:
    assert reading(text) == ROWS[text]


REFUSED_ROWS = {
    'kind = "absolute"\nbound = 0.5': "lacks within",
    'kind = "absolute"\nwithin = [1, 2]': "lacks bound",
    'kind = "filter"\ntexel = 0.5': "lacks level",
    'kind = "filter"\nlevel = 0.5': "lacks texel",
    'kind = "scaled"': "lacks epsilons",
    'kind = "inherited"': "lacks formula",
    'kind = "ulp"\nwhole = true': "lacks ulps",
    "assumed = 'x'": "lacks kind; valid names: ",
    'kind = "ulp"\nulps = 1\nreciprocal = [2, 1]': "reciprocal: needs two numbers in ascending order",
    'kind = "ulp"\nulps = 1\nzero = ["z"]': 'no operand "z"; valid names: a, b',
}


@pytest.mark.parametrize("text", REFUSED_ROWS)
def test_keys_that_a_row_needs(text: str) -> None:
    sentence = REFUSED_ROWS[text].replace("a, b", ", ".join(sorted(operands("min"))))
    with pytest.raises(UserError) as refused:
        reading(text)
    assert str(refused.value).startswith("my.toml: min: ")
    assert sentence in str(refused.value)


TWO_AT_ONCE = {
    ("specification", "edition"): "my.toml: lacks specification, edition",
    ("rounding", "flush", "fused"): "my.toml: lacks rounding, flush, fused",
}


@pytest.mark.parametrize("keys", TWO_AT_ONCE)
def test_all_that_lacks_is_told_in_order(keys: tuple[str, ...]) -> None:
    head, _, rest = TEXT.partition("[settings]")
    lines = [line for line in head.splitlines(keepends=True) if not line.startswith(keys)]
    with pytest.raises(UserError) as refused:
        read_table("wgsl", "my.toml", "".join(lines) + "[settings]" + rest)
    assert str(refused.value) == TWO_AT_ONCE[keys]


def test_all_that_lacks_in_settings_and_rows_is_told_in_order() -> None:
    head, _, rest = TEXT.partition("[settings]")
    settings, _, rows = rest.partition("[operations")
    with pytest.raises(UserError) as refused:
        read_table("wgsl", "my.toml", head + "[settings]\n\n[operations" + rows)
    assert settings and str(refused.value) == "my.toml: settings: lacks rounding, flush, fused, association"
    for row, lacking in (("absolute", "bound, within"), ("filter", "texel, level")):
        with pytest.raises(UserError) as refused:
            reading(f'kind = "{row}"')
        assert str(refused.value) == f"my.toml: min: lacks {lacking}"


def test_the_first_of_two_faults_is_told() -> None:
    with pytest.raises(UserError) as refused:
        read("flush = true\nfused = true", "flush = 1\nfused = 1")
    assert str(refused.value) == "my.toml: flush is true or false"
    with pytest.raises(UserError) as refused:
        read_row('[operations.min]\nkind = "exact"\ncite = ""\nassumed = ""\n')
    assert str(refused.value) == "my.toml: min: cite is a sentence"


def test_tables_of_the_package_are_told_by_their_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "wgsl.toml").write_text("flush = ", encoding="utf-8")
    monkeypatch.setattr(tables, "FOLDER", tmp_path)
    with pytest.raises(UserError) as refused:
        tables.load_table.__wrapped__("wgsl")
    assert str(refused.value).startswith("codegen/intervals/tables/wgsl.toml: not valid TOML: ")


def test_what_a_table_says_of_itself() -> None:
    table = read_table("mine", "my.toml", TEXT.replace("fused = true", "fused = false", 1))
    assert (table.name, table.rounding, table.flush, table.fused) == ("mine", "either", True, False)
    assert table.specification == "WebGPU Shading Language" and table.edition.startswith("gpuweb/gpuweb")
    assert set(table.settings) == {"rounding", "flush", "fused", "association"}
    other = read_table("m", "my.toml", TEXT.replace("flush = true", "flush = false", 1))
    assert not other.flush and other.fused
    assert other.as_accurate and not other.contracts
    freely = read_table("m", "my.toml", TEXT.replace("as_accurate = true\n", "", 1))
    assert not freely.as_accurate and freely.contracts


def test_what_a_promise_leaves_out() -> None:
    assert Ulp(3.0) == Ulp(3.0, per_abs_x=0.0, whole=False, per_component=0.0)
    assert Scaled(3.0) == Scaled(3.0, per_component=0.0)
    assert Absolute(0.5, (0.0, 1.0)) == Absolute(0.5, (0.0, 1.0), elsewhere=None)
    assert Row(Exact(), "c") == Row(
        Exact(), "c", magnitude={}, reciprocal=None, zero=(), normal=(), assumed=""
    )


def test_operands_have_the_names_of_the_registry() -> None:
    assert operands("/") == operands("+") == ("x", "y")
    assert operands("atan2") == ("y", "x")
    assert operands("sqrt") == ("x",)


def test_tables_by_name() -> None:
    assert TABLES == ("wgsl", "vulkan", "glsl", "glsl_es", "opencl", "opencl_relaxed")
    for name in TABLES:
        assert load_table(name).name == name and load_table(name) is load_table(name)
    with pytest.raises(UserError) as refused:
        load_table("direct3d")
    listed = ", ".join(sorted(TABLES))
    assert str(refused.value) == f'unknown accuracy table "direct3d"; valid names: {listed}'
