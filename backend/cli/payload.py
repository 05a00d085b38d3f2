"""`crossfix payload`: the agent on the companion computer."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import shutil
import sys
from pathlib import Path
from typing import Annotated

import typer

from backend.cli.edge import stop
from backend.version import VERSION
from hardware.clock import WallClock
from hardware.payload.agent import AgentSettings, PayloadAgent
from hardware.payload.configuration import (
    ConfigurationError,
    PayloadConfiguration,
    load_configuration,
    save_configuration,
)
from hardware.payload.spool import Spool, SpoolError
from hardware.ports import ReceiverError
from hardware.sdr.device import FORMS, receiver_from

UNIT = """[Unit]
Description=Crossfix payload agent
Wants=network-online.target
After=network-online.target

[Service]
ExecStart={program} payload --config {config}
Restart=always
RestartSec=2

[Install]
WantedBy=multi-user.target
"""


def payload(
    config: Annotated[Path, typer.Option(help="Configuration file (TOML); options given here go before it.")] = Path(
        "payload.toml"
    ),
    server: Annotated[
        list[str] | None, typer.Option(help="Server as ws://HOST:PORT or wss://HOST; several are tried in turn.")
    ] = None,
    token: Annotated[
        str | None, typer.Option(envvar="CROSSFIX_PAYLOAD_TOKEN", help="What the server knows this payload by.")
    ] = None,
    receiver: Annotated[str | None, typer.Option(help=f"The radio: {FORMS}.")] = None,
    frequency_hz: Annotated[
        float | None, typer.Option(help="Listen here until the server asks for another frequency.")
    ] = None,
    name: Annotated[str | None, typer.Option(help="This payload's name on the console.")] = None,
    data_dir: Annotated[Path | None, typer.Option(help="Where samples wait for the server.")] = None,
    sample_rate_hz: Annotated[float | None, typer.Option(help="IQ samples a second.")] = None,
    gain_db: Annotated[float | None, typer.Option(help="Receiver gain; it never changes inside a sweep.")] = None,
    pulse_width_s: Annotated[float | None, typer.Option(help="For a pulsed tag: length of a pulse.")] = None,
    pulse_period_s: Annotated[float | None, typer.Option(help="For a pulsed tag: from pulse to pulse.")] = None,
    save: Annotated[bool, typer.Option(help="Write the configuration file from these options and end.")] = False,
    systemd: Annotated[
        bool, typer.Option(help="Print a systemd unit that starts this agent at boot, and end.")
    ] = False,
) -> None:
    """Listen with this computer's radio and stream received power to the server, over any link that comes and goes.

    Example: crossfix payload --server ws://192.168.1.10:8600 --token ... --receiver soapy:driver=rtlsdr
    --frequency-hz 868300000 --save
    """
    if systemd:
        program = shutil.which("crossfix") or f"{sys.executable} -m backend.cli.main"
        typer.echo(UNIT.format(program=program, config=config.resolve()), nl=False)
        return
    given: dict[str, object] = {
        "servers": tuple(server) if server else None,
        "token": token,
        "receiver": receiver,
        "frequency_hz": frequency_hz,
        "name": name,
        "data_dir": data_dir,
        "sample_rate_hz": sample_rate_hz,
        "gain_db": gain_db,
        "pulse_width_s": pulse_width_s,
        "pulse_period_s": pulse_period_s,
    }
    try:
        configuration = load_configuration(config, given)
        if save:
            save_configuration(configuration, config)
            typer.echo(f"wrote {config}; start with: crossfix payload --config {config}", err=True)
            return
        agent = _agent(configuration)
    except (ConfigurationError, ReceiverError, SpoolError) as error:
        stop(error)
    except OSError as error:
        stop(f"{config}: {error.strerror or error}")
    logging.basicConfig(level=os.environ.get("CROSSFIX_LOG", "INFO"), format="%(asctime)s %(levelname)s %(message)s")
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(agent.run())


def _agent(configuration: PayloadConfiguration) -> PayloadAgent:
    radio = receiver_from(configuration.receiver, WallClock(), configuration.sample_rate_hz, configuration.gain_db)
    spool = Spool(configuration.data_dir / "samples.sqlite")
    settings = AgentSettings(configuration.servers, configuration.token, configuration.name, f"crossfix {VERSION}")
    return PayloadAgent(settings, radio, spool, (configuration.channel,))
