"""The command `vair`: one subcommand per file, loaded when it is used.

Exit status: 0 good, 1 a check failed, 2 bad usage or input. Errors are one sentence on standard error.
"""

from __future__ import annotations

import ast
import gc
import importlib
import os
import sys
from pathlib import Path

import click

from codegen.errors import UserError, nearest
from codegen.version import VERSION

COMMANDS = {
    "list": "codegen.commands.list:command",
    "show": "codegen.commands.show:command",
    "emit": "codegen.commands.emit:command",
    "where": "codegen.commands.where:command",
    "doctor": "codegen.commands.doctor:command",
    "env": "codegen.commands.env:command",
    "factor": "codegen.commands.factor:command",
    "table": "codegen.commands.table:command",
    "check": "conformance.commands.check:command",
    "kit": "conformance.commands.kit:command",
    "scene": "codegen.commands.scene:command",
    "vendor": "codegen.commands.vendor:command",
    "verify": "codegen.commands.verify:command",
    "render": "conformance.commands.render:command",
    "fur": "conformance.commands.fur:command",
    "docs": "conformance.commands.docs:command",
    "report": "conformance.commands.report:command",
    "demo": "conformance.commands.demo:command",
}
"""Subcommand -> where it lives; what runs on devices lives in conformance and is loaded by name."""

ONE_THREAD = frozenset({"scene"})
"""Subcommands whose processes share the cores: threads of NumPy's BLAS would wait on them at full speed."""


def documentation(name: str) -> str:
    """What a subcommand says of itself; its file is read, not imported."""
    module, attribute = COMMANDS[name].split(":")
    path = Path(__file__).parents[1].joinpath(*module.split(".")).with_suffix(".py")
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == attribute]
    return ast.get_docstring(found[0]) or ""


class LazyGroup(click.Group):
    """A group that imports a subcommand only when it runs, so that emission and help start quickly."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        module, attribute = COMMANDS[cmd_name].split(":")
        if cmd_name in ONE_THREAD:
            os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when NumPy is imported
        if module in sys.modules:
            return _attribute(module, attribute)
        collects = gc.isenabled()
        gc.disable()  # what is loaded stays: looking for cycles in it takes a tenth of the time
        try:
            return _attribute(module, attribute)
        finally:
            gc.freeze()  # nor is it looked at later, and at the end
            if collects:
                gc.enable()

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        room = formatter.width - 6 - max(map(len, COMMANDS))
        shown = {name: click.Command(name, help=documentation(name)) for name in COMMANDS}
        rows = [(name, command.get_short_help_str(room)) for name, command in shown.items()]
        with formatter.section("Commands"):
            formatter.write_dl(rows)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            raise UserError(f'unknown command "{args[0]}"{nearest(args[0], COMMANDS)}')
        return super().resolve_command(ctx, args)


def _attribute(module: str, name: str) -> click.Command:
    found: click.Command = getattr(importlib.import_module(module), name)
    return found


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(VERSION, prog_name="vair")
def vair() -> None:
    """Hair, fur and strand shading functions for GLSL, WGSL and OpenCL C, with known error."""


def main() -> None:
    """Run the command line and exit."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: list[str]) -> int:
    """Run the command line; returns the exit status."""
    try:
        status = vair.main(args=arguments, prog_name="vair", standalone_mode=False)
        sys.stdout.flush()
    except UserError as e:
        return _refuse(str(e))
    except click.exceptions.NoArgsIsHelpError as e:
        click.echo(e.format_message(), err=True)
        return 2
    except click.ClickException as e:
        return _refuse(" ".join(e.format_message().split()))
    except (click.Abort, KeyboardInterrupt):
        click.echo("vair: interrupted", err=True)
        return 130
    except BrokenPipeError:
        return _reader_left()
    except OSError as e:
        _reader_left()
        return _refuse(f"{e.filename or 'standard output'}: {e.strerror}")
    except SystemExit:  # click's answer to a reader that left
        return _reader_left()
    return status if isinstance(status, int) else 0


def _reader_left() -> int:
    """The reader of a pipe has seen enough; nothing went wrong."""
    sys.stdout = open(os.devnull, "w")  # noqa: SIM115  stays open until the process ends
    return 0


def _refuse(sentence: str) -> int:
    click.echo(f"vair: {sentence}", err=True)
    return 2


if __name__ == "__main__":
    main()
