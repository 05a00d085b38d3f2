"""`crossfix audit verify`: is the audit log whole?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, NoReturn

import typer

from backend.auth.audit_chain import Fault, Head, Verdict
from backend.auth.audit_chain import verify as verify_chain
from backend.cli.edge import print_json, stop
from backend.settings import AUDIT_FILE, settings_of

app = typer.Typer(add_completion=False, no_args_is_help=True)

FAULTS: dict[Fault, str] = {
    "unreadable": "line {line} is no entry",
    "changed": "the entry in line {line} was changed after it was written",
    "out_of_order": "before line {line} an entry was changed, put in, taken out or moved",
    "torn": "line {line} is torn: it was being written when the power failed, or is being written now",
    "noted_missing": "the noted entry is not in it: the end was cut off, or all of it was written again",
}


@app.callback()
def audit() -> None:
    """Who did or tried what, from where, when: DATA_DIR/audit.jsonl, one JSON entry a line, chained by digests."""


@app.command()
def verify(
    data_dir: Annotated[Path | None, typer.Option(help="Where the server keeps its data. Default: ./data.")] = None,
    noted: Annotated[
        str | None, typer.Option(help="NUMBER:DIGEST of an entry noted elsewhere earlier; it must still be there.")
    ] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Check the chain of the audit log; exit 1 when it is broken. Works while the server runs.

    Note the number and digest that it prints somewhere else: given back as --noted, they show that the end was not
    cut off since.

    Example: crossfix audit verify --noted 118:9f86d081884c7d65...
    """
    try:
        path = settings_of(data_dir=data_dir).data_dir / AUDIT_FILE
        head = None if noted is None else _head(noted)
        with path.open("rb") as lines:
            verdict = verify_chain(lines, head)
    except OSError as error:
        stop(f"{error.filename} cannot be read ({error.strerror}): name the server's data directory (--data-dir)")
    except ValueError as error:
        stop(error)
    if json_:
        print_json({"number": verdict.head.number, "digest": verdict.head.digest, "fault": verdict.fault,
                    "line": verdict.line})  # fmt: skip
        raise typer.Exit(0 if verdict.fault is None else 1)
    if verdict.fault is not None:
        _broken(path, verdict.fault, verdict)
    typer.echo(
        f"{path} is whole: {verdict.head.number} entries, the last is {verdict.head.number}:{verdict.head.digest}"
    )


def _head(noted: str) -> Head:
    number, _, digest = noted.partition(":")
    if not number.isdigit() or len(digest) != 64:
        raise ValueError("--noted must be NUMBER:DIGEST as `crossfix audit verify` prints them")
    return Head(int(number), digest)


def _broken(path: Path, fault: Fault, verdict: Verdict) -> NoReturn:
    typer.echo(f"{path} is NOT whole: {FAULTS[fault].format(line=verdict.line)}.", err=True)
    typer.echo(f"Up to entry {verdict.head.number} it is. Compare it with a backup.", err=True)
    raise typer.Exit(1)
