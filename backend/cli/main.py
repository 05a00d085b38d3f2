"""The command line `crossfix`. Commands are imported when they are called, so that --help answers at once."""

from __future__ import annotations

import importlib
import logging
import os
import sys
from typing import Any

try:
    import typer
    from typer.core import TyperCommand, TyperGroup
except ModuleNotFoundError as error:
    raise SystemExit(
        f"crossfix: the package {error.name} is missing, so the planner alone was installed. "
        "Install the server too: pipx install 'crossfix[server]'"
    ) from None

COMMANDS: dict[str, tuple[str, str]] = {
    "serve": ("backend.cli.serve:serve", "Start the server and say where the page is."),
    "demo": ("backend.cli.demo:demo", "Fly one whole simulated mission, with or without a browser."),
    "sweep": ("backend.cli.sweep:sweep", "Bearings from recorded rotations."),
    "localize": ("backend.cli.localize:localize", "Where the emitter is, from a file of bearings."),
    "study": ("backend.cli.study:app", "Compare planners by Monte Carlo."),
    "bench": ("backend.cli.bench:bench", "Measure the planner's speed on this machine."),
    "calibrate": ("backend.cli.calibrate:calibrate", "Measure an antenna pattern from a flight around an emitter."),
    "backup": ("backend.cli.backup:backup", "Save everything that a server keeps, while it flies."),
    "restore": ("backend.cli.restore:restore", "Put a backup back onto an empty server."),
    "thin": ("backend.cli.thin:thin", "Take old raw sweeps, and keep everything else."),
    "recover": ("backend.cli.recover:recover", "Let somebody in again who has lost their password."),
    "audit": ("backend.cli.audit:app", "Check the audit log: who did what, and whether it is whole."),
    "payload": ("backend.cli.payload:payload", "Run the companion computer's agent."),
}
"""Name -> where it is (module:function or module:app), one line of help."""


class LazyCommands(TyperGroup):
    """Knows its commands by name and line; imports one to run it."""

    def list_commands(self, ctx: Any) -> list[str]:
        """In the order of COMMANDS, as the help shows them."""
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """A stand-in with name and line only: enough for the list, and not imported."""
        line = COMMANDS.get(cmd_name)
        return None if line is None else TyperCommand(cmd_name, help=line[1])

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The real one, imported now."""
        name, command, rest = super().resolve_command(ctx, args)
        return name, command if name is None else load(name), rest

    def main(self, *args: Any, **kwargs: Any) -> Any:
        """An error nobody foresaw is one line too; CROSSFIX_DEBUG=1 shows where it came from."""
        try:
            return super().main(*args, **kwargs)
        except Exception as error:
            if os.environ.get("CROSSFIX_DEBUG"):
                raise
            logging.getLogger("crossfix").debug("unforeseen", exc_info=True)
            text = " ".join(str(error).split()) or type(error).__name__
            typer.echo(f"crossfix: {type(error).__name__}: {text} (CROSSFIX_DEBUG=1 tells more)", err=True)
            sys.exit(1)


def load(name: str) -> Any:
    """The real command behind a name."""
    module, attribute = COMMANDS[name][0].split(":")
    found = getattr(importlib.import_module(module), attribute)
    if isinstance(found, typer.Typer):
        command = typer.main.get_command(found)
    else:
        single = typer.Typer(add_completion=False)
        single.command(name)(found)
        command = typer.main.get_command(single)
    command.name = name
    return command


app = typer.Typer(
    cls=LazyCommands, add_completion=False, no_args_is_help=True, pretty_exceptions_enable=False, name="crossfix"
)


@app.callback()
def crossfix(
    verbose: bool = typer.Option(False, "--verbose", "-v", help="Say more, on stderr."),
) -> None:
    """Find a radio emitter with a multicopter: plan, fly, monitor, review.

    Every command has --json: exactly one JSON value on stdout, everything else on stderr.
    """
    logging.basicConfig(
        level=logging.INFO if verbose else logging.WARNING,
        stream=sys.stderr,
        format="%(asctime)s %(levelname)s %(name)s: %(message)s",
    )


if __name__ == "__main__":
    app()
